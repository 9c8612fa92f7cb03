# Frames on a line vary in one direction; components in a second one would be arbitrary.
cat > t.etl <<'SPEC'
spec t;
input z : f32[3];
projection Q = fitted(whitened_pca, r = 2, of = z, where = true);
target g = fitted(mean, of = Q(z), where = true);
predicate near = min l2(Q(z), g) <= 1;
monitor m = F near;
SPEC
printf 'z[0],z[1],z[2]\n1,2,0\n2,4,0\n3,6,0\n5,10,0\n' > 1.csv
"$ETLC" fit t.etl --data 1.csv
