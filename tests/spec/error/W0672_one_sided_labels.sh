# Labels that are all alike, in the calibration and in the evaluation.
cat > dock.etl <<'END2'
spec dock;
input z : f32[2];
target goal = [[0, 0]];
predicate docked = l2(z, goal) <= calibrated(conformal, alpha = 0.4);
monitor arrives = F docked;
END2
drives() { # LABEL FIRST LAST
    for i in $(seq $2 $3); do
        printf 'z[0],z[1],truth.docked\n0.%s,0.5,%s\n1.%s,2,%s\n' $i $1 $i $1 > $i.csv
    done
}
drives 1 1 4
"$ETLC" calibrate dock.etl --data 1.csv 2.csv 3.csv 4.csv
echo "exit status $?"
drives 0 5 6
"$ETLC" evaluate dock.etl --data 5.csv 6.csv > report.txt
echo "exit status $?"
"$ETLC" evaluate dock.etl --data 5.csv 6.csv --diagnostics json 2>&1 > report.txt | grep -c W0672
