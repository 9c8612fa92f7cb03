# Episodes that do not record the encoder of their embeddings: each command warns once per call.
. "$SPECS/../encoding.bash"
sed -i '/^monitor/d' t.etl
cat >> t.etl << 'END'
predicate near = min l2(z, bay) <= calibrated(conformal, alpha = 0.5);
monitor m = F near;
END
echo > ep.mp4
embeds_each --data ep.mp4 -o out > /dev/null
for n in 1 2 3 4 5 6 7 8; do
    printf 'z[0],z[1],truth.near\n%d,0.5,True\n0.25,-%d,False\n' $n $n > ep$n.csv
done
"$ETLC" calibrate t.etl --data ep[1-4].csv > /dev/null
"$ETLC" run t.etl --trace ep5.csv -o rows.csv
"$ETLC" run t.etl --trace - -o rows.csv < ep5.csv
"$ETLC" run t.etl --trace out/ep.npz -o rows.csv
"$ETLC" explain t.etl --trace ep5.csv -o why.txt
"$ETLC" evaluate t.etl --data ep[5-8].csv > /dev/null
"$ETLC" report t.etl --data ep[5-8].csv -o page.html
"$ETLC" report t.etl --data ep[5-8].csv out/ep.npz --no-truths -o page.html
"$ETLC" crossvalidate t.etl --data ep?.csv --folds 2 > /dev/null
"$ETLC" calibrate t.etl --data ep[1-4].csv -o none.json -Werror > /dev/null
[ ! -e none.json ] || echo "it was made"
# A frame of such an episode as a target, too.
sed 's|^target.*|target bay = frames("ep1.csv", "z", [0]);|; s/calibrated.*;/1;/' t.etl > f.etl
mv t.embedded.npz f.embedded.npz
"$ETLC" f.etl --check
# Also if it matches.
cat > p.etl << 'END'
spec p;
encoder net = load("net.onnx"), image [1, 1];
input z : f32[2] by net;
projection P = fitted(discriminant, r = 1, of = z, where = near);
target none = [[9, 9]];
predicate near = l2(P(z), none) <= 1;
monitor m = F near;
END
mv f.embedded.npz p.embedded.npz
"$ETLC" fit p.etl --data ep?.csv > /dev/null
