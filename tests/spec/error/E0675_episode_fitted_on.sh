# A fit separates its own episodes better than any others, so thresholds and figures need other
# episodes, whatever the names of the files.
cat > t.etl <<'SPEC'
spec t;
input z : f32[2];
input px : f32;
target mean = fitted(mean, of = z, where = p);
predicate p = min l2(z, mean) <= calibrated(f1);
truth p = px < 1;
monitor m = F p;
SPEC
mkdir demonstrations others
for e in 1 2 3; do
  printf 'z[0],z[1],px\n0.%d,0,0\n0.9,2,2\n' $e > demonstrations/$e.csv
  printf 'z[0],z[1],px\n0.%d5,0,0\n0.8,2,2\n' $e > others/$e.csv
done
"$ETLC" fit t.etl --data demonstrations > report.txt
printf 'px,z[0],z[1],note\n5,0.10,0,a\n5,9e-1,2,b\n' > others/relabelled.csv
"$ETLC" calibrate t.etl --data others
rm others/relabelled.csv
"$ETLC" calibrate t.etl --data others > report.txt
"$ETLC" evaluate t.etl --data demonstrations/1.csv
