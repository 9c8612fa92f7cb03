# A thresholds file that is named and cannot be read.
cat > t.etl <<'END'
spec t;
input z : f32[1];
target goal = [[1]];
predicate near = l2(z, goal) <= calibrated(f1);
monitor m = F near;
END
"$ETLC" t.etl -o t.hpp --thresholds no_such.json
"$ETLC" t.etl --check --thresholds .
truncate -s 4294967297 large.json
"$ETLC" t.etl --check --thresholds large.json
