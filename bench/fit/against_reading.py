#!/usr/bin/python3
"""The cost of `etlc fit` beside reading the same episodes.

against_reading.py ETLC FOLDER [ROUNDS]: makes missing episodes in the folder, 100 of 300 x 768,
and runs specs in turns. Reading is a fit of one mean: it reads all frames and labels and
prints the same table. Prints medians over the rounds: wall-clock seconds, processor seconds,
and both relative to reading, each ratio taken within a round.
"""

import os
import pathlib
import statistics
import subprocess
import sys
import time

import numpy as np

EPISODES, FRAMES, DIMENSION = 100, 300, 768
MEAN = "target mean = fitted(mean, of = z, where = near);"
PCA = """projection P = fitted(pca, r = 16, of = z, where = true);
target goal = fitted(mean, of = P(z), where = near);"""
DISCRIMINANT = """projection L = fitted(discriminant, r = 1, of = z, where = near);
target side = fitted(mean, of = L(z), where = near);"""
MEDOIDS = """target inside = fitted(medoids, k = 8, of = z, where = near);
target outside = fitted(medoids, k = 8, of = z, where = !near);"""
CASES = {  # the first is reading
    "a mean": (MEAN, "l2(z, mean)"),
    "16 components": (PCA, "l2(P(z), goal)"),
    "a discriminant": (DISCRIMINANT, "l2(L(z), side)"),
    "two sets of 8 medoids": (MEDOIDS, "min l2(z, inside) - min l2(z, outside)"),
    "components, discriminant": (f"{PCA}\n{DISCRIMINANT}", "l2(P(z), goal) + l2(L(z), side)"),
    "all of these": (
        f"{PCA}\n{DISCRIMINANT}\n{MEDOIDS}",
        "l2(P(z), goal) + l2(L(z), side) + min l2(z, inside) - min l2(z, outside)",
    ),
}


def spec(declarations, distance):
    return (
        f"spec fitted;\ninput z : f32[{DIMENSION}];\n{declarations}\n"
        f"predicate near = {distance} <= calibrated(f1);\nmonitor m = F near;\n"
    )


def make_episodes(folder):
    """Each has a stretch near one of eight places."""
    random = np.random.default_rng(1)
    places = random.normal(size=(8, DIMENSION))
    mix = random.normal(size=(40, DIMENSION)) / 4
    for number in range(EPISODES):
        z = random.normal(size=(FRAMES, DIMENSION)) + random.normal(size=(FRAMES, 40)) @ mix
        near = np.zeros(FRAMES, bool)
        near[100:150] = True
        z[near] = places[number % 8] + 0.3 * z[near]
        np.savez(folder / f"{number:02}.npz", z=z.astype(np.float32), **{"truth.near": near})


def seconds(etlc, folder, name):
    begin = time.perf_counter()
    call = [etlc, "fit", f"{name}.etl", "--data", "episodes", "-o", "fitted.npz"]
    child = subprocess.Popen(call, cwd=folder, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    clock = time.perf_counter() - begin
    if status != 0:
        sys.exit(f"{' '.join(call)} failed")
    return clock, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main(etlc, folder, rounds=7):
    folder = pathlib.Path(folder)
    if not (folder / "episodes").exists():
        (folder / "episodes").mkdir(parents=True)
        make_episodes(folder / "episodes")
    names = {case: case.replace(" ", "_").replace(",", "") for case in CASES}
    for case, parts in CASES.items():
        (folder / f"{names[case]}.etl").write_text(spec(*parts))
    times = {case: [] for case in CASES}
    for _ in range(int(rounds)):
        for case in CASES:
            times[case].append(seconds(os.path.abspath(etlc), folder, names[case]))
    reading = next(iter(times.values()))
    print(f"{'':26} {'clock s':>8} {'x':>5} {'processors s':>13} {'x':>5} {'MB':>5}")
    for case, all_ in times.items():
        row = []
        for i in range(2):
            row.append(statistics.median(one[i] for one in all_))
            row.append(statistics.median(a[i] / b[i] for a, b in zip(all_, reading)))
        most = max(one[2] for one in all_)
        print(f"{case:26} {row[0]:8.2f} {row[1]:5.1f} {row[2]:13.2f} {row[3]:5.1f} {most:5.0f}")


main(*sys.argv[1:])
