# An incident cut, extended and changed; the original is printed.
. "$SPECS/../incident.bash"
incident() { "$ETLC" incident held --spec gripper.etl "$@"; }
cp "$SPECS/E0832_held.incident" held
for format in table csv trace; do incident --format $format; done
head -c 10 "$SPECS/E0832_held.incident" > held; incident
head -c 100 "$SPECS/E0832_held.incident" > held; incident
{ cat "$SPECS/E0832_held.incident"; echo; } > held; incident
{ head -c 100 "$SPECS/E0832_held.incident"; printf x
  tail -c +102 "$SPECS/E0832_held.incident"; } > held; incident
