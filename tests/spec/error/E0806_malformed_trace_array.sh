# Arrays of a trace are read as strictly as targets.
. "$SPECS/../trace.bash"
echo 'no zip' > trace.npz; "$ETLC" run t.etl --trace trace.npz
"$ETLC" run t.etl --trace "$SPECS/E0806_cut_short.npz" -o verdicts.csv 2>&1 | sed "s|$SPECS/||"
head -c 600 "$SPECS/E0806_cut_short.npz" > trace.npz; "$ETLC" run t.etl --trace trace.npz
echo 'no HDF5' > trace.h5; "$ETLC" run t.etl --trace trace.h5
"$ETLC" run t.etl --trace "$SPECS/../../fuzz/corpus/fuzz_hdf5/crashes_reading_1.h5" --map grip=g \
    --map held=b 2>&1 | sed "s|$SPECS/||"
