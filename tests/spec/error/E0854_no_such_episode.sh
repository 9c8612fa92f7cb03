# A missing episode, and one that contradicts its metadata.
. "$SPECS/../dataset.bash"
"$ETLC" run rows.etl --trace set:3 --map push=action[0]
sed -i 's/"length": 3/"length": 4/' set/meta/episodes.jsonl
"$ETLC" run rows.etl --trace set:0 --map push=action[0]
