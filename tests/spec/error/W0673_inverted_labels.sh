# Labels, or a comparison, the wrong way round: the area under the ROC curve is clearly below 0.5.
cat > dock.etl <<'END2'
spec dock;
input x : f32;
target goal = [[0]];
predicate docked = l2([x], goal) <= calibrated(conformal, alpha = 0.2);
predicate far    = l2([x], goal) > 8;
monitor arrives = F docked && F far;
END2
for i in 1 2 3 4 5 6 7 8 9; do
    printf 'x,truth.docked,truth.far\n'
    for step in 1 2 3 4 5 6 7 8 9 10 11 12; do
        echo "$step.$i,$((step > 8)),$((step > 8))"
    done
done | awk '/^x/ { file = "e" ++n ".csv" } { print > file }'
"$ETLC" calibrate dock.etl --data e1.csv e2.csv e3.csv e4.csv > report.txt
echo "exit status $?"
rm dock.thresholds.json
"$ETLC" calibrate dock.etl --data . > report.txt
echo "exit status $?"
sed -i 's/<= calibrated(conformal, alpha = 0.2)/<= 8.5/' dock.etl
"$ETLC" evaluate dock.etl --data . > report.txt
echo "exit status $?"
