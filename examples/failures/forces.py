#!/usr/bin/env python3
"""forces.py SOURCE FOLDER: forces and torques of a real arm after failures (README.md)."""

import collections

import numpy as np

import failures

STEPS = 15
NORMAL = ("normal", "ok")


def windows(file):
    """(label, 15 x 6 numbers) of each window: a line with the label, and a line a sample."""
    label, rows = None, []
    for line in file.read_text().splitlines():
        cells = line.split()
        if len(cells) == 1:
            label, rows = cells[0], []
        elif cells:
            rows.append([float(cell) for cell in cells])
            if len(rows) == STEPS:
                yield label, np.array(rows, "f4")


def shared(one, other):
    """How many samples two windows have in common, in any order."""
    counts = [collections.Counter(map(bytes, window)) for window in (one, other)]
    return sum((counts[0] & counts[1]).values())


def read(source, folder):
    kept = []
    for file in sorted(source.glob("lp[1-5].data")):
        for label, force in windows(file):
            # Most windows are in several files, and some are the same samples a little later.
            if all(shared(force, other) < 5 for other in kept):
                kept.append(force)
                failures.write(folder, f"{file.stem}-{len(kept)}", label not in NORMAL, force=force)


if __name__ == "__main__":
    failures.main(read, [("", ["forces_seen", "forces_changes", "forces_times"])], "seconds", 0.021)
