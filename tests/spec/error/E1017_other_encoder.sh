# An episode, and a frame of it, by a model that the spec no longer has.
. "$SPECS/../encoding.bash"
echo > ep.mp4
embeds_each --data ep.mp4 -o out
"$ETLC" run t.etl --trace out/ep.npz --summary
echo another > net.onnx
embeds_each > /dev/null
"$ETLC" run t.etl --trace out/ep.npz --summary
"$ETLC" run t.etl --trace out/ep.npz --summary --map z=y
# Nor are its frames a target beside those of the other encoder.
sed 's|^target.*|target bay = frames("out/ep.npz", "z", [0]);|' t.etl > u.etl
mv t.embedded.npz u.embedded.npz
"$ETLC" u.etl -o u.hpp
