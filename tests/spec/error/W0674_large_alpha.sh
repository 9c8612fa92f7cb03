# An alpha above 0.5 is probably meant as a coverage; 0.5 itself gets no warning.
cat > t.etl <<'END2'
spec t;
input z : f32[2];
target goal = [[0, 0]];
predicate near = l2(z, goal) <= calibrated(conformal, alpha = 0.9);
predicate even = l2(z, goal) <= calibrated(conformal, alpha = 0.5);
monitor m = F near && F even;
END2
printf 'z[0],z[1],truth.near,truth.even\n1,0.5,1,1\n2,2,0,0\n' > a.csv
printf 'z[0],z[1],truth.near,truth.even\n0.25,1,1,1\n2,3,0,0\n' > b.csv
"$ETLC" calibrate t.etl --data a.csv b.csv > report.txt
echo "exit status $?"
"$ETLC" t.etl --check
echo "exit status $?"
