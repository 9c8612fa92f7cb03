# The incident comes from a monitor with another spec, other data, other thresholds.
. "$SPECS/../incident.bash"
incident() { "$ETLC" incident held --spec "$@"; }
cp "$SPECS/E0832_held.incident" held
sed 's/<= 0.5/<= 0.6/' gripper.etl > other.etl
incident other.etl --thresholds gripper.thresholds.json
thresholds 2.5 2.4999998
incident gripper.etl
thresholds 3 2.9999998
{ head -c 132 "$SPECS/E0409_plain.npy"; printf '\000\000\240\100'; } > wall.npy
incident gripper.etl
