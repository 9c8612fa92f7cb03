"""The commands that fill in what a spec lacks: `fit`, `calibrate`, `embed`; and `merge`."""

from __future__ import annotations

import json
from typing import Iterable, Mapping

from ._keywords import FilePath, FilePaths, checks_names, output_of, words_of
from ._models import Encode
from ._process import run
from .encoding import embed_here
from .results import Suggestions, Written


@checks_names
def calibrate(
    spec: FilePath,
    data: FilePaths,
    *,
    output: FilePath | None = None,
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
    shard: str | tuple[int, int] | None = None,
    part: FilePath | None = None,
    jobs: int | None = None,
    warnings_are_errors: bool = False,
) -> Written:
    """Finds the calibrated thresholds of a spec from labelled demonstrations.

    Args:
        spec: the path of the spec.
        data: episodes: files (.csv, .npz, .h5), folders, data sets or patterns.
        output: the file of thresholds; by default SPEC.thresholds.json beside the spec.
        thresholds: a file with the thresholds of the predicates, to calibrate monitors as a whole.
        fitted: the file of `fit`; by default SPEC.fitted.npz beside the spec.
        embedded: the file of `embed`; by default SPEC.embedded.npz beside the spec.
        settings: other values for constants: {"limit": 0.25, "deadline": "2s"}.
        names: names of inputs in the files: {"z": "obs/z"}.
        groups: a pattern for the groups of .h5 files that are episodes: "data/*".
        split: only a part of the episodes, by shares: "0:0.25", or "0:0.25:order".
        labels: tables of labels (.csv); by default labels.csv beside the episodes, if it exists.
        label_by: "folder" labels each episode, or gives its outcome, by the name of its folder;
            "outcome" takes the outcome from `next.success`, or an attribute `success` in .h5;
            "subtask" labels the rows of LeRobot data sets by the names of their subtasks.
        allow_overlap: the reason why episodes may share most of their content.
        folds: also report the thresholds without each of this many folds.
        shard: (1, 3) reads the first of three shards of the episodes, and writes a part.
        part: with `shard`: the file of the part, for `merge`.
        jobs: the number of threads; by default that of the machine.
        warnings_are_errors: whether a warning fails the command.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    given = locals()
    path = output_of(spec, part or output, ".thresholds.json")
    if part is None:
        given["output"] = path
    ran = run(words_of("calibrate", given))
    return Written(path, ran.report, ran.diagnostics)


@checks_names
def fit(
    spec: FilePath,
    data: FilePaths,
    *,
    output: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    split: str | None = None,
    labels: FilePaths | None = None,
    label_by: str | None = None,
    allow_overlap: str | None = None,
    jobs: int | None = None,
    warnings_are_errors: bool = False,
) -> Written:
    """Computes everything that a spec declares as `fitted(...)` from labelled demonstrations.

    Args:
        spec: the path of the spec.
        data: episodes: files (.csv, .npz, .h5), folders, data sets or patterns.
        output: the file of the fit; by default SPEC.fitted.npz beside the spec.
        embedded, settings, names, groups, split, labels, label_by, allow_overlap, jobs,
            warnings_are_errors: as in `calibrate`.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    given = locals()
    given["output"] = path = output_of(spec, output, ".fitted.npz")
    ran = run(words_of("fit", given))
    return Written(path, ran.report, ran.diagnostics)


@checks_names
def suggest(
    spec: FilePath,
    data: FilePaths,
    predicates: str | Iterable[str] | None = None,
    *,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    split: str | None = None,
    labels: FilePaths | None = None,
    label_by: str | None = None,
    allow_overlap: str | None = None,
    jobs: int | None = None,
    warnings_are_errors: bool = False,
) -> Suggestions:
    """Tries distances, targets and projections for predicates (`etlc fit --suggest --json`).

    Args:
        spec: the path of the spec.
        data: episodes: files (.csv, .npz, .h5), folders, data sets or patterns.
        predicates: names; by default all predicates with labels.
        embedded, settings, names, groups, split, labels, label_by, allow_overlap, jobs,
            warnings_are_errors: as in `calibrate`.

    Returns:
        How well each separates, with the lines to paste into the spec (docs/fitting.md).

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    given = locals()
    wanted = given.pop("predicates")
    ran = run(words_of("fit", {**given, "suggest": True if wanted is None else wanted,
                               "json": True}))  # fmt: skip
    return Suggestions(json.loads(ran.report), ran.diagnostics)


@checks_names
def embed(
    spec: FilePath,
    data: FilePaths | None = None,
    *,
    output: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    camera: str | Mapping[str, str] | None = None,
    shard: str | tuple[int, int] | None = None,
    write_reference: FilePath | None = None,
    onnxruntime: FilePath | None = None,
    encoder_command: str | None = None,
    encoder_timeout: int | None = None,
    encoder: Encode | Mapping[str, Encode] | None = None,
    warnings_are_errors: bool = False,
) -> Written:
    """Encodes the images that a spec names, and recordings into episodes.

    Args:
        spec: the path of the spec. The embeddings of its targets go into SPEC.embedded.npz beside
            it.
        data: recordings to turn into episodes: videos, folders of images, data sets, arrays of
            images, patterns.
        output: the folder for the episodes; required with `data`.
        embedded: the file of the targets' embeddings, in place of SPEC.embedded.npz.
        settings: other values for constants.
        names: names of inputs in the files: {"gripper": "action[6]"}.
        groups: a pattern for the groups of .h5 files that are recordings: "data/*".
        camera: the camera of a data set, or the array of images; {"z": "top"} for one input only.
        shard: (1, 3) makes episodes of the first of three shards of the recordings.
        write_reference: a folder for the reference frames, which `Monitor.encoder_agrees` is about.
        onnxruntime: the library that runs the spec's networks, or its folder; by default
            the one of the environment, pip, npm or the system.
        encoder_command: a command that encodes (docs/recordings.md), in place of the network.
        encoder_timeout: stop an encoder that does nothing for this many seconds.
        encoder: what encodes, in this process, in place of the spec's network: a function from an
            image, uint8 (rows, columns, 3), to a vector of floats, such as one that calls a model
            of torch; or one for each encoder of the spec, by name. The file that the spec names
            keeps a hash of the model; another model is refused (docs/recordings.md).
        warnings_are_errors: whether a warning fails the command.

    Returns:
        The output; its `path` is the folder of episodes, or the file of embeddings.

    Raises:
        SpecError: the command failed; the message gives the reason. E1016: etlc was installed
            without `etlc embed`, or ONNX Runtime is missing. E1017: `encoder` is another model.
        InputError: an argument is invalid.
    """
    given = locals()
    models = given.pop("encoder")
    words = words_of("embed", given)
    ran = run(words) if models is None else embed_here(spec, models, given)
    path = output_of(spec, output or embedded, ".embedded.npz")
    return Written(path, ran.report, ran.diagnostics)


@checks_names
def merge(parts: FilePaths, output: FilePath) -> Written:
    """Combines the parts of a result, which calls with `shard` wrote.

    Args:
        parts: the files of all parts, in any order.
        output: the file of the result: thresholds, or the figures of `evaluate` as JSON.

    Raises:
        SpecError: a part is missing or damaged, or the parts are those of different calls.
    """
    ran = run(words_of("merge", locals()))
    return Written(output_of(output, output, ""), ran.report, ran.diagnostics)
