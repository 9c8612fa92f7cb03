# Neither a truth in the spec, nor labels in the episodes, nor a monitor that is its own truth.
cat > t.etl <<'END'
spec t;
input z : f32[2];
target home = [[1, 0]];
predicate near = l2(z, home) <= 0.5;
monitor m = F near;
END
printf 'z[0],z[1],near\n1,1,0\n1,0.25,1\n' > a.csv
"$ETLC" evaluate t.etl --data a.csv
echo "exit status $?"
"$ETLC" evaluate t.etl --data a.csv --map truth.near=near | head -1
