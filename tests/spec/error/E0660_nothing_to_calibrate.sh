# A spec with literal thresholds only.
cat > hand.etl <<'END'
spec hand;
input grip : f32;
predicate held = grip >= 0.5;
monitor holds = F held;
END
printf 'grip\n1\n' > hand.csv
"$ETLC" calibrate hand.etl --data hand.csv
echo "exit status $?"
ls
