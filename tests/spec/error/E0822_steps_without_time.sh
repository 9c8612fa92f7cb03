printf 'spec t;\ninput x : f32;\nmonitor m = G x < 1;\n' > t.etl
printf 'x\n0\n' > t.csv
"$ETLC" explain t.etl --trace t.csv --at 0
echo "exit status $?"
