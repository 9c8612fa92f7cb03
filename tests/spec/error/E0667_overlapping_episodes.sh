# An episode without its last frame, and most of one, are not other recordings; episodes that all
# begin with the same frame are. A reason accepts the former.
cat > dock.etl <<'END'
spec dock;
input z  : f32[2];
input px : f32;
target goal = [[0, 0]];
predicate docked = l2(z, goal) <= calibrated(conformal, alpha = 0.5);
truth docked = px < 0.5;
monitor arrives = F docked;
END
drive() { # SEED: 40 steps, of which all drives have the first
    awk -v seed="$1" 'function r() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
        BEGIN { print "z[0],z[1],px"; print "2,2,1"
            for (t = 1; t < 40; t++) printf "%.6f,%.6f,%.6f\n", r(), 1 + r(), 1 - t / 40 }'
}
drive 1 > a.csv
drive 2 > b.csv
head -40 a.csv > less_its_last.csv
{ head -1 b.csv; tail -30 b.csv; } > most_of_it.csv
"$ETLC" calibrate dock.etl --data a.csv b.csv -o -  > thresholds.json 2> report.txt
echo "exit status $?"
"$ETLC" calibrate dock.etl --data a.csv less_its_last.csv b.csv most_of_it.csv
echo "exit status $?"
"$ETLC" calibrate dock.etl --data a.csv less_its_last.csv b.csv most_of_it.csv \
    --allow-overlap 'the room has few places'
grep -A1 '"allowances"' dock.thresholds.json
"$ETLC" dock.etl --emit report | grep -A 1 allow
"$ETLC" dock.etl -o dock.hpp && grep -A 1 allow dock.hpp
# Equal ones are refused even then; so is an empty reason.
cp a.csv c.csv
"$ETLC" calibrate dock.etl --data a.csv c.csv --allow-overlap 'the room has few places'
"$ETLC" calibrate dock.etl --data a.csv b.csv --allow-overlap ' '
"$ETLC" calibrate dock.etl --data a.csv b.csv --allow-overlap 'not needed' | tail -1
