# Shared by cases of traces: a spec with an input of each type. Source it in an empty folder.
cat > t.etl <<'END'
spec t;
input z : f32[2];
input grip : f32;
input held : bool;
target goal = [[1, 2]];
monitor m = F (l2(z, goal) <= 1 && grip > 0.5 && held);
END
