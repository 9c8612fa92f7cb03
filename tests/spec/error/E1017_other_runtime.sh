# An episode that another library encoded than the targets.
. "$SPECS/../encoding.bash"
echo > ep.mp4
"$ETLC" embed t.etl --data ep.mp4 -o out --runtime onnxruntime
"$ETLC" run t.etl --trace out/ep.npz --summary
"$ETLC" embed t.etl
"$ETLC" run t.etl --trace out/ep.npz --summary
