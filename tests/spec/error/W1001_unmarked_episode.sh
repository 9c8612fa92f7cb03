# Episodes that do not say which encoder made their embeddings: each command says so, once a call.
. "$SPECS/../encoding.bash"
cat > u.etl << 'END'
spec u;
rate 10 Hz;
encoder net = load("net.onnx"), image [1, 1];
input z : f32[2] by net;
target bay = images("bay/*.png") by net;
predicate near = min l2(z, bay) <= calibrated(conformal, alpha = 0.5);
monitor m = F near;
END
echo > ep.mp4
mv u.etl t.etl
embeds_each --data ep.mp4 -o out > /dev/null
for n in 1 2 3; do printf 'z[0],z[1],truth.near\n1,2,True\n%d,%d,True\n' "$n" "$n"; done |
    split -l 3 --numeric-suffixes=1 --suffix-length=1 --additional-suffix=.csv - ep
"$ETLC" calibrate t.etl --data ep1.csv ep2.csv ep3.csv -o t.thresholds.json > /dev/null
"$ETLC" run t.etl --trace ep1.csv -o rows.csv
"$ETLC" run t.etl --trace - -o rows.csv < ep1.csv
"$ETLC" run t.etl --trace out/ep.npz -o rows.csv
"$ETLC" explain t.etl --trace ep1.csv -o why.txt
printf 'z[0],z[1],truth.near\n4,4,True\n' > ep4.csv
"$ETLC" evaluate t.etl --data ep4.csv > /dev/null
"$ETLC" report t.etl --data ep4.csv -o page.html
"$ETLC" report t.etl --data ep1.csv ep4.csv --no-truths -o page.html
"$ETLC" crossvalidate t.etl --data ep?.csv --folds 2 > /dev/null
"$ETLC" calibrate t.etl --data ep1.csv ep2.csv -o none.json -Werror > /dev/null
ls none.json
# A frame of one as a target, too.
sed 's|^target.*|target bay = frames("ep4.csv", "z", [0]);|' t.etl > f.etl
mv t.embedded.npz f.embedded.npz
mv t.thresholds.json f.thresholds.json
"$ETLC" f.etl --check
