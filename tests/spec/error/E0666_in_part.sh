# Most of an episode that the predicates have seen; accepted for a reason, which the file keeps.
cat > dock.etl <<'END'
spec dock;
input z  : f32[2];
input px : f32;
target goal = [[0, 0]];
predicate docked = l2(z, goal) <= calibrated(conformal, alpha = 0.5);
truth docked = px < 0.5;
monitor arrives = F docked calibrated(conformal, alpha = 0.5, against = missed_success);
END
drive() { # SEED
    awk -v seed="$1" 'function r() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
        BEGIN { print "z[0],z[1],px"
            for (t = 0; t < 40; t++) printf "%.6f,%.6f,%.6f\n", r(), 1 + r(), 1 - t / 40 }'
}
for seed in 1 2 3; do drive $seed > $seed.csv; done
head -36 2.csv > part.csv
"$ETLC" calibrate dock.etl --data 1.csv 2.csv -o predicates.json > report.txt
"$ETLC" calibrate dock.etl --data part.csv 3.csv --thresholds predicates.json
"$ETLC" calibrate dock.etl --data part.csv 3.csv --thresholds predicates.json \
    --allow-overlap 'driven on another day' | tail -1
"$ETLC" dock.etl --check && echo believed
sed -i '/"allowances"/,/^  \],/d' dock.thresholds.json
"$ETLC" dock.etl --check
