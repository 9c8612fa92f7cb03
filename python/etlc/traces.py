"""The commands about one trace: `run`, `explain` and `incident`."""

from __future__ import annotations

import csv
import json
import tempfile
from pathlib import Path
from typing import Mapping

import numpy as np

from ._keywords import FilePath, checks_names, path_of, words_of
from ._library import DECIDED, FINAL, SATISFIED, VIOLATED
from ._process import run as run_command
from ._types import Array
from .results import Run
from .arrays import VERDICT_DTYPE, Episode
from .verdicts import Explanation

_STATUS = {
    "undecided": 0, "unknown": DECIDED, "satisfied": DECIDED | SATISFIED,
    "violated": DECIDED | VIOLATED,
}  # fmt: skip
_COLUMNS = ("step", "monitor", "lower", "robustness", "upper", "status", "final", "position")


@checks_names
def run(
    spec: FilePath,
    trace: FilePath,
    *,
    output: FilePath | None = None,
    distances: bool = False,
    lets: bool = False,
    finish: bool = False,
    html: FilePath | None = None,
    svg: FilePath | None = None,
    retargetable: bool = False,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    values: str | None = None,
    targets_as: str | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    warnings_are_errors: bool = False,
) -> Run:
    """Gives the verdicts on a recorded trace. `Monitor.run` takes arrays.

    Args:
        spec: the path of the spec.
        trace: a file: .csv, .npz or .h5; FILE.h5:GROUP, or FOLDER:3 of a data set.
        output: also keep the verdicts as CSV.
        distances: also the distance or expression that each predicate compares, at each step.
        lets: also the robustness of each let that does not look ahead.
        finish: after the trace, also report the last positions of sliding monitors.
        html, svg: also write a page about the trace, or a picture of its timelines.
        retargetable: compute the bounds of a retargetable class.
        thresholds, fitted, embedded, settings, names, warnings_are_errors: as in `calibrate`.
        values, targets_as, max_state, max_code, max_work: as in `compile`.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    given = locals()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "verdicts.csv" if output is None else path_of("output", output)
        ran = run_command(words_of("run", {**given, "output": path, "summary": True}))
        with open(path, encoding="utf-8", newline="") as file:
            rows = csv.reader(file)
            head = next(rows)
            columns = list(zip(*rows)) or [()] * len(head)
    table = dict(zip(head, columns))
    monitors = tuple(dict.fromkeys(table["monitor"]))
    shape = (-1, max(len(monitors), 1))
    found = np.empty(len(table["monitor"]), VERDICT_DTYPE)
    for name in ("robustness", "lower", "upper"):
        found[name] = _numbers(table[name])
    found["status"] = [
        _STATUS[status] | (FINAL if final == "1" else 0)
        for status, final in zip(table["status"], table["final"])
    ]
    positions = np.array([int(one or -1) for one in table["position"]], "i8").reshape(shape)

    def per_step(prefix: str) -> dict[str, Array]:
        return {
            name.removeprefix(prefix): _numbers(table[name][:: shape[1]])
            for name in head
            if name.startswith(prefix) and name not in _COLUMNS
        }

    times = table.get("time", ())[shape[1] : shape[1] + 1]  # that of step 1
    seconds = float(times[0]) if times else 0.0
    episode = Episode(monitors, found.reshape(shape), per_step("distance_"), step_seconds=seconds)
    return Run(episode, positions, per_step("robustness_"), ran.report, ran.diagnostics)


def _numbers(cells: tuple[str, ...]) -> Array:
    """Returns float32; NaN for an empty cell."""
    return np.array([cell or "nan" for cell in cells], "f4")


@checks_names
def explain(
    spec: FilePath,
    trace: FilePath,
    *,
    monitor: str | None = None,
    step: int | None = None,
    at: float | None = None,
    output: FilePath | None = None,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    values: str | None = None,
    targets_as: str | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    warnings_are_errors: bool = False,
) -> Explanation:
    """Explains a verdict on a recorded trace. `Verdict.why` explains that of a Monitor.

    Args:
        spec, trace: as in `run`.
        monitor: the name; by default the first that raises an alarm, else the first.
        step: the step after which the verdict is explained; by default that of the first alarm.
        at: the time in seconds, in place of `step`.
        output: also write the text into this file.
        thresholds, fitted, embedded, settings, names, values, targets_as, max_state, max_code,
            max_work, warnings_are_errors: as in `run`.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    given = {**locals(), "output": None}
    ran = run_command(words_of("explain", {**given, "form": "json"}))
    text = run_command(words_of("explain", given), quiet=True).report
    if output is not None:
        path_of("output", output).write_text(text, encoding="utf-8")
    return Explanation(text, json.loads(ran.report))


@checks_names
def incident(
    spec: FilePath,
    data: bytes | FilePath,
    *,
    form: str = "table",
    output: FilePath | None = None,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    values: str | None = None,
    targets_as: str | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    warnings_are_errors: bool = False,
) -> str:
    """Returns the text of an incident of a flight recorder: the steps around an alarm.

    Args:
        spec: the path of the spec.
        data: one of `Monitor.incidents`, or the path of a file.
        form: "table", "csv", "trace" or "spec" (docs/recordings.md).
        output: also write the text into this file.
        thresholds, fitted, embedded, settings, values, targets_as, max_state, max_code, max_work:
            the arguments that the monitor was opened with.
        warnings_are_errors: whether a warning fails the command.

    Raises:
        SpecError: the incident is damaged, or belongs to another spec.
        InputError: an argument is invalid.
    """
    given = {name: value for name, value in locals().items() if name not in ("data", "output")}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "incident"
        if isinstance(data, bytes):
            path.write_bytes(data)
        file = path if isinstance(data, bytes) else data
        text = run_command(words_of("incident", {**given, "file": file})).report
    if output is not None:
        path_of("output", output).write_text(text, encoding="utf-8")
    return text
