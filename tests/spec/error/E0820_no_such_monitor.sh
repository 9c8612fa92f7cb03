cat > t.etl <<'END'
spec t;
input x : f32;
monitor always_low = G x < 1;
monitor once_high = F x > 2;
END
printf 'x\n0\n' > t.csv
"$ETLC" explain t.etl --trace t.csv --monitor always_lo
"$ETLC" explain t.etl --trace t.csv --monitor near -o why.txt
echo "exit status $?"
ls
