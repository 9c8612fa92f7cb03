# Against both errors one threshold may be infinite, and is named; not both. No frame may be left
# near a change.
cat > hand.etl <<'EOF'
spec hand;
input grip, force : f32;
predicate held = grip >= calibrated(conformal, alpha = 0.1, against = both);
truth held     = force > 1;
monitor holds  = F held;
EOF
for i in 1 2 3 4 5 6 7 8 9; do printf "grip,force\n1,0\n2,0\n$i,2\n5,2\n" > "$i.csv"; done
"$ETLC" calibrate hand.etl --data .
sed -i 's/alpha = 0.1,/alpha = 0.1, beta = 0.05,/' hand.etl
"$ETLC" calibrate hand.etl --data .
for change in 's/alpha = 0.1/alpha = 0.02/' 's/against = both/against = both, within = 4 steps/' \
              's/, beta = 0.05, against = both/, against = false_positives, within = 4 steps/' \
              's/conformal, alpha = 0.1/risk, alpha = 0.01/'; do
    sed "$change" hand.etl > other.etl
    "$ETLC" calibrate other.etl --data .
    echo "exit status $?"
done
