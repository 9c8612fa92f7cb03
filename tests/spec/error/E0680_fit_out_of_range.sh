# Whitening a direction with almost no variance needs numbers beyond float32.
cat > t.etl <<'SPEC'
spec t;
input z : f32[1];
projection Q = fitted(whitened_pca, r = 1, of = z, where = true);
target g = fitted(mean, of = Q(z), where = true);
predicate near = min l2(Q(z), g) <= 1;
monitor m = F near;
SPEC
printf 'z[0]\n1e-42\n2e-42\n3e-42\n' > 1.csv
"$ETLC" fit t.etl --data 1.csv
