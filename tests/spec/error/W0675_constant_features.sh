# Elements that never change may be a fault of the encoder; their effect would be unknown.
cat > t.etl <<'SPEC'
spec t;
input z : f32[3];
projection Q = fitted(pca, r = 1, of = z, where = true);
target g = fitted(mean, of = Q(z), where = true);
predicate near = min l2(Q(z), g) <= 1;
monitor m = F near;
SPEC
printf 'z[0],z[1],z[2]\n1,2,0\n2,4,0\n3,5,0\n5,10,0\n' > 1.csv
"$ETLC" fit t.etl --data 1.csv > report.txt
