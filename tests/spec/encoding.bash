# Shared by cases of `etlc embed`, without FFmpeg, ONNX Runtime or Python: images and videos of one
# pixel per file, and encoders with constant results. Source it in an empty folder.

dimension='\002\000\000\000'
row='\000\000\200\077\000\000\000\100' # 1, 2
# Behind what a spec names, an encoder gets the four reference frames of 480 x 640 pixels, and the
# first of them again.
other='\000\000\000\100\000\000\000\100' # 2, 2
references=$row$other$other$other$row
count='n=$(wc -c); last=
    [ $n -lt 4608040 ] || { n=$((n - 4608040)); last="'$references'"; }; n=$((n / 11))'

# decodes [STATUS WORDS]: makes a program in place of etlc-embed, which prints one pixel per file,
# and this row per frame, then exits with STATUS.
decodes() {
    cat > embedder << END
#!/bin/sh
case \$1 in
images) shift; for file; do printf '\\001\\000\\000\\000\\001\\000\\000\\000abc'; done ;;
video) printf '\\001\\000\\000\\000\\001\\000\\000\\000abc' ;;
onnxruntime) echo "\${VERSION:-1.30.0}"; echo /a/library; exit 0 ;;
encode) $count; printf '$dimension'
    while [ \$n -gt 0 ]; do printf '$row'; n=\$((n - 1)); done; printf "\$last" ;;
esac
echo "${2:-}" >&2
exit ${1:-0}
END
    chmod +x embedder
}

export ETLC_EMBEDDER=./embedder
decodes
mkdir bay
echo one > bay/1.png
echo two > bay/2.png
echo model > net.onnx
cat > t.etl << 'END'
spec t;
rate 10 Hz;
encoder net = load("net.onnx"), image [1, 1];
input z : f32[2] by net;
target bay = images("bay/*.png") by net;
monitor m = F min l2(z, bay) <= 1;
END

# embeds_each ARGUMENT...: `etlc embed` with an encoder that prints this row for every frame.
embeds_each() {
    "$ETLC" embed t.etl "$@" --encoder-cmd "$count; printf '$dimension'
        while [ \$n -gt 0 ]; do printf '$row'; n=\$((n - 1)); done; printf \"\$last\""
}

# embeds BYTES ARGUMENT...: `etlc embed` with an encoder that reads all frames and writes these.
# Behind rows of frames belong $references.
embeds() {
    "$ETLC" embed t.etl --encoder-cmd "cat > frames; printf '$1'" "${@:2}"
}
