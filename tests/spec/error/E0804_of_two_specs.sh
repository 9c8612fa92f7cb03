# Episodes must serve every spec: the message names the spec that they do not serve.
cat > a.etl <<'END'
spec a;
input x : f32;
predicate p = x < 1;
truth p = x < 0.5;
monitor m = F p;
END
sed 's/\bx\b/y/' a.etl > b.etl
printf 'x\n0\n1\n' > 1.csv
"$ETLC" evaluate a.etl b.etl --data 1.csv
"$ETLC" evaluate a.etl b.etl --data 1.csv --map w=x
"$ETLC" evaluate a.etl b.etl --data 1.csv --map y=x | grep -A 1 less
"$ETLC" evaluate a.etl ./a.etl a.etl --data 1.csv
"$ETLC" evaluate a.etl b.etl --data 1.csv --thresholds t.json
