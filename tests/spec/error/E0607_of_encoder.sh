# Fits to embeddings of another model than the spec now has.
. "$SPECS/../encoding.bash"
sed -i '/^target/s/$/\ntarget mean = fitted(mean, of = z, where = true);/; s/z, bay/z, mean/' t.etl
echo > ep.mp4
embeds_each --data ep.mp4 -o out > /dev/null
"$ETLC" fit t.etl --data out/ep.npz | head -3
"$ETLC" run t.etl --trace out/ep.npz --summary
echo another > net.onnx
embeds_each --data ep.mp4 -o other > /dev/null
"$ETLC" run t.etl --trace other/ep.npz --summary
