# A monitor that is calibrated as a whole, with frames of the demonstrations as targets: it would
# miss nothing in these, and everything in others.
cat > leak.etl <<'END'
spec leak;
input z : f16[2];
target t = [[0.123456, 0.654321], [0.7, 0.8]];    // the first is recorded in a.csv, as float32
predicate a = min l2(z, t) <= 0.3;
monitor m = F a calibrated(conformal, alpha = 0.5, against = missed_success);
END
printf 'z[0],z[1],truth.a\n0.4,0.3,0\n0.123456,0.654321,1\n' > a.csv
printf 'z[0],z[1],truth.a\n0.2,0.6,1\n0.7,0.75,1\n' > b.csv
"$ETLC" calibrate leak.etl --data a.csv b.csv
echo "exit status $?"
printf 'spec leak;\ninput x, y : f32;\ntarget t = load("t.npy");\n' > leak.etl
echo 'predicate a = min l2([x, y], t) <= 0.3;' >> leak.etl
printf 'monitor m = F a calibrated(conformal, alpha = 0.5, against = missed_success);\n' >> leak.etl
printf '\223NUMPY\001\000\166\000%-117s\n\000\000\000\077\000\000\200\076' \
    "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }" > t.npy
printf 'x,y,truth.a\n0.5,0.25,1\n' > a.csv
printf 'x,y,truth.a\n0.5,0.5,1\n' > b.csv
"$ETLC" calibrate leak.etl --data a.csv b.csv
echo "exit status $?"
sed -i 's/load("t.npy")/[[0.5, 0.25]]/' leak.etl
"$ETLC" calibrate leak.etl --data a.csv b.csv
