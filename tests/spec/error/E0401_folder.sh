# A folder with the name of an array.
mkdir goal.npy goal.npz
cat > t.etl <<'END'
spec t;
input z : f32[2];
target a = load("goal.npy");
target b = load("goal.npz", "goal");
monitor m = F (l2(z, a) <= 1 && l2(z, b) <= 1);
END
"$ETLC" t.etl --check
