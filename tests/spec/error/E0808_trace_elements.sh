# Elements that are not valid samples of their input.
. "$SPECS/../trace.bash"
for trace in bool not_bool big_endian; do
    "$ETLC" run t.etl --trace "$SPECS/E0808_$trace.npz" -o verdicts.csv 2>&1 | sed "s|$SPECS/||"
done
ls
