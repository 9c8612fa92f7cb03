# Changes of everything that embeddings are made from: images, model, settings. Building a monitor
# does not need the original files.
. "$SPECS/../encoding.bash"
embeds "$dimension$row$row$references" > /dev/null
echo another > bay/2.png
echo three > bay/3.png
"$ETLC" t.etl --check
rm bay/1.png
"$ETLC" t.etl --check
rm -r bay
"$ETLC" t.etl --check
echo other > net.onnx
"$ETLC" t.etl --check
echo model > net.onnx
echo '{"mean": [0.5, 0.5, 0.5]}' > net.json
"$ETLC" t.etl --check
rm net.onnx net.json
"$ETLC" t.etl --check && echo taken
sed -i 's/image \[1, 1\]/image [2, 2]/; s/f32\[2\]/f32[3]/' t.etl
"$ETLC" t.etl --check
