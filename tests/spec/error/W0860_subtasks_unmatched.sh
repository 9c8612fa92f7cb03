# Labels by subtasks: one that no predicate is named after, and a predicate without a subtask.
. "$SPECS/../dataset.bash"
sed -i 's/"features": {/&"language_persistent": {"dtype": "language", "shape": [1]},/' \
  set/meta/info.json
cp "$SPECS/W0860_rows.parquet" set/data/chunk-000/episode_000000.parquet
cat > task.etl << 'ETL'
spec task;
input push : f32;
predicate reach = push < 0.6;
predicate rests = push < 1;
monitor m = F (reach && rests);
ETL
"$ETLC" evaluate task.etl --data set --map push=action --label-by subtask > report
sed -i 's/reach/touch/g' task.etl
"$ETLC" evaluate task.etl --data set --map push=action --label-by subtask
