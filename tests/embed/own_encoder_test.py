#!/usr/bin/env python3
"""own_encoder_test.py ETLC RECORDINGS.MD: the encoder of that page makes targets of images and
episodes of recordings, and `etlc run` reports from which step on these show the same as the
images."""
import csv
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

ETLC = os.path.abspath(sys.argv[1])
PAGE = pathlib.Path(sys.argv[2]).read_text()
CODE = re.search(r"```python\n(import struct.*?)```", PAGE, re.DOTALL).group(1)
SPEC = """
spec look;
rate 10 Hz;
encoder mine = load("encoder.py");
input z : f32[4] by mine;
target bay = images("bay/*.png") by mine;
predicate at_bay = min l2(z, bay) <= 0.3;
monitor docked = F at_bay;
"""
FRAMES, FIRST_AT_BAY = 20, 12


def call(*words):
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, (words, done.stdout, done.stderr)
    return done.stdout


def main():
    pathlib.Path("encoder.py").write_text(CODE)
    pathlib.Path("look.etl").write_text(SPEC)
    for folder in ("bay", "drives", "drives/one"):
        os.mkdir(folder)
    green, grey = np.zeros((16, 16, 3), np.uint8), np.full((16, 16, 3), 90, np.uint8)
    green[:, :, 1] = 200
    Image.fromarray(green).save("bay/1.png")
    for step in range(FRAMES):
        seen = green if step >= FIRST_AT_BAY else grey
        Image.fromarray(seen).save(f"drives/one/{step:03}.png")
    call("ffmpeg", "-v", "error", "-framerate", "10", "-i", "drives/one/%03d.png", "-c:v",
         "libx264", "-pix_fmt", "yuv420p", "drives/two.mp4")

    call(ETLC, "embed", "look.etl", "--data", "drives/one", "drives/two.mp4", "-o", "episodes",
         "--encoder-cmd", "/usr/bin/python3 encoder.py")
    exact = np.load("episodes/one.npz")["z"]
    assert exact.shape == (FRAMES, 4)
    assert np.allclose(exact[-1][:3], [0, 200 / 255, 0], atol=1e-6), exact[-1]
    for name in ("one", "two"):
        rows = list(csv.DictReader(call(ETLC, "run", "look.etl", "--trace",
                                        f"episodes/{name}.npz").splitlines()))
        satisfied = [row for row in rows if "satisfied" in row.values()]
        assert len(rows) == FRAMES and len(satisfied) == FRAMES - FIRST_AT_BAY, rows

    # Parameters of a retargetable class belong to an encoder: those by another, with the same rows,
    # have the same shape, and the class refuses them.
    call(ETLC, "look.etl", "--retargetable", "-o", "look.hpp")
    ours = pathlib.Path("look.params.bin").read_bytes()
    pathlib.Path("encoder.py").write_text(CODE + "# changed\n")
    call(ETLC, "embed", "look.etl", "--encoder-cmd", "/usr/bin/python3 encoder.py")
    call(ETLC, "look.etl", "--emit", "params", "-o", "theirs.bin")
    theirs = pathlib.Path("theirs.bin").read_bytes()
    assert ours[:24] == theirs[:24] and ours[64:] == theirs[64:], "shape and rows are the same"
    assert ours[24:32] != theirs[24:32], "the encoder is another"
    encoder = int.from_bytes(ours[24:32], "little")
    assert f"kEncoder = 0x{encoder:016x}u" in pathlib.Path("look.hpp").read_text()

    Image.fromarray(grey).save("bay/2.png")
    done = subprocess.run([ETLC, "run", "look.etl", "--trace", "episodes/one.npz"],
                          capture_output=True, text=True)
    assert done.returncode == 1 and "E1004" in done.stderr, "another image is seen"


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
