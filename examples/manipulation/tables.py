#!/usr/bin/env python3
"""tables.py ETLC RECORD FOLDER [SEEDS]: makes the tables of tables.md, as Markdown.

Records episodes of three tasks in FOLDER, for SEEDS seeds each (5), fits and calibrates the specs
beside this file with each encoder, and evaluates them on other episodes and on shifted ones.
The program that trains an encoder is beside RECORD; its result is FOLDER/model.f32.
Existing files in FOLDER are not made again; if a spec changed, remove its results.
"""
import concurrent.futures
import itertools
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).parent
TASKS = ["sorting", "stacking", "pick_place"]
ENCODERS = {"pixels": 768, "conv": 512, "trained": 128}  # and their dimensions
SEEDS = [1, 2, 3, 4, 5]
PARTS = {"fit": 100, "calibration": 40, "tests": 40, "shifted": 40}  # and their episodes
BASELINES = ["pca_kmeans", "logpzo"]
METHODS = {"f1": "calibrated(f1)", "conformal": "calibrated(conformal, alpha = 0.1)"}
PLACES = {"tests": "in distribution", "shifted": "shifted"}
STUDENT = {3: 4.303, 4: 3.182, 5: 2.776}  # 97.5 % quantiles for this many seeds


def run(*command):
    """Runs a command and returns its output. Its messages matter only if it fails."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


def train(trainer, folder):
    """Trains with seed 7, which no episode of the tables has."""
    model = folder / "model.f32"
    if not model.exists():
        folder.mkdir(parents=True, exist_ok=True)
        run(trainer, 7, 60, model)


def record(recorder, folder, task, seed):
    for number, (part, episodes) in enumerate(PARTS.items()):
        into = folder / task / str(seed) / part
        if (into / "recorded").exists():
            continue
        shifted = ["--shifted"] if part == "shifted" else []
        run(recorder, task, 10 * seed + number, episodes, into, *shifted, "--model",
            folder / "model.f32")
        (into / "recorded").touch()


def judge(etlc, folder, task, seed, encoder):
    """Writes FOLDER/TASK/SEED/ENCODER/SPEC.METHOD.PART.json, and fit's output to SPEC.fit.txt."""
    episodes = folder / task / str(seed)
    into = episodes / encoder
    into.mkdir(parents=True, exist_ok=True)
    common = ["--set", f"D={ENCODERS[encoder]}", "--jobs", 1]
    for spec in [task, *BASELINES]:
        fitted = into / f"{spec}.fitted.npz"
        text = (HERE / f"{spec}.etl").read_text()
        report = into / f"{spec}.fit.txt"
        if not report.exists():
            report.write_text(run(etlc, "fit", HERE / f"{spec}.etl", "--data",
                                  episodes / "fit" / encoder, *common, "-o", fitted))
        for method, threshold in METHODS.items():
            variant = into / f"{spec}.{method}.etl"
            thresholds = into / f"{spec}.{method}.thresholds.json"
            variant.write_text(text.replace(METHODS["f1"], threshold))
            if not thresholds.exists():
                run(etlc, "calibrate", variant, "--data", episodes / "calibration" / encoder,
                    "--fitted", fitted, *common)
            for part in PLACES:
                result = into / f"{spec}.{method}.{part}.json"
                if not result.exists():
                    run(etlc, "evaluate", variant, "--data", episodes / part / encoder,
                        "--fitted", fitted, *common, "--json", result)


def figures(folder, task, encoder, spec, method, part, pick):
    """Returns a figure of every seed. pick takes it from the result of 'etlc evaluate'."""
    paths = [folder / task / str(s) / encoder / f"{spec}.{method}.{part}.json" for s in SEEDS]
    picked = [pick(json.loads(p.read_text())) for p in paths]
    return [p for p in picked if p is not None]


def cell(values):
    """Returns the mean over the seeds with its 95 % interval by Student's t, cut at 0 and 1.

    For one or two seeds, too few for an interval, it returns each figure.
    """
    if not values:
        return "-"
    mean = statistics.fmean(values)
    if len(values) not in STUDENT:
        return f"{mean:.3f} ({', '.join(f'{v:.3f}' for v in values)})"
    half = STUDENT[len(values)] * statistics.stdev(values) / len(values) ** 0.5
    return f"{mean:.3f} [{max(0, mean - half):.3f}, {min(1, mean + half):.3f}]"


def table(title, columns, rows):
    print(f"\n**{title}**\n\n| {' | '.join(columns)} |\n|{' --- |' * len(columns)}")
    for row in rows:
        print(f"| {' | '.join(row)} |")


def frames_table(folder, part):
    names = ["f1", "precision", "recall", "agreement", "auroc", "coverage"]
    rows = []
    for task, encoder, method in itertools.product(TASKS, ENCODERS, METHODS):
        first = folder / task / str(SEEDS[0]) / encoder / f"{task}.{method}.{part}.json"
        for predicate in json.loads(first.read_text())["predicates"]:
            rows.append([task, encoder, predicate, method] + [
                cell(figures(folder, task, encoder, task, method, part,
                             lambda r: r["predicates"][predicate][name])) for name in names])
    table(f"Predicates by frames, {PLACES[part]}",
          ["task", "encoder", "predicate", "threshold", "F1", "precision", "recall", "agreement",
           "AUROC", "episodes without a miss"], rows)


def separations(report):
    """Returns for each predicate the AUROC of the plain distance and of the fitted one."""
    line = re.compile(r"^  (\w+) +([\d.]+) \[.*\] +([\d.]+) \[.*\]$", re.MULTILINE)
    return {name: (float(plain), float(fitted)) for name, plain, fitted in line.findall(report)}


def separation_table(folder):
    rows = []
    for task, encoder in itertools.product(TASKS, ENCODERS):
        seeds = [separations((folder / task / str(s) / encoder / f"{task}.fit.txt").read_text())
                 for s in SEEDS]
        for predicate in seeds[0]:
            rows.append([task, encoder, predicate] +
                        [cell([seed[predicate][i] for seed in seeds]) for i in (0, 1)])
    table("AUROC by frame on folds of the episodes that were fitted on",
          ["task", "encoder", "predicate", "plain distance", "as the spec has it"], rows)


def episodes_table(folder, part):
    rows = []
    for task, encoder in itertools.product(TASKS, ENCODERS):
        def f1(spec, method, baseline=None):
            def pick(result):
                scores = result["monitors"]["done"]["episodes"]
                return (scores[baseline] if baseline else scores)["f1"]
            return cell(figures(folder, task, encoder, spec, method, part, pick))
        rows.append([task, encoder] +
                    [f1(s, m) for s in [task, *BASELINES] for m in METHODS] +
                    [f1(task, "f1", "duration"), f1(task, "f1", "always_true")])
    table(f"Episode F1 of `done`, {PLACES[part]}",
          ["task", "encoder", "ETL, f1", "ETL, conformal", "PCA-kmeans, f1",
           "PCA-kmeans, conformal", "logpZO, f1", "logpZO, conformal", "duration", "always true"],
          rows)


def order_table(folder, part):
    orders = {"sorting": ["red_first", "blue_first"], "stacking": ["red_first", "blue_first"],
              "pick_place": ["done", "place_first"]}
    rows = []
    for task, encoder in itertools.product(TASKS, ENCODERS):
        for monitor in orders[task]:
            rows.append([task, encoder, f"`{monitor}`"] + [
                cell(figures(folder, task, encoder, task, method, part,
                             lambda r: r["monitors"][monitor]["episodes"][name]))
                for method in METHODS for name in ["agreement", "f1"]])
    table(f"Order by episodes, {PLACES[part]}",
          ["task", "encoder", "monitor", "agreement, f1", "F1, f1", "agreement, conformal",
           "F1, conformal"], rows)


def main():
    etlc, recorder, folder = (pathlib.Path(a).absolute() for a in sys.argv[1:4])
    if len(sys.argv) == 5:
        del SEEDS[int(sys.argv[4]):]
    began = time.monotonic()

    train(recorder.with_name("manipulation_train"), folder)

    def work(seed, task):
        record(recorder, folder, task, seed)
        for encoder in ENCODERS:
            judge(etlc, folder, task, seed, encoder)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for job in [pool.submit(work, s, t) for s, t in itertools.product(SEEDS, TASKS)]:
            job.result()
    separation_table(folder)
    for part in PLACES:
        episodes_table(folder, part)
        order_table(folder, part)
        frames_table(folder, part)
    print(f"made in {(time.monotonic() - began) / 60:.0f} minutes", file=sys.stderr)


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    main()
