# An archive without a description.
. "$SPECS/../encoding.bash"
cp "$SPECS/../ok/projections.fitted.npz" t.embedded.npz
"$ETLC" t.etl --check
