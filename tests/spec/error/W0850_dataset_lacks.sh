# Metadata that contradict each other, and an episode without its video.
. "$SPECS/../dataset.bash"
sed -i 's/"total_episodes": 1/"total_episodes": 2/' set/meta/info.json
echo '{"episode_index": 1, "tasks": [], "length": 5}' >> set/meta/episodes.jsonl
"$ETLC" embed rows.etl --data set -o out --map push=action[0] > report
