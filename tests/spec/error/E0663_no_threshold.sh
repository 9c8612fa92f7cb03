# An infinite score at the rank; positive frames that < with an observed distance never finds.
cat > hand.etl <<'END'
spec hand;
input grip, force : f32;
predicate held   = 1 / grip <= calibrated(conformal, alpha = 0.5);
predicate loose  = grip < calibrated(f1);
truth held  = force > 1;
truth loose = force > 1;
monitor holds = F held;
monitor slips = F loose;
END
printf 'grip,force\n0,2\n' > hand.csv
"$ETLC" calibrate hand.etl --data hand.csv
echo "exit status $?"
ls
