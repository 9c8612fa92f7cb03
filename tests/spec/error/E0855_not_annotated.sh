# Annotations that a data set or a spec cannot have.
. "$SPECS/../dataset.bash"
"$ETLC" annotate rows.etl --data set -o out --progress m --map push=action[0]
sed -i 's/F (push > 1)/G (push > 1)/' rows.etl
"$ETLC" annotate rows.etl --data set -o out --progress m --map push=action[0]
"$ETLC" annotate rows.etl --data set -o out --subtasks push --map push=action[0]
sed -i 's/"wrist": {"dtype": "video"/"next.success": {"dtype": "bool"/' set/meta/info.json
"$ETLC" annotate rows.etl --data set -o out --success m --map push=action[0]
"$ETLC" annotate rows.etl --data set:0 -o out --success m --map push=action[0]
ls
