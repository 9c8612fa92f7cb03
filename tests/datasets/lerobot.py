"""Writes data sets in LeRobot's format for tests: `write(folder, release, lengths)`. Cameras are
videos; `stored` has the images of cameras kept in the rows: for each camera, a file's bytes each.
`more` has other columns of the rows, `of_episodes` of meta/episodes, each (type, values).
"""
import json
import os
import subprocess

import numpy as np

import parquet_writer as parquet

FPS, STATE, ACTION, SIDES = 10, 4, 2, (48, 64)
CAMERAS = ("observation.images.top", "observation.images.wrist")
TASKS = ("pick the cube", "place it in the bin")
PATHS = {
    "v2.1": ("data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet",
             "videos/chunk-{episode_chunk:03d}/{video_key}/episode_{episode_index:06d}.mp4"),
    "v3.0": ("data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
             "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4")}


def call(*words):
    done = subprocess.run(words, capture_output=True)
    assert done.returncode == 0, (words, done.stderr)
    return done.stdout


def video(path, frames, seed):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    made = (f"testsrc2=size={SIDES[1]}x{SIDES[0]}:rate={FPS},hue=h={40 * seed},"
            f"trim=end_frame={frames}")
    call("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", made, "-pix_fmt", "yuv420p", "-c:v",
         "libx264", "-preset", "ultrafast", "-g", "5", path)


def raw_frames(path):
    """Returns the frames as ffmpeg decodes them."""
    raw = call("ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-")
    return np.frombuffer(raw, np.uint8).reshape(-1, *SIDES, 3)


def rows_of(lengths, stored=None, states=None):
    """Returns the columns of all episodes, and states, actions and labels as arrays by episode."""
    random = np.random.default_rng(5)
    columns = {"observation.state": (parquet.FLOAT, []), "action": (parquet.FLOAT, []),
               "next.success": (parquet.BOOL, []), "note": (parquet.TEXT, []),
               "timestamp": (parquet.FLOAT, []), "frame_index": (parquet.INT64, []),
               "episode_index": (parquet.INT64, []), "index": (parquet.INT64, []),
               "task_index": (parquet.INT64, [])}
    truth = []
    for episode, length in enumerate(lengths):
        state = random.normal(size=(length, STATE)).astype(np.float32)
        if states is not None:
            state = states[episode]
        action = random.integers(-3, 4, (length, ACTION)).astype(np.float32) / 4
        success = np.arange(length) >= length - 3
        truth.append((state, action, success))
        for step in range(length):
            row = {"observation.state": [float(x) for x in state[step]],
                   "action": [float(x) for x in action[step]],
                   "next.success": bool(success[step]), "note": f"step {step % 3}",
                   "timestamp": float(np.float32(step / FPS)), "frame_index": step,
                   "episode_index": episode, "index": len(columns["index"][1]),
                   "task_index": episode % len(TASKS)}
            for name, value in row.items():
                columns[name][1].append(value)
    kind = parquet.Struct({"bytes": parquet.TEXT, "path": parquet.TEXT})
    for camera, images in (stored or {}).items():
        columns[camera] = (kind, [{"bytes": image, "path": f"frame-{i:06}"}
                                  for i, image in enumerate(images)])
    return columns, truth


def info_of(version, lengths, stored=(), more=()):
    features = {"observation.state": {"dtype": "float32", "shape": [STATE]},
                "action": {"dtype": "float32", "shape": [ACTION]},
                "next.success": {"dtype": "bool", "shape": [1]},
                "note": {"dtype": "string", "shape": [1]},
                "timestamp": {"dtype": "float32", "shape": [1]}}
    for name in ("frame_index", "episode_index", "index", "task_index"):
        features[name] = {"dtype": "int64", "shape": [1]}
    for camera in CAMERAS:
        features[camera] = {"dtype": "image" if camera in stored else "video",
                            "shape": [*SIDES, 3]}
    for name in more:
        features[name] = {"dtype": "float32", "shape": [1], "names": None}
    rows, videos = PATHS[version]
    if len(stored) == len(CAMERAS):
        videos = None
    return {"codebase_version": version, "robot_type": "test", "total_episodes": len(lengths),
            "total_frames": sum(lengths), "total_tasks": len(TASKS), "chunks_size": 1000,
            "fps": FPS, "splits": {"train": f"0:{len(lengths)}"}, "data_path": rows,
            "video_path": videos, "features": features}


def write_json(path, value):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(value, file, indent=4)


def write_21(folder, lengths, columns, how):
    with open(f"{folder}/meta/episodes.jsonl", "w", encoding="utf-8") as file:
        for episode, length in enumerate(lengths):
            file.write(json.dumps({"episode_index": episode, "length": length,
                                   "tasks": [TASKS[episode % len(TASKS)]]}) + "\n")
    with open(f"{folder}/meta/tasks.jsonl", "w", encoding="utf-8") as file:
        for number, task in enumerate(TASKS):
            file.write(json.dumps({"task_index": number, "task": task}) + "\n")
    os.makedirs(f"{folder}/data/chunk-000")
    first = 0
    for episode, length in enumerate(lengths):
        own = {name: (kind, values[first:first + length])
               for name, (kind, values) in columns.items()}
        parquet.write(f"{folder}/data/chunk-000/episode_{episode:06}.parquet", own, **how)
        first += length
        for number, camera in enumerate(CAMERAS):
            if camera not in columns:
                video(f"{folder}/videos/chunk-000/{camera}/episode_{episode:06}.mp4", length,
                      2 * episode + number)


def episode_table(lengths, stored=()):
    """Writes two files of rows, the second with the last episode, and one video for all."""
    begins = [sum(lengths[:i]) for i in range(len(lengths))]
    files = [int(i == len(lengths) - 1) for i in range(len(lengths))]
    zeros = [0] * len(lengths)
    table = {"episode_index": (parquet.INT64, list(range(len(lengths)))),
             "tasks": (parquet.TEXT, [[TASKS[i % len(TASKS)]] for i in range(len(lengths))]),
             "length": (parquet.INT64, list(lengths)), "data/chunk_index": (parquet.INT64, zeros),
             "data/file_index": (parquet.INT64, files),
             "stats/action/mean": (parquet.DOUBLE, [[0.5]] * len(lengths))}
    for camera in CAMERAS:
        if camera in stored:
            continue
        ends = [begin + length for begin, length in zip(begins, lengths)]
        table[f"videos/{camera}/chunk_index"] = (parquet.INT64, zeros)
        table[f"videos/{camera}/file_index"] = (parquet.INT64, zeros)
        table[f"videos/{camera}/from_timestamp"] = (parquet.DOUBLE, [x / FPS for x in begins])
        table[f"videos/{camera}/to_timestamp"] = (parquet.DOUBLE, [x / FPS for x in ends])
    return table


def write_30(folder, lengths, columns, how, of_episodes):
    os.makedirs(f"{folder}/meta/episodes/chunk-000")
    os.makedirs(f"{folder}/data/chunk-000")
    parquet.write(f"{folder}/meta/episodes/chunk-000/file-000.parquet",
                  episode_table(lengths, columns) | of_episodes,
                  nested=("stats/action/mean",), **how)
    parquet.write(f"{folder}/meta/tasks.parquet",
                  {"task_index": (parquet.INT64, [0, 1]),
                   "__index_level_0__": (parquet.TEXT, list(TASKS))}, **how)
    begin = sum(lengths[:-1])
    for file, part in enumerate((slice(0, begin), slice(begin, None))):
        own = {name: (kind, values[part]) for name, (kind, values) in columns.items()}
        parquet.write(f"{folder}/data/chunk-000/file-{file:03}.parquet", own, group_rows=lengths[0],
                      **how)
    for number, camera in enumerate(CAMERAS):
        if camera not in columns:
            video(f"{folder}/videos/{camera}/chunk-000/file-000.mp4", sum(lengths), number)


def write(folder, release, lengths, stored=None, more=None, of_episodes=None, without=(),
          states=None, **how):
    """Returns the states, actions and labels of each episode. `without`: features left out;
    `states`: of the episodes, in place of random ones."""
    os.makedirs(f"{folder}/meta")
    columns, truth = rows_of(lengths, stored, states)
    columns |= more or {}
    info = info_of(release, lengths, stored or (), more or ())
    for name in without:
        columns.pop(name)
        info["features"].pop(name)
    write_json(f"{folder}/meta/info.json", info)
    if release == "v2.1":
        write_21(folder, lengths, columns, how)
    else:
        write_30(folder, lengths, columns, how, of_episodes or {})
    return truth


def frames_of(folder, version, lengths, episode, camera):
    if version == "v2.1":
        return raw_frames(f"{folder}/videos/chunk-000/{camera}/episode_{episode:06}.mp4")
    begin = sum(lengths[:episode])
    return raw_frames(f"{folder}/videos/{camera}/chunk-000/file-000.mp4")[
        begin:begin + lengths[episode]]
