# Enough episodes need a step at which the ground truth is what the monitor must not miss, and rho
# must be finite.
cat > hand.etl <<'END'
spec hand;
input grip, force : f32;
input on : bool;
predicate held = grip >= 0.5;
truth held = force > 1;
monitor holds = F held calibrated(conformal, alpha = 0.1, against = missed_success);
monitor never = G (force > -1) calibrated(conformal, alpha = 0.5, against = missed_alarm);
monitor on_or_held = F (on || held) calibrated(conformal, alpha = 0.5, against = missed_success);
END
printf 'grip,force,on\n0.5,2,1\n' > a.csv
printf 'grip,force,on\n0.75,2,1\n' > b.csv
printf 'grip,force,on\n0.25,0,1\n' > c.csv
"$ETLC" calibrate hand.etl --data a.csv b.csv c.csv
echo "exit status $?"
ls
