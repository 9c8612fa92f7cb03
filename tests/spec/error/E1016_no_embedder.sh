# etlc without FFmpeg, libpng and libjpeg.
. "$SPECS/../encoding.bash"
ETLC_EMBEDDER=/nowhere "$ETLC" embed t.etl
