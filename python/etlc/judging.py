"""The commands that judge monitors: `evaluate`, `crossvalidate`, `report`, `prove`, `annotate`."""

from __future__ import annotations

import json as json_module
import tempfile
from pathlib import Path
from typing import Any, Iterable, Mapping

from ._keywords import FilePath, FilePaths, checks_names, path_of, words_of
from ._process import run
from .results import Evaluation, Proof, Written


@checks_names
def evaluate(
    specs: FilePaths,
    data: FilePaths,
    *,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    split: str | None = None,
    labels: FilePaths | None = None,
    label_by: str | None = None,
    allow_overlap: str | None = None,
    folds: int | None = None,
    by_episode: bool = False,
    variants: str | Iterable[str] | None = None,
    json: FilePath | None = None,
    csv: FilePath | None = None,
    shard: str | tuple[int, int] | None = None,
    part: FilePath | None = None,
    values: str | None = None,
    targets_as: str | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    jobs: int | None = None,
    warnings_are_errors: bool = False,
) -> Evaluation:
    """Compares predicates and monitors with ground truth on recorded episodes.

    Args:
        specs: the path of the spec, or of several, which are compared side by side.
        data: episodes: files (.csv, .npz, .h5), folders, data sets or patterns.
        thresholds, fitted, embedded: files for the spec; by default those beside it.
        folds: calibrate on all folds but one and evaluate on that one, in turn.
        by_episode: also report each episode, the worst first.
        variants: also judge the monitors on failures made of the episodes: "cut",
            "phases_reversed", "reversed", "frozen".
        json, csv: also write the figures into these files.
        shard, part: read one shard of the episodes, and write a part for `merge`.
        settings, names, groups, split, labels, label_by, allow_overlap, jobs,
            warnings_are_errors: as in `calibrate`.
        values, targets_as, max_state, max_code, max_work: as in `compile`.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    return _judged("evaluate", locals())


@checks_names
def crossvalidate(
    specs: FilePaths,
    data: FilePaths,
    *,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    split: str | None = None,
    labels: FilePaths | None = None,
    label_by: str | None = None,
    allow_overlap: str | None = None,
    folds: int | None = None,
    by: str | None = None,
    by_episode: bool = False,
    variants: str | Iterable[str] | None = None,
    json: FilePath | None = None,
    csv: FilePath | None = None,
    values: str | None = None,
    targets_as: str | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    jobs: int | None = None,
    warnings_are_errors: bool = False,
) -> Evaluation:
    """Fits, calibrates and evaluates a spec with one set of episodes, in folds.

    Args:
        specs, data: as in `evaluate`.
        folds: their number; by default 5.
        by: "order" judges later episodes by what earlier ones trained; by default "hash".
        thresholds, fitted, embedded, settings, names, groups, split, labels, label_by,
            allow_overlap, by_episode, variants, json, csv, values, targets_as, max_state, max_code,
            max_work, jobs, warnings_are_errors: as in `evaluate`.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    return _judged("crossvalidate", locals())


@checks_names
def report(
    spec: FilePath,
    data: FilePaths,
    output: FilePath,
    *,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    split: str | None = None,
    labels: FilePaths | None = None,
    label_by: str | None = None,
    allow_overlap: str | None = None,
    frames: str | None = None,
    camera: str | None = None,
    size: int | None = None,
    no_truths: bool = False,
    values: str | None = None,
    targets_as: str | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    jobs: int | None = None,
    warnings_are_errors: bool = False,
) -> Written:
    """Writes a page about recorded episodes, with the figures of `evaluate`.

    Args:
        spec, data: as in `evaluate`.
        output: the page, an .html file.
        frames: camera frames: an array of the episodes, the folder of a data set, or a pattern:
            "camera/{episode}/*.png".
        camera: the camera of a data set.
        size: the size of the page in MB.
        no_truths: show the verdicts without comparing them with truths.
        thresholds, fitted, embedded, settings, names, groups, split, labels, label_by,
            allow_overlap, values, targets_as, max_state, max_code, max_work, jobs,
            warnings_are_errors: as in `evaluate`.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    ran = run(words_of("report", locals()))
    return Written(path_of("output", output), ran.report, ran.diagnostics)


@checks_names
def prove(
    spec: FilePath,
    *,
    steps: int | None = None,
    header: FilePath | None = None,
    counterexample: FilePath | None = None,
    output: FilePath | None = None,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    namespace: str | None = None,
    explain: bool = False,
    retargetable: bool = False,
    recorder: str | tuple[int | str, int | str, int] | None = None,
    lets: bool = False,
    values: str | None = None,
    targets_as: str | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    warnings_are_errors: bool = False,
) -> Proof:
    """Proves that the temporal part of the generated class gives the verdicts of the definition.

    It takes a C++ compiler, $CXX or c++.

    Args:
        spec: the path of the spec.
        steps: the length of the longest inputs; by default twice the longest horizon.
        header: a header that has to be, byte for byte, the one that is proved.
        counterexample: where an input on which the class is wrong is written, without its ending.
        output: also write the certificate into this file.
        namespace, explain, retargetable, recorder, lets: as in `compile`.
        thresholds, fitted, embedded, settings, values, targets_as, max_state, max_code, max_work,
            warnings_are_errors: as in `evaluate`.

    Raises:
        SpecError: the class is wrong, or cannot be proved; the message gives the reason.
        InputError: an argument is invalid.
    """
    ran = run(words_of("prove", locals()))
    if output is None:
        return Proof(ran.report, ran.diagnostics)
    return Proof(path_of("output", output).read_text(encoding="utf-8"), ran.diagnostics)


@checks_names
def annotate(
    spec: FilePath,
    data: FilePath,
    output: FilePath | None = None,
    *,
    in_place: bool = False,
    success: str | None = None,
    undecided: str | None = None,
    subtasks: str | Iterable[str] | None = None,
    between: str | None = None,
    progress: str | None = None,
    list: FilePath | None = None,
    made: FilePath | None = None,
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
) -> Written:
    """Writes what monitors say of a LeRobot data set into a copy of it.

    Args:
        spec: the path of the spec.
        data: the folder of the data set.
        output: the annotated copy, a new folder.
        in_place: put the copy in the place of the data set.
        success: the monitor that `next.success` is from.
        undecided: "false" writes false for episodes that this monitor does not decide.
        subtasks: predicates and lets that become subtasks of `language_persistent`.
        between: the subtask of rows in which none of these holds; by default "none".
        progress: the monitor of phases, F (a && F (b && ...)), that `sarm_progress.parquet` is
            from, a number from 0 to 1 for each row.
        list: a CSV file of all episodes, the worst first, which needs no output.
        made: the folder of the episodes that `embed` made of the data set.
        names, thresholds, fitted, embedded, settings, values, targets_as, max_state, max_code,
            max_work, warnings_are_errors: as in `evaluate`.

    Returns:
        The output with the printed report; its path is that of the copy, of the data set where it
        was replaced, or of the list.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    ran = run(words_of("annotate", locals()))
    path = output or (data if in_place or list is None else list)
    return Written(path_of("output", path), ran.report, ran.diagnostics)


def _judged(command: str, given: dict[str, Any]) -> Evaluation:
    """Runs the command, and reads the figures that it wrote."""
    words = {("spec" if name == "specs" else name): value for name, value in given.items()}
    if words.get("shard") is not None:
        ran = run(words_of(command, words))
        return Evaluation({}, ran.report, ran.diagnostics)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(words["json"] or Path(folder) / "evaluation.json")
        ran = run(words_of(command, {**words, "json": path}))
        found = json_module.loads(path.read_text(encoding="utf-8"))
    return Evaluation(found, ran.report, ran.diagnostics)
