# An episode encoded by another release of ONNX Runtime than the targets.
. "$SPECS/../encoding.bash"
echo > ep.mp4
VERSION=1.29.0 "$ETLC" embed t.etl --data ep.mp4 -o out
"$ETLC" run t.etl --trace out/ep.npz --summary
"$ETLC" embed t.etl
"$ETLC" run t.etl --trace out/ep.npz --summary
