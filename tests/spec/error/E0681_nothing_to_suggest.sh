# Suggestions need predicates that have labels and measure from one point.
cat > t.etl <<'SPEC'
spec t;
input z : f32[2];
input x : f32;
predicate near = l2(z, goal) <= 1;
predicate slow = x <= 1;
target goal = [[0, 1]];
truth slow = x <= 2;
monitor m = F (near && slow);
SPEC
printf 'z[0],z[1],x\n1,2,3\n' > episode.csv
"$ETLC" fit t.etl --suggest naer near slow --data episode.csv
"$ETLC" fit t.etl --suggest --data episode.csv
sed 's/= F/= G/' t.etl > u.etl
"$ETLC" fit u.etl --suggest --data episode.csv
