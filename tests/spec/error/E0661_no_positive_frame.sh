# No demonstration has a positive frame; or none has a distance at one.
cat > hand.etl <<'END'
spec hand;
input grip, force : f32;
predicate held = grip >= calibrated(conformal, alpha = 0.5);
truth held = force > 1;
monitor holds = F held;
END
printf 'grip,force\n1,0\n2,1\n' > never.csv
printf 'grip,force\n1,0\n,2\nnan,3\n' > unmeasured.csv
"$ETLC" calibrate hand.etl --data never.csv
echo "exit status $?"
"$ETLC" calibrate hand.etl --data never.csv unmeasured.csv
echo "exit status $?"
ls
