# A trace without steps must not look like success.
cat > t.etl <<'END'
spec t;
input x, px : f32;
predicate p = x <= calibrated(conformal, alpha = 0.5);
truth p = px < 1;
monitor m = F p;
END
printf 'x,px\n' > empty.csv
printf 'x,px\n0,0\n' > a.csv
"$ETLC" calibrate t.etl --data a.csv empty.csv
"$ETLC" calibrate t.etl --data a.csv > report.txt
"$ETLC" run t.etl --trace empty.csv -o verdicts.csv
echo "exit status $?"
"$ETLC" evaluate t.etl --data empty.csv
echo "exit status $?"
ls
