# Neither a truth in the spec nor an array in the episode.
cat > hand.etl <<'END'
spec hand;
input grip : f32;
predicate held = grip >= calibrated(conformal, alpha = 0.5);
monitor holds = F held;
END
printf 'grip,truth.held\n0.5,1\n1,0\n' > a.csv
printf 'grip\n0.75\n1\n' > b.csv
"$ETLC" calibrate hand.etl --data a.csv b.csv
echo "exit status $?"
ls
