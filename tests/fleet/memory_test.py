#!/usr/bin/env python3
"""memory_test.py ETLC: the memory of calibrate and evaluate does not depend on the length of
episodes; an error reports temporary files that cannot be made."""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ETLC = os.path.abspath(sys.argv[1])
SPEC = """
spec lasting;
input z : f32[2];
input x : f32;
target goal = [[0, 0], [1, 0]];
predicate near = min l2(z, goal) <= calibrated(class_conditional, alpha = 0.1);
predicate close = min l2(z, goal) <= calibrated(f1);
truth near = x < 1;
truth close = x < 0.5;
monitor keeps = G (close -> near);
"""
EPISODES, SHORT, LONG = 60, 500, 20_000  # 1.2 million frames: 10 MB per predicate, sorted


def make_episodes(folder, steps, seed):
    os.mkdir(folder)
    numbers = np.random.default_rng(seed)
    for number in range(EPISODES):
        x = np.abs(numbers.normal(0, 1, steps)).astype(np.float32)
        z = np.stack([x, numbers.normal(0, 0.3, steps).astype(np.float32)], 1)
        np.savez(f"{folder}/{number:02}.npz", z=z, x=x)


def peak(*words):
    """Returns the peak resident bytes."""
    with open("said", "w", encoding="utf-8") as said:
        process = subprocess.Popen([ETLC, *words], stdout=said, stderr=said)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, (words, pathlib.Path("said").read_text(encoding="utf-8"))
    return usage.ru_maxrss * 1024


def peaks(steps):
    for folder, seed in (("one", 1), ("two", 2)):
        make_episodes(f"{folder}{steps}", steps, seed)
    calibrate = ["calibrate", "lasting.etl", "--data", f"one{steps}", "-o", "t.json", "--jobs", "2"]
    evaluate = ["evaluate", "lasting.etl", "--thresholds", "t.json", "--data", f"two{steps}",
                "--jobs", "2"]
    return peak(*calibrate), peak(*evaluate), calibrate


def main():
    pathlib.Path("lasting.etl").write_text(SPEC, encoding="utf-8")
    *short, _ = peaks(SHORT)
    *long, calibrate = peaks(LONG)
    # Buffers fill up; 40 times the frames would take ten times the memory if it were kept.
    for less, more in zip(short, long):
        assert more - less < 24e6, (short, long)
    refused = subprocess.run([ETLC, *calibrate], capture_output=True, text=True,
                             env={**os.environ, "TMPDIR": "/no/such/folder"})
    assert refused.returncode == 1, refused
    assert "etlc: a temporary file in /no/such/folder cannot be made" in refused.stderr, refused


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
    os.chdir("/")
