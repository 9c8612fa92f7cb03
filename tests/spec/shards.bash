# Makes two shards of a call over four episodes, as 1.part and 2.part.
cat > t.etl <<'SPEC'
spec t;
input x : f32;
predicate near = x <= calibrated(conformal, alpha = 0.5);
truth near = x <= 0.5;
monitor m = F near;
SPEC
for number in 1 2 3 4; do printf 'x\n0.%s\n1.%s\n' $number $number > $number.csv; done
shards() { # OPTION...
    for shard in 1 2; do
        "$ETLC" calibrate t.etl --data 1.csv 2.csv 3.csv 4.csv --shard $shard/2 \
            --part $shard.part "$@"
    done
}
shards
