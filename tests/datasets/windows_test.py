#!/usr/bin/env python3
"""windows_test.py ETLC: data sets whose episodes share videos, with correct windows, and with
windows that overlap, leave gaps, are shifted, out of order or beyond the end. Every frame belongs
to its episode, whichever episode is read; correct sets are accepted completely."""
import os
import random
import shutil
import subprocess
import sys
import tempfile

import numpy as np

from encoders import FIRST_PIXEL
import lerobot
import parquet_writer as parquet

ETLC = os.path.abspath(sys.argv[1])
TOP, FPS, SIDE, STEP = lerobot.CAMERAS[0], lerobot.FPS, 16, 4
SPEC = """spec grey;
rate 10 Hz;
encoder see = load("see.py");
input z : f32[1] by see;
target none = [[0]];
monitor m = F l2(z, none) <= 1;
"""


class Window:
    """The window of an episode in a video, in frames."""

    def __init__(self, episode, file, begin, end):
        self.episode, self.file, self.begin, self.end = episode, file, begin, end


def grey_video(path, frames):
    """Frames whose grey level is STEP times their number."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    raw = b"".join(bytes([STEP * frame]) * (SIDE * SIDE) for frame in frames)
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "gray", "-s",
                    f"{SIDE}x{SIDE}", "-r", str(FPS), "-i", "-", "-c:v", "libx264", "-preset",
                    "ultrafast", "-qp", "0", "-pix_fmt", "yuv444p", path], input=raw, check=True)


def write_rows(lengths):
    steps = [step for length in lengths for step in range(length)]
    episodes = [e for e, length in enumerate(lengths) for _ in range(length)]
    columns = {"timestamp": (parquet.FLOAT, [step / FPS for step in steps]),
               "frame_index": (parquet.INT64, steps), "episode_index": (parquet.INT64, episodes),
               "index": (parquet.INT64, list(range(len(steps)))),
               "task_index": (parquet.INT64, [0] * len(steps))}
    os.makedirs("set/data/chunk-000")
    parquet.write("set/data/chunk-000/file-000.parquet", columns)


def write_metadata(lengths, windows, noise):
    features = {name: {"dtype": "int64", "shape": [1]}
                for name in ("frame_index", "episode_index", "index", "task_index")}
    features |= {"timestamp": {"dtype": "float32", "shape": [1]},
                 TOP: {"dtype": "video", "shape": [SIDE, SIDE, 3]}}
    rows, videos = lerobot.PATHS["v3.0"]
    os.makedirs("set/meta/episodes/chunk-000")
    lerobot.write_json("set/meta/info.json", {
        "codebase_version": "v3.0", "total_episodes": len(lengths), "total_frames": sum(lengths),
        "total_tasks": 1, "chunks_size": 1000, "fps": FPS, "data_path": rows, "video_path": videos,
        "features": features})
    parquet.write("set/meta/tasks.parquet", {"task_index": (parquet.INT64, [0]),
                                             "__index_level_0__": (parquet.TEXT, ["look"])})
    zeros = [0] * len(lengths)

    def seconds(frames):
        return [frame / FPS + noise * random.uniform(-1, 1) if frame else 0.0 for frame in frames]

    parquet.write("set/meta/episodes/chunk-000/file-000.parquet", {
        "episode_index": (parquet.INT64, list(range(len(lengths)))),
        "tasks": (parquet.TEXT, [["look"]] * len(lengths)),
        "length": (parquet.INT64, lengths), "data/chunk_index": (parquet.INT64, zeros),
        "data/file_index": (parquet.INT64, zeros),
        f"videos/{TOP}/chunk_index": (parquet.INT64, zeros),
        f"videos/{TOP}/file_index": (parquet.INT64, [w.file for w in windows]),
        f"videos/{TOP}/from_timestamp": (parquet.DOUBLE, seconds([w.begin for w in windows])),
        f"videos/{TOP}/to_timestamp": (parquet.DOUBLE, seconds([w.end for w in windows]))})


def honest(lengths):
    """Puts episodes into random videos, in the order of their numbers; returns what the videos
    show: frames are numbered through the data set."""
    windows, shown = [], {}
    for episode, length in enumerate(lengths):
        file = random.randrange(2)
        frames = shown.setdefault(file, [])
        windows.append(Window(episode, file, len(frames), len(frames) + length))
        first = sum(lengths[:episode])
        frames += range(first, first + length)
    return windows, shown


def together(lengths):
    """The same in one video."""
    windows, shown = [], {0: list(range(sum(lengths)))}
    for episode, length in enumerate(lengths):
        first = sum(lengths[:episode])
        windows.append(Window(episode, 0, first, first + length))
    return windows, shown


def move(windows, by):
    for window in windows:
        window.begin += by
        window.end += by


def swap(one, other):
    length, begin = other.end - other.begin, one.begin
    one.begin, one.end = other.end - (one.end - one.begin), other.end
    other.begin, other.end = begin, begin + length


# Mistakes of a writer with four episodes in a video: changes of the windows or of the frames. Then
# none of the four can be located; but if one begins between two frames, the others are correct.
BETWEEN = "half a frame late"
WRONG = {
    "one late": lambda w, shown: move(w[2:3], 1),
    "one early": lambda w, shown: move(w[1:2], -1),
    "far too early": lambda w, shown: move(w[3:], -5),
    "all behind late": lambda w, shown: move(w[1:], 2),
    "all late": lambda w, shown: move(w, 1),
    "all late, and the video longer": lambda w, shown: (move(w, 2), shown[0].extend([58, 59])),
    "those behind late, and the video longer":
        lambda w, shown: (move(w[2:], 1), shown[0].append(59)),
    "those behind late, and the one before longer":
        lambda w, shown: (move(w[2:], 1), setattr(w[1], "end", w[2].begin), shown[0].append(59)),
    "all the same": lambda w, shown: [move([x], -x.begin) for x in w],
    "swapped": lambda w, shown: swap(w[1], w[2]),
    "a frame more in the video": lambda w, shown: shown[0].insert(7, 59),
    "a frame fewer in the video": lambda w, shown: shown[0].pop(7),
    "no frame of the last": lambda w, shown: shown[0].__delitem__(slice(w[3].begin, None)),
    BETWEEN: lambda w, shown: move(w[2:3], 0.5)}


def embed(data):
    shutil.rmtree("out", ignore_errors=True)
    done = subprocess.run([ETLC, "embed", "grey.etl", "--data", data, "-o", "out", "--encoder-cmd",
                           f"{sys.executable} -IS see.py"], capture_output=True, text=True)
    assert done.returncode in (0, 1), done
    made = {}
    for name in os.listdir("out") if done.returncode == 0 else ():
        levels = np.load(f"out/{name}")["z"][:, 0]
        made[int(name[-10:-4])] = np.round(levels / STEP).astype(int).tolist()
    return made, done.stderr


def check(what, lengths, windows, shown, noise=0.0):
    shutil.rmtree("set", ignore_errors=True)
    write_rows(lengths)
    write_metadata(lengths, windows, noise)
    for file, frames in shown.items():
        grey_video(f"set/videos/{TOP}/chunk-000/file-{file:03}.mp4", frames)
    own = {e: list(range(sum(lengths[:e]), sum(lengths[:e + 1]))) for e in range(len(lengths))}
    one = random.randrange(len(lengths))
    for data, asked in (("set", own), (f"set:{one}", {one: own[one]})):
        made, said = embed(data)
        for episode, frames in made.items():
            assert frames == own[episode], (what, data, lengths, episode, frames, said)
        if what == "honest":
            assert made == asked and said == "", (what, data, lengths, made, said)
        elif what != BETWEEN:
            assert not made and "[W0850]" in said or "[E1011]" in said, (what, data, made, said)
        else:
            assert made.keys() == asked.keys() - {2}, (what, data, made, said)


def main():
    for name, text in (("see.py", FIRST_PIXEL), ("grey.etl", SPEC)):
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
    for turn in range(6):
        random.seed(turn)
        lengths = [random.randint(3, 8) for _ in range(random.randint(2, 7))]
        check("honest", lengths, *honest(lengths), noise=random.choice((0, 1e-9, 1e-3)))
    for turn, (what, spoil) in enumerate(WRONG.items()):
        random.seed(turn)
        lengths = [6] * 4 if turn % 2 else [random.randint(4, 9) for _ in range(4)]
        windows, shown = together(lengths)
        spoil(windows, shown)
        check(what, lengths, windows, shown)


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
    os.chdir("/")
