# A discriminant separates two classes, so both need frames.
cat > t.etl <<'SPEC'
spec t;
input z : f32[2];
input px : f32;
predicate p = px < 1;
projection L = fitted(discriminant, r = 1, of = z, where = p);
target g = fitted(mean, of = L(z), where = p);
predicate near = min l2(L(z), g) <= 1;
monitor m = F near;
SPEC
for e in 1 2; do printf 'z[0],z[1],px\n0.%d,0,0\n0.9,2,0.5\n' $e > $e.csv; done
"$ETLC" fit t.etl --data 1.csv 2.csv
