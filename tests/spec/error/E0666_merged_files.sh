# Predicates calibrated again on the episodes of the monitors, and the two files merged by hand.
cat > hand.etl <<'END'
spec hand;
input grip, force : f32;
predicate held = grip >= calibrated(conformal, alpha = 0.5);
truth held = force > 1;
monitor holds = F held calibrated(conformal, alpha = 0.5, against = missed_alarm);
END
for i in 1 2 3 4; do printf "grip,force\n0.$i,0\n0.6$i,2\n" > "$i.csv"; done
"$ETLC" calibrate hand.etl --data 1.csv 2.csv -o predicates.json > report.txt
"$ETLC" calibrate hand.etl --data 3.csv 4.csv --thresholds predicates.json > report.txt
"$ETLC" hand.etl --check && echo believed
hash=$(sed -n '/"monitors"/,$ s/^        "\([0-9a-f]*\)".*/\1/p' hand.thresholds.json | head -1)
sed -i "s/^  \"episodes\": \[/&\n    \"$hash\",/" hand.thresholds.json
"$ETLC" hand.etl --check
