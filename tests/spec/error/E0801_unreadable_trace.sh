# A missing trace, and a folder.
cat > t.etl <<'END'
spec t;
input z : f32[2];
input grip : f32;
input held : bool;
target goal = [[1, 2]];
monitor m = F (l2(z, goal) <= 1 && grip > 0.5 && held);
END
mkdir folder.csv
touch run_01.csv
for trace in no_such.csv no_such.npz folder.csv run_1.csv; do "$ETLC" run t.etl --trace $trace; done
