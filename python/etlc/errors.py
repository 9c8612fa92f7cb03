"""What goes wrong: exceptions with the words, and the diagnostics, of etlc."""

from __future__ import annotations

import json
import os
import sys
import warnings
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Diagnostic:
    """One finding of etlc.

    Attributes:
        code: as in docs/diagnostics.md, "E0204".
        severity: "error", "warning" or "note".
        message: what was found and what was expected.
        file: the spec, or another file that it names.
        line, column: from 1; 0 where they are not known.
        notes: more about it, each behind its place where it is about another one.
    """

    code: str
    severity: str
    message: str
    file: str = ""
    line: int = 0
    column: int = 0
    notes: tuple[str, ...] = field(default=())

    def __str__(self) -> str:
        place = _place(self.file, self.line, self.column)
        lines = [f"{place}{self.severity}: {self.message} [{self.code}]"]
        return "\n  note: ".join(lines + list(self.notes))


def _place(file: str, line: int, column: int) -> str:
    if not file:
        return ""
    return f"{file}:{line}:{column}: " if line else f"{file}: "


def diagnostics_of(text: str | bytes) -> list[Diagnostic]:
    """The diagnostics in what `etlc --diagnostics json` prints; none where it is something else."""
    if isinstance(text, bytes):
        text = text.decode(errors="replace")
    try:
        found = json.loads(text)["diagnostics"]
    except (ValueError, KeyError, TypeError):
        return []
    return [
        Diagnostic(
            one["code"], one["severity"], one["message"], one.get("file") or "",
            one.get("line") or 0, one.get("column") or 0,
            tuple(_note(note) for note in one.get("notes", [])),
        )
        for one in found
    ]  # fmt: skip


def _note(note: dict[str, Any]) -> str:
    line, column = note.get("line") or 0, note.get("column") or 0
    return (_place(note.get("file") or "", line, column) if line else "") + note["message"]


class Error(Exception):
    """What etlc refuses. All exceptions of this package are of this class."""


class SpecError(Error):
    """A spec, or what it names, that does not compile; or a command that failed.

    Attributes:
        diagnostics: the findings, in the order of their places, each with its notes.
    """

    def __init__(self, message: str, diagnostics: list[Diagnostic] | None = None) -> None:
        super().__init__(message)
        self.diagnostics: list[Diagnostic] = diagnostics or []

    @property
    def notes(self) -> list[str]:
        """Of all diagnostics."""
        return [note for one in self.diagnostics for note in one.notes]


class InputError(Error, ValueError):
    """A sample, an option or a name that the spec does not know or cannot take."""


class ClosedError(Error):
    """A monitor that was closed, or whose episode has ended."""


class BusyError(Error):
    """A monitor that another thread is in a call of."""


class NotKeptError(Error):
    """What the monitor was not asked to keep when it was opened."""


class UndecidedError(Error):
    """A monitor that says nothing yet."""


class AmbiguousError(Error, ValueError):
    """What is no answer by itself, such as a verdict, was taken for one: `if verdict`."""


class EtlcWarning(UserWarning):
    """What is surely not meant.

    Attributes:
        diagnostic: the finding of etlc; None: it is about the samples of `run`.
    """

    def __init__(self, message: str, diagnostic: Diagnostic | None = None) -> None:
        super().__init__(message)
        self.diagnostic = diagnostic


_PACKAGE = os.path.dirname(__file__)


def warn(warning: EtlcWarning) -> None:
    """A warning about the line that called this package."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == _PACKAGE:
        level, frame = level + 1, frame.f_back
    warnings.warn(warning, stacklevel=level)


def warn_of(diagnostics: list[Diagnostic]) -> None:
    """Of each warning among them."""
    for one in diagnostics:
        if one.severity == "warning":
            warn(EtlcWarning(str(one), one))
