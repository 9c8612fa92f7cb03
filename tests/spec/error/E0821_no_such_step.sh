# The step must have a verdict.
cat > t.etl <<'END'
spec t;
rate 10 Hz;
input x : f32;
sliding monitor soon = F[0 s, 0.2 s] x < 1;
END
printf 'x\n0\n0\n0\n' > t.csv
"$ETLC" explain t.etl --trace t.csv --step 5
# After the trace a sliding monitor still reports its last positions.
"$ETLC" explain t.etl --trace t.csv --step 4
"$ETLC" explain t.etl --trace t.csv --at 1e30
"$ETLC" explain t.etl --trace t.csv --at 0.1
printf 'x\n0\n0\n' > short.csv
"$ETLC" explain t.etl --trace short.csv
printf 'x\n' > empty.csv
"$ETLC" explain t.etl --trace empty.csv
echo "exit status $?"
