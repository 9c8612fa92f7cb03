# Thresholds and fits of an earlier version: its episodes cannot be compared with others, so they
# are refused where that matters. Specs with these files still compile.
cat > dock.etl <<'END2'
spec dock;
input z : f32[2];
target goal = [[0, 0]];
predicate docked = l2(z, goal) <= calibrated(conformal, alpha = 0.5);
monitor arrives = F docked;
monitor stays   = G docked calibrated(conformal, alpha = 0.5, against = missed_alarm);
END2
for i in 1 2 3 4; do
    printf 'z[0],z[1],truth.docked\n0.%s,0.5,1\n1.%s,2,0\n' $i $i > $i.csv
done
"$ETLC" calibrate dock.etl --data 1.csv 2.csv -o old.json > /dev/null
grep '"format"' old.json
sed -i 's/"format": 2/"format": 1/' old.json
"$ETLC" calibrate dock.etl --data 3.csv 4.csv --thresholds old.json -o new.json
echo "exit status $?"
sed -i '/monitor stays/d' dock.etl
"$ETLC" evaluate dock.etl --data 3.csv 4.csv --thresholds old.json
echo "exit status $?"
"$ETLC" dock.etl --check --thresholds old.json
echo "exit status $?"
