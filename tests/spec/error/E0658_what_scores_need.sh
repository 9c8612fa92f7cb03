# A score needs the exact distance at every step, and episodes that are not in groups.
cat > t.etl <<'END'
spec t;
input z : f32[2];
target seen = [[0.1, 0.7]];
predicate usual = l2(z, seen) <= calibrated(normal, alpha = 0.2);
monitor ok = G usual;
drift moved = of usual, level = 0.01;
END
mkdir known
for e in 1 2 3 4 5 6 7 8; do printf 'z[0],z[1]\n0.%d,0\n' $e > known/$e.csv; done
"$ETLC" calibrate t.etl --data known > report.txt
"$ETLC" t.etl --check && echo accepted
"$ETLC" t.etl --values boolean -o t.hpp
"$ETLC" t.etl --targets-as f16 -o t.hpp
"$ETLC" t.etl --retargetable -o t.hpp
"$ETLC" prove t.etl
(echo episode,outcome,group
for e in 1 2 3 4 5 6 7 8; do echo $e.csv,success,day$e; done) > known/labels.csv
"$ETLC" calibrate t.etl --data known > report.txt
"$ETLC" t.etl --check
sed -i 's/"measured": \[[^,]*, /"measured": [/' t.thresholds.json
"$ETLC" t.etl --check
