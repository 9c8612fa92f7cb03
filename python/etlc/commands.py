"""Runs commands of etlc as processes: `calibrate`, `embed`, `evaluate`, ..."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable, Mapping, Union

from ._ambiguous import Ambiguous
from ._library import encoded, encoded_path, own
from .errors import Diagnostic, Error, EtlcWarning, SpecError, diagnostics_of, warn, warn_of

Paths = Union[str, "os.PathLike[str]", Iterable[Union[str, "os.PathLike[str]"]]]


@dataclass(frozen=True)
class Written:
    """The output of a command. Always true.

    Attributes:
        path: the file that the command wrote.
        report: the printed report, for people.
        diagnostics: the warnings.
    """

    path: Path
    report: str
    diagnostics: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True, eq=False)
class Evaluation(Ambiguous):
    """The result of `evaluate`.

    Its truth value raises AmbiguousError.

    Attributes:
        data: the figures of `etlc evaluate --json`, for programs (docs/evaluation.md).
        report: the printed tables, for people.
        diagnostics: the warnings.
    """

    data: dict[str, Any]
    report: str
    diagnostics: tuple[Diagnostic, ...] = ()

    _ask = "its .data or .report"


def command_path() -> str:
    """Returns $ETLC_COMMAND, the command installed with this package, or the one in the path.

    Raises:
        Error: none of these exists.
    """
    path: str | Path | None = os.environ.get("ETLC_COMMAND") or own("COMMAND", "bin/etlc")
    path = path or shutil.which("etlc")
    if path is None:
        raise Error("there is no etlc: install it, or name it in ETLC_COMMAND")
    return os.fspath(path)


def calibrate(
    spec: str | os.PathLike[str],
    data: Paths,
    *,
    output: str | os.PathLike[str] | None = None,
    thresholds: str | os.PathLike[str] | None = None,
    fitted: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    labels: Paths | None = None,
    label_by: str | None = None,
    allow_overlap: str | None = None,
    folds: int | None = None,
    jobs: int | None = None,
) -> Written:
    """Finds the calibrated thresholds of a spec from labelled demonstrations.

    Args:
        spec: the path of the spec.
        data: episodes: files (.csv, .npz, .h5), folders or patterns.
        output: the file of thresholds; by default SPEC.thresholds.json beside the spec.
        thresholds: a file with the thresholds of the predicates, to calibrate monitors as a whole.
        fitted: the file of `fit`; by default SPEC.fitted.npz beside the spec.
        settings: other values for constants.
        names: names of inputs in the files: {"z": "obs/z"}.
        groups: a pattern for the groups of .h5 files that are episodes: "data/*".
        labels: tables of labels (.csv); by default labels.csv beside the episodes, if it exists.
        label_by: "folder" labels each episode with the name of its folder.
        allow_overlap: the reason why episodes may share most of their content.
        folds: also report the thresholds without each of this many folds.
        jobs: the number of threads; by default that of the machine.

    Raises:
        SpecError: the command failed; the message gives the reason.
    """
    path = _output(spec, output, ".thresholds.json")
    ran = _run(
        "calibrate", [spec], data, settings, names,
        {"-o": path, "--thresholds": thresholds, "--fitted": fitted, "--episodes": groups,
         "--labels": labels, "--label-by": label_by, "--allow-overlap": allow_overlap,
         "--folds": folds, "--jobs": jobs},
    )  # fmt: skip
    return Written(path, ran.report, ran.diagnostics)


def fit(
    spec: str | os.PathLike[str],
    data: Paths,
    *,
    output: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    labels: Paths | None = None,
    label_by: str | None = None,
    allow_overlap: str | None = None,
    jobs: int | None = None,
) -> Written:
    """Computes everything that a spec declares as `fitted(...)` from labelled demonstrations.

    Args:
        spec: the path of the spec.
        data: episodes: files (.csv, .npz, .h5), folders or patterns.
        output: the file of the fit; by default SPEC.fitted.npz beside the spec.
        settings, names, groups, labels, label_by, allow_overlap, jobs: as in `calibrate`.

    Raises:
        SpecError: the command failed; the message gives the reason.
    """
    path = _output(spec, output, ".fitted.npz")
    ran = _run(
        "fit", [spec], data, settings, names,
        {"-o": path, "--episodes": groups, "--labels": labels, "--label-by": label_by,
         "--allow-overlap": allow_overlap, "--jobs": jobs},
    )  # fmt: skip
    return Written(path, ran.report, ran.diagnostics)


def evaluate(
    specs: Paths,
    data: Paths,
    *,
    thresholds: str | os.PathLike[str] | None = None,
    fitted: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    labels: Paths | None = None,
    label_by: str | None = None,
    allow_overlap: str | None = None,
    folds: int | None = None,
    by_episode: bool = False,
    jobs: int | None = None,
) -> Evaluation:
    """Compares predicates and monitors with ground truth on recorded episodes.

    Args:
        specs: the path of the spec, or of several, which are compared side by side.
        data: episodes: files (.csv, .npz, .h5), folders or patterns.
        thresholds, fitted: files for the spec; by default those beside it.
        folds: calibrate on all folds but one and evaluate on that one, in turn.
        by_episode: also report each episode, the worst first.
        settings, names, groups, labels, label_by, allow_overlap, jobs: as in `calibrate`.

    Raises:
        SpecError: the command failed; the message gives the reason.
    """
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "evaluation.json"
        ran = _run(
            "evaluate", _paths(specs), data, settings, names,
            {"--json": path, "--thresholds": thresholds, "--fitted": fitted, "--episodes": groups,
             "--labels": labels, "--label-by": label_by, "--allow-overlap": allow_overlap,
             "--folds": folds, "--jobs": jobs},
            ["--by-episode"] if by_episode else [],
        )  # fmt: skip
        found = json.loads(path.read_text(encoding="utf-8"))
    return Evaluation(found, ran.report, ran.diagnostics)


def embed(
    spec: str | os.PathLike[str],
    data: Paths | None = None,
    *,
    output: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
    write_reference: str | os.PathLike[str] | None = None,
    onnxruntime: str | os.PathLike[str] | None = None,
    encoder_command: str | None = None,
    encoder_timeout: int | None = None,
) -> Written:
    """Encodes the images that a spec names, and recordings into episodes.

    Args:
        spec: the path of the spec. The embeddings of its targets go into SPEC.embedded.npz beside
            it.
        data: recordings to turn into episodes: videos, folders of images, patterns.
        output: the folder for the episodes; required with `data`.
        settings: other values for constants.
        write_reference: a folder for the reference frames, which `Monitor.encoder_agrees` is about.
        onnxruntime: the library that runs the spec's networks, or its folder; by default
            the one of the environment, pip, npm or the system.
        encoder_command: a command that encodes (docs/encoders.md), in place of the spec's network.
        encoder_timeout: stop an encoder that does nothing for this many seconds.

    Returns:
        The output; its `path` is the folder of episodes, or the file of embeddings.

    Raises:
        SpecError: the command failed; the message gives the reason. E1016: etlc was installed
            without `etlc embed`, or ONNX Runtime is missing.
    """
    ran = _run(
        "embed", [spec], data, settings, None,
        {"-o": output, "--write-reference": write_reference, "--onnxruntime": onnxruntime,
         "--encoder-cmd": encoder_command, "--encoder-timeout": encoder_timeout},
    )  # fmt: skip
    path = _output(spec, output, ".embedded.npz")
    return Written(path, ran.report, ran.diagnostics)


def incident(
    spec: str | os.PathLike[str],
    data: bytes | str | os.PathLike[str],
    *,
    form: str = "table",
    thresholds: str | os.PathLike[str] | None = None,
    fitted: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
) -> str:
    """Prints an incident of a monitor's flight recorder: the steps around an alarm.

    Args:
        spec: the path of the spec.
        data: one of `Monitor.incidents`, or the path of a file.
        form: "table", "csv", "trace" or "spec" (docs/data.md).
        thresholds, fitted, settings: the arguments that the monitor was opened with.

    Raises:
        SpecError: the incident is damaged, or belongs to another spec.
    """
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "incident"
        if isinstance(data, bytes):
            path.write_bytes(data)
        else:
            path = Path(data)
        ran = _run(
            "incident", [path], None, settings, None,
            {"--spec": spec, "--format": form, "--thresholds": thresholds, "--fitted": fitted},
        )  # fmt: skip
    return ran.report


def _paths(paths: Paths) -> list[str | bytes | os.PathLike[str]]:
    one = isinstance(paths, (str, bytes, os.PathLike))
    return [paths] if one else list(paths)  # type: ignore[list-item, arg-type]


def _output(
    spec: str | os.PathLike[str], output: str | os.PathLike[str] | None, ending: str
) -> Path:
    return Path(spec).with_suffix(ending) if output is None else Path(output)


@dataclass(frozen=True)
class _Ran:
    report: str
    diagnostics: tuple[Diagnostic, ...]


def _run(
    name: str,
    specs: Iterable[str | bytes | os.PathLike[str]],
    data: Paths | None,
    settings: Mapping[str, object] | None,
    names: Mapping[str, str] | None,
    options: Mapping[str, Any],
    flags: Iterable[str] = (),
) -> _Ran:
    command = command_path()
    words = [os.fsencode(command), name.encode(), *(encoded_path("spec", spec) for spec in specs)]
    words += [b"--diagnostics", b"json"]
    words += [encoded("settings", f"--set={key}={to}") for key, to in (settings or {}).items()]
    words += [encoded("names", f"--map={key}={to}") for key, to in (names or {}).items()]
    for option, value in options.items():
        if option == "--labels" and value is not None:
            words += [b"--labels", *(encoded_path("labels", path) for path in _paths(value))]
        elif value is not None:
            path = value if isinstance(value, (str, bytes, os.PathLike)) else str(value)
            words += [option.encode(), encoded_path(option.lstrip("-"), path)]
    words += [flag.encode() for flag in flags]
    if data is not None:
        words += [b"--data", *(encoded_path("data", path) for path in _paths(data))]
    try:
        ran = subprocess.run(words, capture_output=True, check=False)
    except OSError as error:
        raise Error(f"{command} cannot be run: {error}") from None
    found, others = _said(ran.stderr)
    if ran.returncode != 0:
        errors = [one for one in found if one.severity == "error"] or found
        said = "\n".join(map(str, errors))
        raise SpecError(said or others or f"etlc ended with {ran.returncode}", found)
    warn_of(found)
    if others:
        warn(EtlcWarning(others))
    return _Ran(ran.stdout.decode(errors="replace"), tuple(found))


def _said(stderr: bytes) -> tuple[list[Diagnostic], str]:
    """Separates the diagnostics from output of libraries that etlc loads."""
    text = stderr.decode(errors="replace")
    begin = text.find('{\n  "diagnostics"')
    if begin < 0:
        return [], text.strip()
    try:
        _, end = json.JSONDecoder().raw_decode(text, begin)
    except ValueError:
        return [], text.strip()
    return diagnostics_of(text[begin:end]), (text[:begin] + text[end:]).strip()
