# A missing shard, a repeated one, and episodes that differ between shards.
. "$SPECS/../shards.bash"
"$ETLC" merge 1.part -o out.json
"$ETLC" merge 2.part 1.part 2.part -o out.json
printf 'x\n0.25\n7\n' > 1.csv
for number in 1 2 3 4; do printf 'x\n0.%s\n7.%s\n' $number $number > $number.csv; done
"$ETLC" calibrate t.etl --data 1.csv 2.csv 3.csv 4.csv --shard 2/2 --part 2.part
"$ETLC" merge 1.part 2.part -o out.json
ls out.json
