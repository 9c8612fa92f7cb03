# Elements that are not valid samples of their input.
cat > t.etl <<'END'
spec t;
input z : f32[2];
input grip : f32;
input held : bool;
target goal = [[1, 2]];
monitor m = F (l2(z, goal) <= 1 && grip > 0.5 && held);
END
for trace in bool not_bool big_endian; do
    "$ETLC" run t.etl --trace "$SPECS/E0808_$trace.npz" -o verdicts.csv 2>&1 | sed "s|$SPECS/||"
done
ls
