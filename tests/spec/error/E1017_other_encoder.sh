# An episode, and a frame of it, by a model that is not the spec's any more.
. "$SPECS/../encoding.bash"
echo > ep.mp4
embeds_each --data ep.mp4 -o out
"$ETLC" run t.etl --trace out/ep.npz --summary
echo another > net.onnx
embeds_each > /dev/null
"$ETLC" run t.etl --trace out/ep.npz --summary
"$ETLC" run t.etl --trace out/ep.npz --summary --map z=y
# Its frames are no target beside the other encoder's either.
sed 's|^target.*|target bay = frames("out/ep.npz", "z", [0]);|' t.etl > u.etl
mv t.embedded.npz u.embedded.npz
"$ETLC" u.etl -o u.hpp
