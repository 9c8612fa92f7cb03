# Monitors are calibrated on other episodes than their predicates; this is valid until something
# changes.
cat > hand.etl <<'END'
spec hand;
input grip, force : f32;
predicate held = grip >= calibrated(conformal, alpha = 0.5);
truth held = force > 1;
monitor holds = F held calibrated(conformal, alpha = 0.5, against = missed_alarm);
END
for i in 1 2 3 4; do printf "grip,force\n0.$i,0\n0.6$i,2\n" > "$i.csv"; done
"$ETLC" calibrate hand.etl --data 1.csv 2.csv -o predicates.json > report.txt
echo "exit status $?"
"$ETLC" calibrate hand.etl --data 2.csv 3.csv --thresholds predicates.json
echo "exit status $?"
"$ETLC" calibrate hand.etl --data 3.csv 4.csv 3.csv --thresholds predicates.json
echo "exit status $?"
"$ETLC" hand.etl --check && "$ETLC" run hand.etl --trace 1.csv
"$ETLC" hand.etl --values boolean -o hand.hpp
sed -i 's/missed_alarm/missed_success/' hand.etl
"$ETLC" hand.etl --check
sed -i 's/ calibrated(conformal, alpha = 0.5, against = missed_success)//' hand.etl
"$ETLC" calibrate hand.etl --data 3.csv --thresholds predicates.json
