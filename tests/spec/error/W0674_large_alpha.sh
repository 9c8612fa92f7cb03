# An alpha above 0.5 is probably meant as a coverage, in every method; 0.5 itself gets no warning.
cat > t.etl <<'END2'
spec t;
input z : f32[2];
target goal = [[0, 0]];
predicate near = l2(z, goal) <= calibrated(conformal, alpha = 0.9);
predicate even = l2(z, goal) <= calibrated(conformal, alpha = 0.5);
predicate some = l2(z, goal) <= calibrated(class_conditional, alpha = 0.75);
predicate held = l2(z, goal) <= calibrated(adaptive, alpha = 0.99, gamma = 0.1, lo = 0, hi = 9);
monitor m = F near && F even && F some && F held;
END2
cat > whole.etl <<'END2'
spec whole;
input z : f32[2];
target goal = [[0, 0]];
predicate even = l2(z, goal) <= 1;
monitor w = F even calibrated(conformal, alpha = 0.8, against = missed_success);
END2
head=z[0],z[1],truth.near,truth.even,truth.some,truth.held
printf "$head"'\n1,0.5,1,1,1,1\n2,2,0,0,0,0\n' > a.csv
printf "$head"'\n0.25,1,1,1,1,1\n2,3,0,0,0,0\n' > b.csv
for spec in t whole; do
    "$ETLC" calibrate $spec.etl --data a.csv b.csv > report.txt
    echo "exit status $?"
    "$ETLC" $spec.etl --check
    echo "exit status $?"
done
