# The extension of a trace determines its format.
cat > t.etl <<'END'
spec t;
input z : f32[2];
input grip : f32;
input held : bool;
target goal = [[1, 2]];
monitor m = F (l2(z, goal) <= 1 && grip > 0.5 && held);
END
echo 'z[0],z[1],grip,held' > trace.txt
for trace in trace.txt no_such.npy; do "$ETLC" run t.etl --trace $trace; done
