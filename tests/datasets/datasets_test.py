#!/usr/bin/env python3
"""datasets_test.py ETLC: data sets of both versions give the states, actions and labels that were
written and the frames that ffmpeg decodes, as episodes of `etlc embed` and when read directly."""
import os
import subprocess
import sys
import tempfile

import numpy as np

from encoders import CHECKSUMS, checksums
import lerobot
import parquet_writer as parquet

ETLC = os.path.abspath(sys.argv[1])
LENGTHS = (20, 15, 12)
TOP, WRIST = lerobot.CAMERAS

INPUTS = """
input q : f32[4];
input grip : f32;
input done : bool;
target home = [[0, 0, 0, 0]];
predicate near = l2(q, home) <= 2;
monitor lift = F (near && grip > 0.2 && done);
"""
SEEN = """spec pick;
rate {rate} Hz;
encoder see = load("see.py");
input z : f32[2] by see;
target none = [[0, 0]];
{more}""" + INPUTS + "monitor seen = F l2(z, none) <= 1;\n"
CALIBRATED = """spec lift;
input q : f32[4];
input grip : f32;
input done : bool;
target home = [[0, 0, 0, 0]];
predicate near = l2(q, home) <= calibrated(conformal, alpha = 0.5);
truth near = done && grip <= 1;
monitor lifted = F near;
"""
MAP = ["--map", "q=observation.state", "grip=action[1]", "done=next.success"]


def call(*words, status=0):
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def embed(*words, status=0):
    return call(ETLC, "embed", *words, "--encoder-cmd", f"{sys.executable} see.py", *MAP,
                status=status)


def check_columns(folder, truth, name, stride=1):
    for episode, (state, action, success) in enumerate(truth):
        made = np.load(f"{folder}/{name}-{episode:06}.npz")
        assert np.array_equal(made["q"], state[::stride]), (name, episode)
        assert np.array_equal(made["grip"], action[::stride, 1]), (name, episode)
        assert np.array_equal(made["done"], success[::stride]), (name, episode)


def check_version(release, **how):
    name = f"set{release[1]}"
    truth = lerobot.write(name, release, LENGTHS, **how)
    said = embed("see.etl", "--data", name, "--camera", TOP, "-o", f"{name}.out")
    assert "task 'pick the cube': 2 episodes" in said and "3 episodes in" in said, said
    check_columns(f"{name}.out", truth, name)
    for episode in range(len(LENGTHS)):
        frames = lerobot.frames_of(name, release, LENGTHS, episode, TOP)
        made = np.load(f"{name}.out/{name}-{episode:06}.npz")
        assert np.array_equal(made["z"], checksums(frames)), (release, episode)
    for camera, kept in ((TOP, f"out, {len(LENGTHS)} with embeddings of an earlier call\n"),
                         (WRIST, "out\n")):
        again = embed("see.etl", "--data", name, "--camera", camera, "-o", f"{name}.out")
        assert again.endswith(kept), again

    # Every second row and frame at half the rate.
    embed("slow.etl", "--data", name, "--camera", WRIST, "-o", f"{name}.slow")
    check_columns(f"{name}.slow", truth, name, 2)
    frames = lerobot.frames_of(name, release, LENGTHS, 1, WRIST)
    made = np.load(f"{name}.slow/{name}-000001.npz")
    assert np.array_equal(made["z"], checksums(frames)[::2])

    # Two cameras, some of the episodes, and labels.
    embed("both.etl", "--data", f"{name}:1:3", "--camera", f"z={TOP}", f"w={WRIST}", "-o",
          f"{name}.both", "--map", "truth.near=next.success")
    assert sorted(os.listdir(f"{name}.both")) == [f"{name}-000001.npz", f"{name}-000002.npz"]
    made = np.load(f"{name}.both/{name}-000002.npz")
    for array, camera in (("z", TOP), ("w", WRIST)):
        frames = lerobot.frames_of(name, release, LENGTHS, 2, camera)
        assert np.array_equal(made[array], checksums(frames)), (release, camera)
    assert np.array_equal(made["truth.near"], truth[2][2])


def check_ends_at_last_frames():
    """Version 3.0 with a video for each episode, whose stated end is its last frame's time."""
    truth = lerobot.write("last", "v3.0", LENGTHS)
    table = lerobot.episode_table(LENGTHS)
    for camera in lerobot.CAMERAS:
        for episode, length in enumerate(LENGTHS):
            lerobot.video(f"last/videos/{camera}/chunk-000/file-{episode:03}.mp4", length, episode)
        of_camera = f"videos/{camera}/"
        table[of_camera + "file_index"] = (parquet.INT64, list(range(len(LENGTHS))))
        table[of_camera + "from_timestamp"] = (parquet.DOUBLE, [0.0] * len(LENGTHS))
        table[of_camera + "to_timestamp"] = (
            parquet.DOUBLE, [(length - 1) / lerobot.FPS for length in LENGTHS])
    parquet.write("last/meta/episodes/chunk-000/file-000.parquet", table,
                  nested=("stats/action/mean",))
    embed("see.etl", "--data", "last", "--camera", TOP, "-o", "last.out")
    check_columns("last.out", truth, "last")
    for episode in range(len(LENGTHS)):
        video = f"last/videos/{TOP}/chunk-000/file-{episode:03}.mp4"
        made = np.load(f"last.out/last-{episode:06}.npz")
        assert np.array_equal(made["z"], checksums(lerobot.raw_frames(video))), episode
    lerobot.video(f"last/videos/{TOP}/chunk-000/file-002.mp4", LENGTHS[2], 7)
    again = embed("see.etl", "--data", "last", "--camera", TOP, "-o", "last.out")
    assert "last.out, 2 with embeddings of an earlier call\n" in again, again
    lerobot.video(f"last/videos/{TOP}/chunk-000/file-001.mp4", LENGTHS[1] - 1, 1)
    refused = embed("see.etl", "--data", "last", "--camera", TOP, "-o", "last.short", status=1)
    assert f"has only {LENGTHS[1] - 1} steps" in refused, refused


def check_in_place(version):
    """Without an encoder, the rows and the episodes made from them give the same verdicts."""
    name = f"set{version[1]}"
    call(ETLC, "embed", "plain.etl", "--data", f"{name}/", *MAP, "-o", f"{name}.plain")
    for episode in range(len(LENGTHS)):
        rows = call(ETLC, "run", "plain.etl", "--trace", f"{name}:{episode}", *MAP)
        made = call(ETLC, "run", "plain.etl", "--trace", f"{name}.plain/{name}-{episode:06}.npz")
        assert rows == made and rows.count("\n") == LENGTHS[episode] + 1, (version, episode)
    thresholds = []
    for data in ([name, *MAP], [f"{name}.plain"]):
        call(ETLC, "calibrate", "calibrated.etl", "--data", *data, "-o", "thresholds.json")
        thresholds.append(open("thresholds.json", "rb").read())
    assert thresholds[0] == thresholds[1] and b'"n": 3' in thresholds[0], thresholds
    call(ETLC, "calibrate", "calibrated.etl", "--data", f"{name}:0:2", *MAP, "-o", "some.json")
    assert b'"n": 2' in open("some.json", "rb").read()


def main():
    for name, text in (
            ("see.py", CHECKSUMS), ("see.etl", SEEN.format(rate=10, more="")),
            ("slow.etl", SEEN.format(rate=5, more="")),
            ("both.etl", SEEN.format(rate=10, more="input w : f32[2] by see;\n"
                                     "monitor w_seen = F l2(w, none) <= 1;\n")),
            ("plain.etl", "spec plain;\nrate 10 Hz;\n" + INPUTS),
            ("calibrated.etl", CALIBRATED)):
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
    check_version("v2.1", codec=parquet.SNAPPY, page_rows=7)
    check_version("v3.0", codec=parquet.ZSTD, dictionary=True, version=2, checksums=True)
    check_ends_at_last_frames()
    for version in ("v2.1", "v3.0"):
        check_in_place(version)


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
    os.chdir("/")
