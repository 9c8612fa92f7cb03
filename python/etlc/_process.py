"""Runs the program etlc, and reads what it says."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Iterable, Mapping

from ._library import own
from .errors import Diagnostic, Error, EtlcWarning, InputError, SpecError
from .errors import diagnostics_of, warn, warn_of

_WRONG_CALL = 2


@dataclass(frozen=True)
class Ran:
    """What a command printed, and its warnings."""

    report: str
    diagnostics: tuple[Diagnostic, ...]


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


def started(
    words: Iterable[bytes],
    variables: Mapping[str, str] | None = None,
    stdin: int | None = None,
    stderr: int | IO[bytes] = subprocess.PIPE,
) -> subprocess.Popen[bytes]:
    """Starts etlc with these words and streams, and returns the process.

    `variables` are added to its environment.
    """
    command = command_path()
    try:
        return subprocess.Popen(
            [os.fsencode(command), *words], env={**os.environ, **(variables or {})}, stdin=stdin,
            stdout=subprocess.PIPE, stderr=stderr,
        )  # fmt: skip
    except OSError as error:
        raise Error(f"{command} cannot be run: {error}") from None


def run(
    words: Iterable[bytes], quiet: bool = False, variables: Mapping[str, str] | None = None
) -> Ran:
    """Runs etlc with these words. A failure raises, and a warning is one of Python.

    `quiet`: an earlier call has issued the same warnings.
    """
    with started(words, variables) as process:
        try:
            printed, said = process.communicate()
        except BaseException:  # Ctrl-C, for example
            process.kill()
            raise
    return concluded(process.returncode, printed, said, quiet)


def concluded(status: int, printed: bytes, said: bytes, quiet: bool = False) -> Ran:
    """Returns what a process that has ended said, or raises what is wrong."""
    found, others = _separated(said)
    if status == _WRONG_CALL and not found:
        raise InputError(_in_words_of_python(others))
    if status != 0:
        errors = [one for one in found if one.severity == "error"] or found
        text = "\n".join(map(str, errors))
        raise SpecError(text or others or f"etlc ended with {status}", found)
    if not quiet:
        warn_of(found)
    if others and not quiet:
        warn(EtlcWarning(others))
    return Ran(printed.decode(errors="replace"), tuple(found))


def _in_words_of_python(text: str) -> str:
    """Returns the message about a wrong call without what is for the command line only."""
    lines = [line for line in text.splitlines() if not line.startswith("Run etlc")]
    return "\n".join(lines).removeprefix("etlc: ")


def _separated(stderr: bytes) -> tuple[list[Diagnostic], str]:
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
