# Thresholds must be evaluated on other episodes than those used for calibration, whatever the names
# of the files.
cat > t.etl <<'SPEC'
spec t;
input x, px : f32;
predicate p = x <= calibrated(f1);
truth p = px < 1;
monitor m = F p;
SPEC
mkdir demonstrations tests
for e in 1 2 3; do printf 'x,px\n0.%d,0\n0.9,2\n' $e > demonstrations/$e.csv; done
"$ETLC" calibrate t.etl --data demonstrations > report.txt
printf 'x,px\n0.5,0\n0.8,2\n' > tests/new.csv
"$ETLC" evaluate t.etl --data tests > table.txt && head -1 table.txt
printf 'x,note,px\n0.20,a,5\n9e-1,b,5\n' > tests/relabelled.csv
"$ETLC" evaluate t.etl --data tests
"$ETLC" evaluate t.etl --data tests demonstrations/1.csv
