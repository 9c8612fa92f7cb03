# The same recording under two names, in two number formats, with other labels.
cat > hand.etl <<'END'
spec hand;
input grip, force : f32;
predicate held = grip >= calibrated(conformal, alpha = 0.5);
truth held = force > 1;
monitor holds = F held;
END
printf 'grip,force\n0.5,2\n1,0\n' > a.csv
printf 'force,grip\n9,0.50\n2,1e0\n' > b.csv
printf 'grip,force\n1,0\n0.5,2\n' > c.csv
"$ETLC" calibrate hand.etl --data a.csv b.csv c.csv
echo "exit status $?"
ls
