# An error in the calibration of a fold names the fold.
cat > t.etl <<'END'
spec t;
input x : f32;
predicate near = x <= calibrated(conformal, alpha = 0.4);
truth near = x <= 0.5;
monitor m = F near;
END
for e in 1 2 3; do printf 'x\n0.%s\n1\n' $e > $e.csv; done
"$ETLC" crossvalidate t.etl --data [123].csv --folds 3 | head -6
echo "and with fewer others:"
"$ETLC" crossvalidate t.etl --data [12].csv --folds 2
