cat > t.etl <<'END'
spec t;
input z : f32[2];
target missing = load("no_such.npy");
target archive = load("no_such/file.npz", "goal");
predicate p = l2(z, missing) <= 1;
predicate q = l2(z, archive) <= 1;
monitor m = F (p && q);
END
"$ETLC" t.etl -o t.hpp
