# A file that does not come from 'etlc fit' is distinguished from a damaged one.
cat > t.etl <<'SPEC'
spec t;
input z : f32[2];
target g = fitted(mean, of = z, where = true);
predicate near = min l2(z, g) <= 1;
monitor m = F near;
SPEC
printf 'z[0],z[1]\n1,2\n2,4\n' > 1.csv
printf 'PK\5\6%018d' 0 | tr 0 '\0' > t.fitted.npz
"$ETLC" t.etl --check
"$ETLC" fit t.etl --data 1.csv > report.txt
sed 's/"format": 3,/"format": 3 /' t.fitted.npz > damaged.npz
"$ETLC" t.etl --check --fitted damaged.npz
