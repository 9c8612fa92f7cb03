# A missing model, and one that etlc-embed refuses.
. "$SPECS/../encoding.bash"
decodes 65 "takes 2 inputs, expected one image: 'x' (1 x 3 x 8 x 8), 'y' (1)"
sed -i 's/^images)/images) trap "exit 0" EXIT;/' embedder
"$ETLC" embed t.etl
rm net.onnx
"$ETLC" embed t.etl
