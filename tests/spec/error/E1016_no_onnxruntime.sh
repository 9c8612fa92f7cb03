# ONNX Runtime is not found, or crashes etlc-embed.
. "$SPECS/../encoding.bash"
decodes 68 "is not run: there is no ONNX Runtime"
sed -i 's/^onnxruntime).*/onnxruntime) ;;/' embedder
"$ETLC" embed t.etl
sed -i 's/^onnxruntime).*/onnxruntime) kill -BUS $$ ;;/' embedder
"$ETLC" embed t.etl --onnxruntime a.so
ls
