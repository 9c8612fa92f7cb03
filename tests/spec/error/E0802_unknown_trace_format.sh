# The extension of a trace determines its format.
. "$SPECS/../trace.bash"
echo 'z[0],z[1],grip,held' > trace.txt
for trace in trace.txt no_such.npy; do "$ETLC" run t.etl --trace $trace; done
