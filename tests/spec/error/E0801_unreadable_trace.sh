# A missing trace, and a folder.
. "$SPECS/../trace.bash"
mkdir folder.csv
touch run_01.csv
for trace in no_such.csv no_such.npz folder.csv run_1.csv; do "$ETLC" run t.etl --trace $trace; done
