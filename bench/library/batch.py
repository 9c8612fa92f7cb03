#!/usr/bin/python3
"""Compares a step of 1,000 environments from Python with numpy, and with a monitor for each.

batch.py [ENVIRONMENTS [DIMENSION]]: milliseconds per step of `Batch.step`, of its distances alone
in numpy (by differences, and by a matrix product, which rounds differently), and of so many
monitors.
PYTHONPATH and ETLC_LIBRARY lead to the package.
"""

import statistics
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import etlc

ENVIRONMENTS = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
DIMENSION = int(sys.argv[2]) if len(sys.argv) > 2 else 512
MONITORS = 100  # of so many the time is measured, and multiplied

SPEC = """spec reach;
input z : f32[{}];
input gripper : f32;
target goal = load("goal.npy");
predicate at_goal = min l2(z, goal) <= 20;
monitor careful = G (gripper > 0.5 -> at_goal);
monitor arrives = F[0, 30] at_goal;
"""


def milliseconds(work, rounds):
    """Uses this process's own time, which a busy machine increases less."""
    times = []
    for _ in range(rounds):
        begin = time.process_time()
        work()
        times.append((time.process_time() - begin) * 1e3)
    return statistics.median(times)


def compare(rows, folder):
    random = np.random.default_rng(1)
    goal = random.normal(size=(rows, DIMENSION)).astype("f4")
    np.save(folder / "goal.npy", goal)
    z = random.normal(size=(ENVIRONMENTS, DIMENSION)).astype("f4")
    gripper = random.random(ENVIRONMENTS).astype("f4")

    def open_monitor():
        return etlc.Monitor(folder / "reach.etl", text=SPEC.format(DIMENSION))

    batch = open_monitor().batch(ENVIRONMENTS)
    monitors = [open_monitor() for _ in range(MONITORS)]

    def by_differences():
        return np.sqrt(((z[:, None, :] - goal) ** 2).sum(-1)).min(1)

    def by_a_product():
        squares = (z * z).sum(1)[:, None] + (goal * goal).sum(1) - 2 * z @ goal.T
        return np.sqrt(np.maximum(squares, 0)).min(1)

    def each():
        for n, monitor in enumerate(monitors):
            monitor.step(z=z[n], gripper=gripper[n])

    print(
        f"{rows:5} {milliseconds(lambda: batch.step(z=z, gripper=gripper), 101):9.2f}"
        f" {milliseconds(by_differences, 5):12.2f} {milliseconds(by_a_product, 31):9.2f}"
        f" {milliseconds(each, 15) * ENVIRONMENTS / MONITORS:9.2f}"
    )


def main():
    print(f"{ENVIRONMENTS} environments, {DIMENSION} numbers; ms a step")
    print(f"{'rows':>5} {'batch':>9} {'differences':>12} {'product':>9} {'monitors':>9}")
    with tempfile.TemporaryDirectory() as folder:
        for rows in (1, 4, 16, 64):
            compare(rows, Path(folder))


main()
