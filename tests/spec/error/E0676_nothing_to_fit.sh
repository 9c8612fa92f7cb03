# Only fitted(...) declarations are fitted.
cat > t.etl <<'SPEC'
spec t;
input x : f32;
predicate p = x <= 1;
monitor m = F p;
SPEC
printf 'x\n1\n' > episode.csv
"$ETLC" fit t.etl --data episode.csv
