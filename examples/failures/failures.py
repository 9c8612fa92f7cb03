"""Episodes as files, and a table of what etlc crossvalidate says of alarms and outcomes.

Used by pick_place.py, crashes.py and forces.py."""

import csv
import os
import pathlib
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
FIGURES = "false_alarm_rate", "detection_rate", "balanced_accuracy", "auroc"


def write(folder, name, failed, group=None, **arrays):
    """One episode: arrays with a row a step. Episodes of one group share a fold."""
    folder = folder / ("failure" if failed else "success")
    folder.mkdir(parents=True, exist_ok=True)
    steps = len(next(iter(arrays.values())))
    arrays["failed"] = np.full(steps, failed, "f4")  # the probe is fitted to it
    np.savez(folder / f"{name}.npz", **arrays)
    if group is not None:
        table = folder / "labels.csv"
        head = "" if table.exists() else "episode,predicate,start,end,group\n"
        with table.open("a") as file:
            file.write(f"{head}{name},,,,{group}\n")


def outcomes(folder, specs, options):
    """{monitor: {figure: [value, low, high]}}"""
    call = [os.environ.get("ETLC", "etlc"), "crossvalidate",
            *(HERE / f"{spec}.etl" for spec in specs), *options, "--csv", "-",
            "--label-by", "folder", "--data", folder / "success", folder / "failure"]
    result = subprocess.run(call, stdout=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        raise SystemExit(result.returncode)
    found = {}
    for row in csv.DictReader(result.stdout.splitlines()):
        if row["level"] == "outcomes" and not row.get("less"):  # that would be a difference
            numbers = [float(row[key]) for key in ("value", "low", "high") if row[key]]
            found.setdefault(row["name"], {})[row["figure"]] = numbers
    return found


def text(numbers, form=".2f"):
    if not numbers:
        return ""
    value, *ends = (format(number, form) for number in numbers)
    return f"{value} [{', '.join(ends)}]" if ends else value


def table(folder, runs, unit, step):
    """A row for each monitor; runs: (what its rows say after the name, specs, options);
    a step is so many units."""
    print("| detector | false alarms | detected | balanced accuracy | AUROC "
          f"| {unit} of warning |\n| --- | --- | --- | --- | --- | --- |")
    for note, specs, *options in runs:
        found = outcomes(folder, specs, options)
        for name, figures in found.items():
            shown = [text(figures.get(figure, [])) for figure in FIGURES]
            warning = [steps * step for steps in figures.get("warning_median_steps", [])]
            print(f"| `{name}`{note} | {' | '.join(shown)} | {text(warning, '.3g')} |")
    length = next(iter(found.values()))
    print("| length, at the end | " + " | ".join(
        text(length[f"duration_{figure}"]) for figure in FIGURES[:3]) + " |  | 0 |")


def main(read, runs, unit, step):
    """read(SOURCE, FOLDER) writes episodes into a new folder."""
    source, folder = map(pathlib.Path, sys.argv[1:])
    folder.mkdir(parents=True)
    read(source, folder)
    counts = [len(list((folder / outcome).glob("*.npz"))) for outcome in ("success", "failure")]
    print("{} successes, {} failures\n".format(*counts), flush=True)
    table(folder, runs, unit, step)
