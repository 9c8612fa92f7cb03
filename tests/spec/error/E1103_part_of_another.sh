# Parts of two calls, with other shards, with other episodes; and a spec that has changed since.
. "$SPECS/../shards.bash"
cp 2.part 2.first
shards --folds 2 > /dev/null
"$ETLC" merge 1.part 2.first -o out.json
"$ETLC" calibrate t.etl --data 1.csv 2.csv 3.csv 4.csv --shard 2/3 --part 2.of_3 > /dev/null
cp 2.first 2.part
shards > /dev/null
"$ETLC" merge 1.part 2.of_3 -o out.json
cp 1.part 1.first
mkdir others
cp ./*.csv others
"$ETLC" calibrate t.etl --data others --shard 1/2 --part 1.others > /dev/null
"$ETLC" merge 1.others 2.part -o out.json
echo '// another line' >> t.etl
"$ETLC" merge 1.part 2.part -o out.json
ls out.json
