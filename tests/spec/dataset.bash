# Shared by cases of data sets: `set`, of version 2.1, with an episode of three rows and the videos
# of two cameras, which no case decodes; and specs for its rows and for a camera. Source it in an
# empty folder.
mkdir -p set/meta set/data/chunk-000 set/videos/{top,wrist}
cat > set/meta/info.json << 'JSON'
{"codebase_version": "v2.1", "total_episodes": 1, "total_frames": 3, "chunks_size": 1000, "fps": 10,
 "data_path": "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet",
 "video_path": "videos/{video_key}/episode_{episode_index:06d}.mp4",
 "features": {"action": {"dtype": "float32", "shape": [2]},
              "timestamp": {"dtype": "float32", "shape": [1]},
              "top": {"dtype": "video", "shape": [1, 1, 3]},
              "wrist": {"dtype": "video", "shape": [1, 1, 3]}}}
JSON
echo '{"episode_index": 0, "tasks": ["push"], "length": 3}' > set/meta/episodes.jsonl
echo '{"task_index": 0, "task": "push"}' > set/meta/tasks.jsonl
cp "$SPECS/E0850_rows.parquet" set/data/chunk-000/episode_000000.parquet
touch set/videos/{top,wrist}/episode_000000.mp4
cat > rows.etl << 'ETL'
spec rows;
rate 10 Hz;
input push : f32;
monitor m = F (push > 1);
ETL
cat > seen.etl << 'ETL'
spec seen;
encoder net = load("net.onnx"), image [1, 1];
input z : f32[2] by net;
target goal = [[1, 2]];
monitor m = F l2(z, goal) <= 1;
ETL
echo model > net.onnx
