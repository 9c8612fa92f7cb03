# Shapes that do not match the inputs, and arrays of different lengths.
cat > t.etl <<'END'
spec t;
input z : f32[2];
input grip : f32;
input held : bool;
target goal = [[1, 2]];
monitor m = F (l2(z, goal) <= 1 && grip > 0.5 && held);
END
for trace in wide flat lengths; do "$ETLC" run t.etl --trace "$SPECS/E0807_$trace.npz" 2>&1 |
    sed "s|$SPECS/||"; done
echo 'z[0],z[1],z[2],grip,held' > trace.csv; "$ETLC" run t.etl --trace trace.csv
