# A number that was changed by hand contradicts the others, whichever number it is.
cat > t.etl <<'END'
spec t;
input x, px : f32;
predicate near = x <= calibrated(conformal, alpha = 0.25);
truth near = px < 1;
monitor reaches = F near;
monitor stays = G near calibrated(conformal, alpha = 0.25, against = missed_success);
END
for e in 1 2 3 4 5 6 7 8; do printf 'x,px\n0.%d,0\n0.9,2\n0.%d,0\n' $e $((9 - e)) > $e.csv; done
for e in 5 6 7 8; do printf 'x,px\n0.%d,0\n0.3,0\n' $e > $e.csv; done
"$ETLC" calibrate t.etl --data [1-4].csv -o predicates.json > report.txt
"$ETLC" calibrate t.etl --data [5-8].csv --thresholds predicates.json -o good.json > report.txt
"$ETLC" t.etl --check --thresholds good.json && echo believed
change() { sed "$1" good.json > bad.json; "$ETLC" t.etl --check --thresholds bad.json; }
change '8s/0.8000001/0.75/'
change '9s/4/5/'
change '10s/4/1/'
change '11s/0.5,/0.65,/'
change '25s/5.960464e-08/-0.5/'
change '27s/4/3/'
change '28s/0.10000008344650269/0/'
first=$(sed -n 's/^    "\([0-9a-f]*\)".*/\1/p' good.json | head -1)
second=$(sed -n 's/^    "\([0-9a-f]*\)".*/\1/p' good.json | sed -n 2p)
change "/{\$/! s/$second/$first/"
