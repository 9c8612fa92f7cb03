#!/usr/bin/python3
"""What users wait for, each beside the least that it could take, in one run.

waits.py BUILD FOLDER [ROUNDS]: BUILD is a folder of CMake, such as build/release; missing episodes
are made in FOLDER. Prints a line for each wait: seconds, those of the yardstick, and their ratio,
medians over the rounds, each ratio taken within a round; beside it the aim for the ratio. A
machine that is busy with other work makes all of it longer, and the ratios less steady.
"""

import os
import pathlib
import statistics
import subprocess
import sys
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
EPISODES, FRAMES, DIMENSION = 100, 300, 768  # 92 MB
DRIVES, STEPS = 1000, 300
FIT = {
    "medoids": (
        "target places = fitted(medoids, k = 8, of = z, where = near);",
        "min l2(z, places)",
    ),
    "projection": (
        "projection P = fitted(pca, r = 16, of = z, where = true);\n"
        "target places = fitted(mean, of = P(z), where = near);",
        "l2(P(z), places)",
    ),
    "discriminant": (
        "projection P = fitted(discriminant, r = 1, of = z, where = near);\n"
        "target places = fitted(mean, of = P(z), where = near);",
        "l2(P(z), places)",
    ),
}


def make_embeddings(folder, episodes=EPISODES, seed=1):
    """Each episode has a stretch near one of eight places."""
    random = np.random.default_rng(seed)
    places = random.normal(size=(8, DIMENSION))
    mix = random.normal(size=(40, DIMENSION)) / 4
    for number in range(episodes):
        z = random.normal(size=(FRAMES, DIMENSION)) + random.normal(size=(FRAMES, 40)) @ mix
        near = np.zeros(FRAMES, bool)
        near[100:150] = True
        z[near] = places[number % 8] + 0.3 * z[near]
        np.savez(folder / f"{number:03}.npz", z=z.astype(np.float32), **{"truth.near": near})


def make_drives(folder):
    """Tables of 8 embedding columns, a position and a truth."""
    random = np.random.default_rng(2)
    names = ",".join([f"z[{i}]" for i in range(8)] + ["px", "py", "truth.near"])
    for number in range(DRIVES):
        x = np.cumsum(random.normal(size=(STEPS, 2)) / 10, axis=0)
        z = random.normal(size=(STEPS, 8)) / 5
        z[:, :2] += x
        near = np.hypot(x[:, 0], x[:, 1]) < 1
        rows = np.column_stack([z, x, near])
        with open(folder / f"{number:04}.csv", "w", encoding="utf-8") as file:
            file.write(names + "\n")
            np.savetxt(file, rows, fmt=["%.6g"] * 10 + ["%d"], delimiter=",")


def write_specs(folder):
    for name, (declarations, distance) in FIT.items():
        (folder / f"{name}.etl").write_text(
            f"spec {name};\ninput z : f32[{DIMENSION}];\n{declarations}\n"
            f"predicate near = {distance} <= calibrated(f1);\nmonitor m = F near;\n"
        )
    (folder / "drives.etl").write_text(
        "spec drives;\nrate 20 Hz;\ninput z : f32[8];\ninput px, py : f32;\n"
        f"target goal = [[{', '.join('0' * 8)}]];\n"
        "predicate near = l2(z, goal) <= 1.1;\n"
        "monitor reach = F near;\nmonitor keeps = G (near -> F[0 s, 2 s] !near);\n"
    )


def clock(action):
    begin = time.perf_counter()
    action()
    return time.perf_counter() - begin


class Waits:
    def __init__(self, build, folder):
        self.build, self.folder = build, folder

    def run(self, *words):
        subprocess.run(
            [self.build / "etlc", *words], cwd=self.folder, check=True, stdout=subprocess.DEVNULL
        )

    def seconds(self, *words):
        return clock(lambda: self.run(*words))

    # ---- the yardsticks

    def load(self):
        """numpy.load of all embeddings."""

        def read():
            for path in sorted((self.folder / "embeddings").glob("*.npz")):
                with np.load(path) as arrays:
                    self.last = [arrays["z"], arrays["truth.near"]]

        return clock(read)

    def load_and_solve(self):
        """numpy.load, the sum of X'X, and its eigenvectors."""

        def solve():
            sums = np.zeros((DIMENSION, DIMENSION))
            for path in sorted((self.folder / "embeddings").glob("*.npz")):
                with np.load(path) as arrays:
                    x = arrays["z"].astype(np.float64)
                    sums += x.T @ x
            np.linalg.eigh(sums)

        return clock(solve)

    def load_text(self):
        """numpy.loadtxt of all drives."""

        def read():
            for path in sorted((self.folder / "drives").glob("*.csv")):
                np.loadtxt(path, delimiter=",", skiprows=1)

        return clock(read)

    # ---- the waits: seconds, yardstick

    def fit(self, name):
        yardstick = self.load() if name == "medoids" else self.load_and_solve()
        return self.seconds("fit", f"{name}.etl", "--data", "embeddings"), yardstick

    def crossvalidate(self):
        data = ["medoids.etl", "--data", "embeddings"]
        fit = self.seconds("fit", *data)
        self.run("fit", "medoids.etl", "--data", "for_fit")  # episodes serve one purpose
        self.run("calibrate", "medoids.etl", "--data", "for_calibrate")
        evaluate = self.seconds("evaluate", *data)
        for made in ("medoids.fitted.npz", "medoids.thresholds.json"):
            (self.folder / made).unlink()
        return self.seconds("crossvalidate", *data), fit + evaluate

    def drives(self, command, *words):
        return self.seconds(command, "drives.etl", "--data", "drives", *words), self.load_text()

    def two_workers(self):
        """Two threads, beside half of one; in the ideal case they take the same time."""
        one = self.seconds("evaluate", "drives.etl", "--data", "drives", "-j", "1")
        two = self.seconds("evaluate", "drives.etl", "--data", "drives", "-j", "2")
        return two, one / 2

    def keystroke(self):
        """The 95th percentile in the language server at 1000 lines, in seconds; beside 50 ms."""
        script = ROOT / "bench/lsp/keystrokes.py"
        call = [sys.executable, script, self.build / "etlc", "1000"]
        printed = subprocess.run(call, check=True, capture_output=True, text=True).stdout
        row = next(line for line in printed.splitlines() if line.startswith("key stroke"))
        return float(row.split("p95")[1].split()[0]) / 1000, 0.05

    def library_step(self):
        """etlc_step() on the example `grasp`, beside its generated class, in seconds a step."""
        bench, spec = self.build / "bench", ROOT / "examples/firmware_loop/grasp.etl"

        def row(*call):
            printed = subprocess.run(call, check=True, capture_output=True, text=True).stdout
            return next(line for line in printed.splitlines() if "grasp" in line)

        through = row(bench / "library/bench_library", spec).split()[2]
        own = row(bench / "steps/bench_steps").split("384 x 4")[1].split()[0]
        return float(through) / 1e9, float(own) / 1e9

    def short_run(self):
        """`etlc run` of one drive, beside a program that only starts."""
        trace = sorted((self.folder / "drives").glob("*.csv"))[0]
        return self.seconds("run", "drives.etl", "--trace", trace), self.seconds("--version")

    def rows(self):
        rows = {
            "fit medoids / numpy.load": (lambda: self.fit("medoids"), "1.5"),
            "fit a projection / load, X'X, eigh": (lambda: self.fit("projection"), "1.3"),
            "fit a discriminant / load, X'X, eigh": (lambda: self.fit("discriminant"), "1.3"),
            "crossvalidate / fit + evaluate": (self.crossvalidate, "1.5"),
            "evaluate CSV / numpy.loadtxt": (lambda: self.drives("evaluate"), "1.3"),
            "report CSV / numpy.loadtxt": (
                lambda: self.drives("report", "-o", "page.html"), "2"),
            "two workers / half of one": (self.two_workers, "1.1"),
            "LSP, 1000 lines, p95 / 50 ms": (self.keystroke, "1"),
            "run of one CSV / --version": (self.short_run, "-"),
        }
        if (self.build / "bench").exists():  # built with -DETLC_BUILD_BENCH=ON
            rows["library step / class, 384 x 4"] = (self.library_step, "1.5")
        return rows


def main(build, folder, rounds=5):
    folder = pathlib.Path(folder).resolve()
    makers = {
        "embeddings": make_embeddings,
        "for_fit": lambda at: make_embeddings(at, 10, 3),
        "for_calibrate": lambda at: make_embeddings(at, 10, 4),
        "drives": make_drives,
    }
    for name, make in makers.items():
        if not (folder / name).exists():
            (folder / name).mkdir(parents=True)
            make(folder / name)
    write_specs(folder)
    waits = Waits(pathlib.Path(build).resolve(), folder)
    print(f"{'':38} {'seconds':>10} {'beside':>10} {'ratio':>6} {'aim':>5}")
    for name, (measure, aim) in waits.rows().items():
        times = [measure() for _ in range(int(rounds))]
        wait, yardstick = (statistics.median(column) for column in zip(*times))
        ratio = statistics.median(one / other for one, other in times)
        print(f"{name:38} {wait:10.4g} {yardstick:10.4g} {ratio:6.2f} {aim:>5}", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
