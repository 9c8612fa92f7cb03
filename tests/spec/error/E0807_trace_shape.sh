# Shapes that do not match the inputs, and arrays of different lengths.
. "$SPECS/../trace.bash"
for trace in wide flat lengths; do "$ETLC" run t.etl --trace "$SPECS/E0807_$trace.npz" 2>&1 |
    sed "s|$SPECS/||"; done
echo 'z[0],z[1],z[2],grip,held' > trace.csv; "$ETLC" run t.etl --trace trace.csv
