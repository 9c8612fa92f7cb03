# The same fault in many episodes is reported once, with their number, and another fault separately.
cat > hand.etl <<'END'
spec hand;
input grip : f32;
predicate held = grip >= calibrated(conformal, alpha = 0.5);
monitor holds = F held;
END
for e in 01 02 03 04 05 06 07 08 09 10 11 12; do printf 'grip,truth_held\n0.75,1\n' > $e.csv; done
printf 'grip,truth.held\n0.5,1\n1,0\n' > labelled.csv
printf 'grip,truth.held\n0.5,yes\n' > spelled.csv
"$ETLC" calibrate hand.etl --data .
