# A fit on an episode and on most of it again uses one of them twice. The reason for accepting it is
# shown with everything about the fit.
cat > t.etl <<'SPEC'
spec t;
input z : f32[2];
input px : f32;
target mean = fitted(mean, of = z, where = p);
predicate p = min l2(z, mean) <= calibrated(conformal, alpha = 0.5);
truth p = px < 1;
monitor m = F p;
SPEC
drive() { # SEED: 40 steps
    awk -v seed="$1" 'function r() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
        BEGIN { print "z[0],z[1],px"
            for (t = 0; t < 40; t++) printf "%.6f,%.6f,%.6f\n", r(), 1 + r(), 2 - t / 20 }'
}
drive 1 > a.csv
drive 2 > b.csv
{ head -1 b.csv; tail -30 b.csv; } > most_of_it.csv
"$ETLC" fit t.etl --data a.csv b.csv most_of_it.csv
echo "exit status $?"
"$ETLC" fit t.etl --data a.csv b.csv most_of_it.csv \
    --allow-overlap 'filmed on two days' | grep allow
drive 4 > d.csv
drive 5 > e.csv
"$ETLC" calibrate t.etl --data d.csv e.csv > report.txt
grep -A 1 allow report.txt
"$ETLC" t.etl -o t.hpp && grep -A 1 allow t.hpp
"$ETLC" t.etl --emit report | grep -A 1 allow
"$ETLC" evaluate t.etl --data a.csv
drive 3 > c.csv
"$ETLC" evaluate t.etl --data c.csv | grep -A 1 allow
"$ETLC" fit t.etl --data a.csv b.csv --allow-overlap 'not needed' | tail -1
