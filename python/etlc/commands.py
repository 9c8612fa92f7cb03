"""The commands of etlc themselves, run as processes: `calibrate`, `embed`, `evaluate`, ..."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable, Mapping, Union

from ._library import NATIVE
from .errors import Diagnostic, Error, SpecError, diagnostics_of

Paths = Union[str, "os.PathLike[str]", Iterable[Union[str, "os.PathLike[str]"]]]


@dataclass(frozen=True)
class Written:
    """What a command made.

    Attributes:
        path: of the file that it wrote.
        report: what it says about it, for people.
        diagnostics: what it warned of.
    """

    path: Path
    report: str
    diagnostics: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True)
class Evaluation:
    """How good monitors are.

    Attributes:
        data: for programs, as `etlc evaluate --json` has it (docs/evaluation.md).
        report: for people.
        diagnostics: what it warned of.
    """

    data: dict[str, Any]
    report: str
    diagnostics: tuple[Diagnostic, ...] = ()


def command_path() -> str:
    """The command: $ETLC_COMMAND, the one in this package, or the one in the path.

    Raises:
        Error: there is none.
    """
    own = NATIVE / "bin" / "etlc"
    path = os.environ.get("ETLC_COMMAND") or (str(own) if own.exists() else shutil.which("etlc"))
    if path is None:
        raise Error("there is no etlc: install it, or name it in ETLC_COMMAND")
    return path


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
    allow_overlap: str | None = None,
    folds: int | None = None,
    jobs: int | None = None,
) -> Written:
    """Finds the calibrated thresholds of a spec from labelled demonstrations.

    Args:
        spec: the path of the spec.
        data: episodes: files (.csv, .npz, .h5), folders or patterns.
        output: the file of thresholds; by default SPEC.thresholds.json beside the spec.
        thresholds: those of the predicates, to calibrate monitors as a whole.
        fitted: what `fit` found; by default SPEC.fitted.npz beside the spec.
        settings: other values for constants.
        names: what inputs are called in the files: {"z": "obs/z"}.
        groups: of .h5 files that are episodes: "data/*".
        allow_overlap: why episodes may share most of their content.
        folds: also say what the thresholds would be without each of so many folds.
        jobs: threads; by default as many as the machine has.

    Raises:
        SpecError: the command failed, and says why.
    """
    path = _output(spec, output, ".thresholds.json")
    ran = _run(
        "calibrate", [spec], data, settings, names,
        {"-o": path, "--thresholds": thresholds, "--fitted": fitted, "--episodes": groups,
         "--allow-overlap": allow_overlap, "--folds": folds, "--jobs": jobs},
    )  # fmt: skip
    return Written(path, ran.stdout, tuple(diagnostics_of(ran.stderr)))


def fit(
    spec: str | os.PathLike[str],
    data: Paths,
    *,
    output: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    allow_overlap: str | None = None,
    jobs: int | None = None,
) -> Written:
    """Finds what a spec declares `fitted(...)` from labelled demonstrations.

    Args:
        spec: the path of the spec.
        data: episodes: files (.csv, .npz, .h5), folders or patterns.
        output: the file of what is fitted; by default SPEC.fitted.npz beside the spec.
        settings, names, groups, allow_overlap, jobs: as `calibrate`.

    Raises:
        SpecError: the command failed, and says why.
    """
    path = _output(spec, output, ".fitted.npz")
    ran = _run(
        "fit", [spec], data, settings, names,
        {"-o": path, "--episodes": groups, "--allow-overlap": allow_overlap, "--jobs": jobs},
    )  # fmt: skip
    return Written(path, ran.stdout, tuple(diagnostics_of(ran.stderr)))


def evaluate(
    specs: Paths,
    data: Paths,
    *,
    thresholds: str | os.PathLike[str] | None = None,
    fitted: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    allow_overlap: str | None = None,
    folds: int | None = None,
    by_episode: bool = False,
    jobs: int | None = None,
) -> Evaluation:
    """Compares predicates and monitors with ground truth on recorded episodes.

    Args:
        specs: the path of the spec, or of several, which are set side by side.
        data: episodes: files (.csv, .npz, .h5), folders or patterns.
        thresholds, fitted: of the spec; by default beside it.
        folds: calibrate on all folds but one and evaluate on that, in turn.
        by_episode: also each episode, the worst first.
        settings, names, groups, allow_overlap, jobs: as `calibrate`.

    Raises:
        SpecError: the command failed, and says why.
    """
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "evaluation.json"
        ran = _run(
            "evaluate", _paths(specs), data, settings, names,
            {"--json": path, "--thresholds": thresholds, "--fitted": fitted, "--episodes": groups,
             "--allow-overlap": allow_overlap, "--folds": folds, "--jobs": jobs},
            ["--by-episode"] if by_episode else [],
        )  # fmt: skip
        found = json.loads(path.read_text())
    return Evaluation(found, ran.stdout, tuple(diagnostics_of(ran.stderr)))


def embed(
    spec: str | os.PathLike[str],
    data: Paths | None = None,
    *,
    output: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
    onnxruntime: str | os.PathLike[str] | None = None,
    encoder_command: str | None = None,
    encoder_timeout: int | None = None,
) -> Written:
    """Encodes the images that a spec names, and recordings into episodes.

    Args:
        spec: the path of the spec. The embeddings of its targets go into SPEC.embedded.npz beside
            it.
        data: recordings to make episodes of: videos, folders of images, patterns.
        output: the folder where the episodes go; given with `data`.
        settings: other values for constants.
        onnxruntime: what runs the spec's networks: the library, or a folder that has it; without it
            the one that the environment, pip, npm or the system has.
        encoder_command: a command that encodes (docs/encoders.md), in place of the spec's network.
        encoder_timeout: seconds after which an encoder that does nothing is stopped.

    Returns:
        Its `path` is the folder of episodes, or the file of embeddings.

    Raises:
        SpecError: the command failed, and says why: E1016 where etlc was installed without it,
            or where there is no ONNX Runtime.
    """
    ran = _run(
        "embed", [spec], data, settings, None,
        {"-o": output, "--onnxruntime": onnxruntime, "--encoder-cmd": encoder_command,
         "--encoder-timeout": encoder_timeout},
    )  # fmt: skip
    path = _output(spec, output, ".embedded.npz")
    return Written(path, ran.stdout, tuple(diagnostics_of(ran.stderr)))


def incident(
    spec: str | os.PathLike[str],
    data: bytes | str | os.PathLike[str],
    *,
    form: str = "table",
    thresholds: str | os.PathLike[str] | None = None,
    fitted: str | os.PathLike[str] | None = None,
    settings: Mapping[str, object] | None = None,
) -> str:
    """Reads what the flight recorder of a monitor kept: the steps around an alarm.

    Args:
        spec: the path of the spec.
        data: one of `Monitor.incidents`, or the path of a file.
        form: "table", "csv", "trace" or "spec" (docs/data.md).
        thresholds, fitted, settings: what the monitor was opened with.

    Raises:
        SpecError: it is damaged, or of another spec.
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
    return ran.stdout


def _place(found: Diagnostic) -> str:
    if not found.file:
        return ""
    return f"{found.file}:{found.line}:{found.column}: " if found.line else f"{found.file}: "


def _paths(paths: Paths) -> list[str]:
    one = isinstance(paths, (str, os.PathLike))
    return [os.fspath(path) for path in ([paths] if one else paths)]  # type: ignore[list-item]


def _output(
    spec: str | os.PathLike[str], output: str | os.PathLike[str] | None, ending: str
) -> Path:
    return Path(spec).with_suffix(ending) if output is None else Path(output)


def _run(
    name: str,
    specs: Iterable[str | os.PathLike[str]],
    data: Paths | None,
    settings: Mapping[str, object] | None,
    names: Mapping[str, str] | None,
    options: Mapping[str, object],
    flags: Iterable[str] = (),
) -> subprocess.CompletedProcess[str]:
    words = [command_path(), name, *(os.fspath(spec) for spec in specs), "--diagnostics", "json"]
    words += [f"--set={key}={value}" for key, value in (settings or {}).items()]
    words += [f"--map={key}={value}" for key, value in (names or {}).items()]
    for option, value in options.items():
        if value is not None:
            words += [option, os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
    words += [*flags, *(["--data", *_paths(data)] if data is not None else [])]
    try:
        ran = subprocess.run(words, capture_output=True, text=True, check=False)
    except OSError as error:
        raise Error(f"{words[0]} cannot be run: {error}") from None
    if ran.returncode == 0:
        return ran
    found = diagnostics_of(ran.stderr)
    errors = [one for one in found if one.severity == "error"] or found
    said = "\n".join(f"{_place(one)}{one.message} [{one.code}]" for one in errors)
    raise SpecError(said or ran.stderr.strip() or f"etlc ended with {ran.returncode}", found)
