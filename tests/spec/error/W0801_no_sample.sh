# A trace in which an input is always missing, or always out of range.
cat > t.etl <<END
spec t;
input x, y : f32 in [0, 1];
monitor m = F x > 0.5;
monitor n = F y > 0.5;
END
printf 'x,y\n,2\n,3\n' > t.csv
"$ETLC" run t.etl --trace t.csv
"$ETLC" run t.etl --trace t.csv --summary
