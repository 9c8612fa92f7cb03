# Frames that are targets are easier to classify than others.
cat > t.etl <<'END'
spec t;
input z : f32[2];
input px : f32;
target home = [[1, 0], [3, 4]];
predicate near = min l2(z, home) <= 0.5;
truth near = px < 1;
monitor m = F near;
END
printf 'z[0],z[1],px\n3,3.5,0\n3,4,0\n' > a.csv
printf 'z[0],z[1],px\n3,3.25,0\n3,4.5,2\n' > b.csv
printf 'z[0],z[1],px\n1,0,0\n3,4.5,2\n' > c.csv
# Not directly into head: a closed pipe ends the call before its files appear.
"$ETLC" evaluate t.etl --data a.csv b.csv c.csv --json figures.json > report.txt
head -2 report.txt
grep leaked figures.json
"$ETLC" evaluate t.etl --data b.csv | head -2
