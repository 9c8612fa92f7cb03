#!/usr/bin/env python3
"""datasets_page_test.py ETLC RECORDINGS.MD HDF5: runs the specs and commands of the section about
data sets, on some made here."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

import lerobot

ETLC = os.path.abspath(sys.argv[1])
WHOLE = pathlib.Path(sys.argv[2]).read_text()
PAGE = re.search(r"^## Data sets.*?(?=^## )", WHOLE, re.DOTALL | re.MULTILINE).group(0)
ENCODER = re.search(r"```python\n(import struct.*?)```", WHOLE, re.DOTALL).group(1)
HDF5 = os.path.abspath(sys.argv[3])
SPECS = re.findall(r"```\n(spec (\w+);.*?)```", PAGE, re.DOTALL)
COMMANDS = re.findall(r"^    (etlc (?:.*\\\n)*.*)$", PAGE, re.MULTILINE)
WARNING = re.search(r"^pick: warning: .*$", PAGE, re.MULTILINE).group(0)


def call(command):
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert done.returncode == 0, (command, done.stdout, done.stderr)
    return done.stdout + done.stderr


def main():
    for text, name in SPECS:
        pathlib.Path(f"{name}.etl").write_text(text)
    pathlib.Path("encoder.py").write_text(ENCODER)
    os.environ["PATH"] = os.path.dirname(ETLC) + ":/usr/bin:" + os.environ["PATH"]
    truth = lerobot.write("pick", "v2.1", (12, 9, 10))
    assert [command.split()[1] for command in COMMANDS] == ["calibrate", "run", "embed", "run",
                                                            "annotate", "embed"], COMMANDS
    assert "2 demonstrations" in call(COMMANDS[0]) or "n = 2" in call(COMMANDS[0])
    assert "back: " in call(COMMANDS[1])
    assert "task 'place it in the bin': 1 episode" in call(COMMANDS[2])
    assert "near: " in call(COMMANDS[3])
    made = np.load("episodes/pick-000002.npz")
    frames = lerobot.frames_of("pick", "v2.1", (12, 9, 10), 2, lerobot.CAMERAS[0]) / 255
    assert np.allclose(made["z"][:, :3], frames.mean(axis=(1, 2)), atol=1e-5)
    assert np.array_equal(made["grip"], truth[2][1][:, 1])
    lerobot.write("stack", "v3.0", (12, 9, 10), without=("next.success",))
    assert "annotated: 2 files of rows extended" in call(COMMANDS[4])
    assert sorted(set(os.listdir("annotated")) - set(os.listdir("stack"))) == [
        "sarm_progress.parquet"]
    call(f"{HDF5} demos.h5")
    assert "2 episodes" in call(COMMANDS[5])
    assert np.load("episodes/demos-demo_1.npz")["grip"].tolist() == [1, 1.25, 1.5, 1.75]
    for demo in (0, 1):
        os.remove(f"episodes/demos-demo_{demo}.npz")
    os.remove("pick/data/chunk-000/episode_000001.parquet")
    os.remove("episodes/pick-000001.npz")
    assert WARNING in call(COMMANDS[2]).splitlines()
    assert sorted(os.listdir("episodes")) == ["pick-000000.npz", "pick-000002.npz"]


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
    os.chdir("/")
