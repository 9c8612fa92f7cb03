# Every fold holds out an episode; and folds compute thresholds from the episodes, without a file.
cat > t.etl <<'END'
spec t;
input x : f32;
predicate near = x <= calibrated(f1);
truth near = x <= 0.5;
monitor m = F near;
END
printf 'x\n0\n1\n' > a.csv
printf 'x\n0.25\n1\n' > b.csv
"$ETLC" crossvalidate t.etl --data a.csv b.csv
"$ETLC" evaluate t.etl --data a.csv b.csv --folds 3
"$ETLC" calibrate t.etl --data a.csv b.csv --folds 3
echo "exit status $?"
sed 's/F near/F near calibrated(conformal, alpha = 0.5, against = missed_alarm)/' t.etl > whole.etl
"$ETLC" crossvalidate whole.etl --data a.csv b.csv --folds 2
"$ETLC" crossvalidate t.etl --data a.csv b.csv --folds 2 --thresholds t.json
echo "exit status $?"
