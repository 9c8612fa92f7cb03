# etlc without OpenCV and FFmpeg.
. "$SPECS/../encoding.bash"
ETLC_EMBEDDER=/nowhere "$ETLC" embed t.etl
