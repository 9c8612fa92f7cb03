# Episodes used for calibration are recognised by their content, also if some frames are missing,
# and if the spec has other predicates since.
cat > two.etl <<'END'
spec two;
input z, w : f32[2];
input px : f32;
target goal = [[0, 0]];
predicate docked = l2(z, goal) <= calibrated(conformal, alpha = 0.5);
predicate seen   = l2(w, goal) <= calibrated(conformal, alpha = 0.5);
truth docked = px < 0.5;
truth seen   = px < 0.75;
monitor arrives = F docked;
monitor looks   = F seen;
END
drive() { # SEED
    awk -v seed="$1" 'function r() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
        BEGIN { print "z[0],z[1],w[0],w[1],px"
            for (t = 0; t < 40; t++)
                printf "%.6f,%.6f,%.6f,%.6f,%.6f\n", r(), r(), r(), r(), 1 - t / 40 }'
}
for seed in 1 2 3; do drive $seed > $seed.csv; done
head -35 2.csv > part.csv
"$ETLC" calibrate two.etl --data 1.csv 2.csv -o thresholds.json > report.txt
grep -v 'seen' two.etl > one.etl
for spec in two one; do
    "$ETLC" evaluate $spec.etl --thresholds thresholds.json --data 3.csv | head -1
    "$ETLC" evaluate $spec.etl --thresholds thresholds.json --data 1.csv 3.csv
    "$ETLC" evaluate $spec.etl --thresholds thresholds.json --data 3.csv part.csv
done
"$ETLC" evaluate one.etl --thresholds thresholds.json --data 3.csv part.csv --json figures.json \
    --allow-overlap 'the lighting differs' > table.txt
head -2 table.txt
grep -E 'reservations|overlapping_episodes' figures.json
"$ETLC" evaluate one.etl --thresholds thresholds.json --data 1.csv --allow-overlap 'the same'
