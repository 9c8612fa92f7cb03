#!/usr/bin/env python3
"""motion_test.py ETLC: a truth that no single frame tells, only the way from one to another. What
is fitted to [z, z@0.2s], or to z - z@0.2s, finds it; fitting, calibration, evaluation and
suggestions agree."""
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

SPEC = """spec rising;
rate 10 Hz;
input z : f32[8];
input up : bool;
projection D = fitted(discriminant, r = 1, of = OF, where = rises);
target one = fitted(mean, of = D(OF), where = rises);
predicate rises = l2(D(OF), one) <= calibrated(conformal, alpha = 0.1);
truth rises = up;
monitor seen = F rises;
"""
PLAIN = """spec rising;
rate 10 Hz;
input z : f32[8];
input up : bool;
target first = [[ZEROS]];
predicate rises = l2(OF, first) <= 1;
truth rises = up;
monitor seen = F rises;
"""


def make_episodes(folder, numbers, axis, random):
    """A point goes up and down a line; where it is says nothing about where it goes."""
    folder.mkdir()
    for number in numbers:
        place, step, left = random.uniform(-1, 1), 0.1, 0
        places, up = [], []
        for _ in range(120):
            if left == 0:
                step, left = random.choice([-0.1, 0.1]), random.integers(8, 20)
            left -= 1
            step = -0.1 if place > 1 else 0.1 if place < -1 else step
            place += step
            places.append(place)
            up.append(step > 0)
        z = np.outer(places, axis) + random.normal(scale=0.02, size=(120, 8))
        np.savez(folder / f"{number:02}.npz", z=z.astype(np.float32), up=np.array(up))


def main(etlc):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        random = np.random.default_rng(7)
        axis = random.normal(size=8)
        axis /= np.linalg.norm(axis)
        make_episodes(folder / "demos", range(12), axis, random)
        make_episodes(folder / "others", range(12, 36), axis, random)
        make_episodes(folder / "new", range(36, 42), axis, random)

        def run(spec, *call):
            (folder / "rising.etl").write_text(spec)
            return subprocess.run(
                [etlc, call[0], "rising.etl", *call[1:]],
                cwd=folder, check=True, stdout=subprocess.PIPE, text=True,
            ).stdout

        def fitted_auroc(of):
            text = run(SPEC.replace("OF", of), "fit", "--data", "demos")
            return float(re.search(r"^  rises +\S+ \[.*?\] +(\S+) \[", text, re.M)[1]), text

        assert fitted_auroc("z")[0] < 0.6, "a frame alone says nothing"
        for of, size in ("[z, z@0.2s]", 16), ("z - z@0.2s", 8):
            moving, text = fitted_auroc(of)
            assert moving > 0.95, text
            # The first two frames of an episode have no earlier sample.
            assert f"{2 * 12} frames left out: the point is missing" in text, text

            spec = SPEC.replace("OF", of)
            run(spec, "calibrate", "--data", "others", "-o", "rising.thresholds.json")
            found = run(spec, "evaluate", "--data", "new")
            auroc = float(re.search(r"^rises .*%\) +(\S+) \[", found, re.M)[1])
            assert auroc > 0.95, found

            plain = PLAIN.replace("OF", of).replace("ZEROS", ", ".join("0" * size))
            best = run(plain, "fit", "--data", "demos", "--suggest", "rises")
            ranked = [float(x) for x in re.findall(r"^[* ] (0\.\d+) \[", best, re.M)]
            assert ranked and ranked[0] > 0.95, best


main(pathlib.Path(sys.argv[1]).resolve())
