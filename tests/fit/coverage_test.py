#!/usr/bin/env python3
"""coverage_test.py ETLC: fits on some episodes and calibrates on others, 200 times. A new episode
is then covered with probability k / (n + 1) for the rank k among n scores, which is at least 1 -
alpha. It is not if the threshold comes, in spite of `etlc calibrate`, from the episodes used for
fitting."""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ALPHA = 0.2
DRAWS = 200
FITTED = 6  # episodes per draw
CALIBRATED = 12  # rank 11 of 13: well above 1 - alpha, so that chance hides nothing
FRESH = 20
SPEC = """
spec coverage;
input z : f32[24];
input x : f32;
projection L = fitted(discriminant, r = 1, of = z, where = holds);
target mean = fitted(mean, of = L(z), where = holds);
predicate holds = min l2(L(z), mean) <= calibrated(conformal, alpha = 0.2);
truth holds = x <= 0;
monitor m = F holds;
"""


def episode(random):
    """Few frames in many dimensions, so a fit overestimates the separation."""
    x = random.normal(size=6)
    x[:2] = -1, 1
    z = random.normal(size=(6, 24)) + 0.5 * random.normal(size=24)
    return z.astype(np.float32), x


def score(z, x, fitted):
    """Returns the largest distance of a frame at which the predicate holds."""
    along = (z - fitted["L-offset"]).astype(float) @ fitted["L"][0].astype(float)
    return np.abs(along - fitted["mean"][0, 0])[x <= 0].max()


def rank(episodes):
    return math.ceil((1 - ALPHA) * (episodes + 1))


def draw(etlc, folder, random):
    """Returns the fractions of new episodes that the two thresholds cover."""
    parts = {"demos": FITTED, "others": CALIBRATED}
    episodes = {part: [episode(random) for _ in range(n)] for part, n in parts.items()}
    for part, all_ in episodes.items():
        for number, (z, x) in enumerate(all_):
            np.savez(folder / part / f"{number}.npz", z=z, x=x)
    for command, part in (("fit", "demos"), ("calibrate", "others")):
        call = [etlc, command, "coverage.etl", "--data", part, "--jobs", "1"]
        subprocess.run(call, cwd=folder, check=True, capture_output=True)
    fitted = np.load(folder / "coverage.fitted.npz")
    fitted = {name: fitted[name] for name in ("L", "L-offset", "mean")}
    thresholds = json.loads((folder / "coverage.thresholds.json").read_text())
    honest = thresholds["predicates"]["holds"]["epsilon"]
    seen = sorted(score(z, x, fitted) for z, x in episodes["demos"])
    fresh = np.array([score(*episode(random), fitted) for _ in range(FRESH)])
    return (fresh <= honest).mean(), (fresh <= seen[rank(FITTED) - 1]).mean()


def main(etlc):
    random = np.random.default_rng(11)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "coverage.etl").write_text(SPEC)
        for part in ("demos", "others"):
            (folder / part).mkdir()
        covered = np.array([draw(etlc, folder, random) for _ in range(DRAWS)])
    honest, seen = covered.mean(0)
    error = covered.std(0)[0] / math.sqrt(DRAWS)
    print(f"covered: {honest:.3f}; on the episodes that were fitted on: {seen:.3f}")
    exact = rank(CALIBRATED) / (CALIBRATED + 1)
    assert honest >= 1 - ALPHA, "disjoint episodes cover at least 1 - alpha"
    assert abs(honest - exact) <= 3 * error, "and as much as their rank says"
    assert seen < 1 - ALPHA - 0.1, "the same episodes do not"


main(sys.argv[1])
