#!/usr/bin/env python3
"""suggest_test.py ETLC: `etlc fit --suggest` prints lines of a spec. Pasted, every suggestion gives
the figure beside it; if a contrast is needed, a contrast wins."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

SPEC = """spec grasp;
input z : f32[24];
target holds_inside = [[1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]];
predicate holds = l2(z, holds_inside) <= calibrated(conformal, alpha = 0.1);
monitor m = F holds;
"""
OLD_LINE = SPEC.splitlines()[3]


def make_episodes(folder, random):
    """The difference of the classes is small beside the noise of every frame: the distance
    to one class separates worse than the difference of the distances to both."""
    apart = random.normal(size=24) * 0.5
    drift = random.normal(size=(4, 24)) * 2
    for number in range(15):
        begin = random.integers(10, 40)
        holds = (np.arange(80) >= begin) & (np.arange(80) < begin + 25)
        z = random.normal(size=(80, 4)) @ drift + np.outer(holds, apart)
        z += random.normal(size=(80, 24))
        np.savez(folder / f"{number:02}.npz", z=z.astype(np.float32), **{"truth.holds": holds})


def main(etlc):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "demos").mkdir()
        make_episodes(folder / "demos", np.random.default_rng(5))

        def run(spec, *options):
            (folder / "grasp.etl").write_text(spec)
            call = [etlc, "fit", "grasp.etl", "--data", "demos", *options]
            return subprocess.run(
                call, cwd=folder, check=True, stdout=subprocess.PIPE, text=True
            ).stdout

        printed = run(SPEC, "--suggest", "holds", "--json", "-j", "1")
        assert printed == run(SPEC, "--suggest", "--json", "-j", "2"), "the same for any threads"
        assert not (folder / "grasp.fitted.npz").exists(), "nothing is written"
        assert (folder / "grasp.etl").read_text() == SPEC, "the spec stays as it is"
        (of_holds,) = json.loads(printed)["predicates"]
        ranked = of_holds["ranked"]
        # Of 23 candidates those with 64 components need more than 24 elements.
        assert len(ranked) == 18 + 1, [one["distance"] for one in ranked]
        figures = [one["auroc"] for one in ranked]
        assert figures == sorted(figures, reverse=True)
        assert ranked[0]["distance"].endswith("contrast") and figures[0] > 0.9
        plain = [one for one in ranked if one["distance"] == "l2(z, mean)"]
        assert plain[0]["auroc"] < 0.8

        text = run(SPEC, "--suggest")
        best = "".join(f"  {line}\n" for line in ranked[0]["lines"])
        assert f"\nBest:\n{best}" in text, "people are told the same lines"
        ties = [one for one in ranked if one["ties"]]
        assert all(one["high"] >= ranked[0]["low"] for one in ties)
        least = min(one["elements"] for one in ties)
        (recommended,) = [one for one in ranked if one["recommended"]]
        assert recommended["ties"] and recommended["elements"] <= 1.1 * least

        for one in ranked:
            if not one["lines"]:
                assert one["distance"] == "l2(z, holds_inside)"  # as it is
                continue
            report = run(SPEC.replace(OLD_LINE, "\n".join(one["lines"])))
            row = re.search(r"^  holds +.*\]  (\S+) \[(\S+), (\S+)\]$", report, re.M)
            expected = [f"{one[key]:.3f}" for key in ("auroc", "low", "high")]
            assert list(row.groups()) == expected, f"{one['distance']}: {row.groups()} {expected}"
            assert "calibrated(conformal, alpha = 0.1);" in one["lines"][-1], "its own bound"


main(sys.argv[1])
