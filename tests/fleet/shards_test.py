#!/usr/bin/env python3
"""shards_test.py ETLC: calibrate and evaluate give, from the parts of any number of shards in any
order, the bytes of one process; a part that is missing, repeated, from another call, cut or changed
is reported, and nothing is written."""
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np

ETLC = os.path.abspath(sys.argv[1])
SPEC = """
spec fleet;
rate 10 Hz;
input z : f32[4];
input x : f32;
target goal = [[0, 0, 0, 0], [1, 0, 0, 0]];
predicate near = min l2(z, goal) <= calibrated(conformal, alpha = 0.2);
predicate close = min l2(z, goal) <= calibrated(f1);
truth near = x < 1;
truth close = x < 0.5;
monitor arrives = F near;
monitor careful = G close calibrated(conformal, alpha = 0.2, against = missed_alarm);
sliding monitor soon = F[0, 3] close;
"""
CALIBRATED, WHOLE, JUDGED = 40, 40, 30


def call(*words, status=0):
    done = subprocess.run([ETLC, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout if status == 0 else done.stderr


def make_episodes(folder, count, seed):
    os.mkdir(folder)
    numbers = np.random.default_rng(seed)
    for number in range(count):
        steps = int(numbers.integers(8, 30))
        x = np.cumsum(numbers.normal(0, 0.4, steps)) + 1
        z = np.stack([x] * 4, 1) / 2 + numbers.normal(0, 0.1, (steps, 4))
        z[numbers.random(steps) < 0.05] = np.nan
        np.savez(f"{folder}/{number:03}.npz", z=z.astype(np.float32), x=x)


def result(prefix):
    """Returns the output files of a call, and its messages."""
    return {path.name: path.read_bytes() for path in pathlib.Path().glob(f"{prefix}.*")}


def shards(words, count, seed):
    """Returns the parts in random order."""
    order = list(range(1, count + 1))
    random.Random(seed).shuffle(order)
    read = 0
    for shard in order:
        said = call(*words, "--shard", f"{shard}/{count}", "--part", f"{shard}.part", "--jobs",
                    1 + seed)
        read += int(said.split(": ")[1].split()[0])
    random.Random(~seed).shuffle(order)
    return [f"{shard}.part" for shard in order], read


def same_as_one_process(words, episodes, counts):
    """Runs `words`, which write files named out.something."""
    printed = call(*words)
    one = result("out")
    assert one, words
    for seed, count in enumerate(counts):
        for path in one:
            os.remove(path)
        parts, read = shards(words, count, seed)
        assert read == episodes and not result("out"), "a shard reads its own, and writes no result"
        assert call("merge", *parts) == printed, (words, count)
        assert result("out") == one, (words, count)
        if count == counts[-1]:
            return parts
        for part in parts:
            os.remove(part)
    return []


def refused(code, *words):
    before = sorted(os.listdir("."))
    said = call("merge", *words, status=1)
    assert code in said, (code, said)
    assert sorted(os.listdir(".")) == before, "something is left behind"
    return said


def main():
    pathlib.Path("fleet.etl").write_text(SPEC)
    for folder, count, seed in (("one", CALIBRATED, 1), ("two", WHOLE, 2), ("three", JUDGED, 3)):
        make_episodes(folder, count, seed)
    calibrate = ["calibrate", "fleet.etl", "--data", "one", "-o", "out.json", "--folds", "4"]
    same_as_one_process(calibrate, CALIBRATED, (1, 2, 7, 64))
    os.rename("out.json", "predicates.json")
    whole = ["calibrate", "fleet.etl", "--data", "two", "-o", "out.json", "--thresholds",
             "predicates.json"]
    parts = same_as_one_process(whole, WHOLE, (2, 7))
    call("merge", *parts, "-o", "elsewhere.json")
    assert pathlib.Path("elsewhere.json").read_bytes() == pathlib.Path("out.json").read_bytes()
    os.rename("out.json", "thresholds.json")
    for part in parts:
        os.remove(part)
    evaluate = ["evaluate", "fleet.etl", "--thresholds", "thresholds.json", "--data", "three",
                "--json", "out.json", "--csv", "out.csv", "--variants", "reversed,cut",
                "--by-episode"]
    parts = same_as_one_process(evaluate, JUDGED, (1, 2, 64, 7))

    assert "is one of 7 shards; missing" in refused("E1104", *parts[1:])
    assert f"{parts[0]} is as well" in refused("E1104", *parts, parts[0])
    refused("E1101", *parts[1:], "gone.part")
    refused("E1102", *parts[1:], "fleet.etl")
    good = pathlib.Path(parts[0]).read_bytes()
    numbers = random.Random(5)
    for _ in range(40):
        at = numbers.randrange(len(good))
        changed = good[:at] + bytes([good[at] ^ 1 << numbers.randrange(8)]) + good[at + 1:]
        for bad in (changed, good[:at], good + good[:at + 1]):
            pathlib.Path(parts[0]).write_bytes(bad)
            refused("E1102", *parts)
    pathlib.Path(parts[0]).write_bytes(good)
    refused("E0904", *parts, "-o", parts[2])
    call(*evaluate[:-1], "--shard", "1/7", "--part", parts[0])  # without --by-episode
    refused("E1103", *parts)
    pathlib.Path(parts[0]).write_bytes(good)
    pathlib.Path("fleet.etl").write_text(SPEC + "// changed\n")
    refused("E1103", *parts)

    for words, mistake in ((["--shard", "8/7", "--part", "p"], "8/7"), (["--part", "p"], "--shard"),
                           (["--shard", "1/7"], "--part"),
                           (["--shard", "1/7", "--part", "-"], "not standard output"),
                           (["--shard", "1/2", "--part", "p", "--folds", "3"], "folds")):
        assert mistake in call(*evaluate[:2], "--data", "three", *words, status=2), words


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
