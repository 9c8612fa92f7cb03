# alpha = 0.1 takes nine demonstrations. The guarantee is never silently dropped.
cat > hand.etl <<'END'
spec hand;
input grip, force : f32;
predicate held   = grip >= calibrated(conformal, alpha = 0.1);
predicate pushed = grip >= calibrated(class_conditional, alpha = 0.01);
truth held   = force > 1;
truth pushed = force > 1;
monitor holds  = F held;
monitor pushes = F pushed;
END
for i in 1 2 3 4 5 6 7 8; do printf "grip,force\n$i,2\n" > "$i.csv"; done
printf 'grip,force\n0,0\n' > without.csv
"$ETLC" calibrate hand.etl --data .
echo "exit status $?"
printf 'grip,force\n9,2\n' > 9.csv
sed -i '/pushe/d' hand.etl
"$ETLC" calibrate hand.etl --data . > report.txt
echo "exit status $?"
ls
