# A threshold that would start outside [lo, hi] is refused during calibration, and if the spec
# changed afterwards.
cat > hand.etl <<'END'
spec hand;
input grip, force : f32;
predicate held = grip >= calibrated(adaptive, alpha = 0.5, gamma = 0.0625, lo = 0.25, hi = 1);
truth held = force > 1;
monitor holds = F held;
END
for i in 1 2 3; do printf "grip,force\n0.1,0\n0.6$i,2\n" > "$i.csv"; done
"$ETLC" calibrate hand.etl --data 1.csv 2.csv 3.csv
echo "exit status $?"
sed -i 's/lo = 0.25/lo = 0.5/' hand.etl && "$ETLC" hand.etl --check &&
    "$ETLC" run hand.etl --trace 3.csv
sed -i 's/lo = 0.5/lo = 0.75/' hand.etl
"$ETLC" hand.etl --check
"$ETLC" calibrate hand.etl --data 1.csv 2.csv 3.csv
echo "exit status $?"
sed -i 's/alpha = 0.5/alpha = 0.4/' hand.etl
"$ETLC" hand.etl --check
sed -i 's/adaptive, alpha = 0.4, gamma = 0.0625, lo = 0.75, hi = 1/conformal, alpha = 0.5/' hand.etl
"$ETLC" hand.etl --check
