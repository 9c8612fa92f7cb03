"""Exceptions and warnings, with the messages and diagnostics of etlc."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

import json
import os
import sys
import warnings
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Diagnostic:
    """One diagnostic of etlc.

    Attributes:
        code: the code, "E0204"; docs/diagnostics.md lists all codes.
        severity: "error", "warning" or "note".
        message: what was found and what was expected.
        file: the spec, or a file that it names.
        line, column: counted from 1; 0 if unknown.
        notes: further messages, each with its place if that is a different one.
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
    """Parses the output of `etlc --diagnostics json`; returns none if it is something else."""
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
    place = _place(note.get("file") or "", line, column) if line else ""
    return place + str(note["message"])


class Error(Exception):
    """The base class of all exceptions of this package."""


class SpecError(Error):
    """A spec, or a file that it names, does not compile; or a command failed.

    Attributes:
        diagnostics: the diagnostics in the order of their places, each with its notes.
    """

    def __init__(self, message: str, diagnostics: list[Diagnostic] | None = None) -> None:
        super().__init__(message)
        self.diagnostics: list[Diagnostic] = diagnostics or []

    @property
    def notes(self) -> list[str]:
        """The notes of all diagnostics."""
        return [note for one in self.diagnostics for note in one.notes]


class InputError(Error, ValueError):
    """The spec does not have or accept this sample, option or name."""


class ClosedError(Error):
    """The monitor is closed, or its episode has ended."""


class BusyError(Error):
    """Another thread is in a call of the monitor."""


class NotKeptError(Error):
    """The monitor was not opened with the option that keeps this."""


class UndecidedError(Error):
    """The monitor has no verdict yet."""


class AmbiguousError(Error, ValueError):
    """A result without a truth value, such as a verdict, was used as one: `if verdict`."""


class EtlcWarning(UserWarning):
    """A warning of etlc about something that is hardly intended.

    Attributes:
        diagnostic: the diagnostic; None if the warning is about the samples of `run`.
    """

    def __init__(self, message: str, diagnostic: Diagnostic | None = None) -> None:
        super().__init__(message)
        self.diagnostic = diagnostic


_PACKAGE = os.path.dirname(__file__)


def warn(warning: EtlcWarning) -> None:
    """Issues a warning at the line that called this package."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == _PACKAGE:
        level, frame = level + 1, frame.f_back
    warnings.warn(warning, stacklevel=level)


def warn_of(diagnostics: list[Diagnostic]) -> None:
    """Issues each warning among the diagnostics."""
    for one in diagnostics:
        if one.severity == "warning":
            warn(EtlcWarning(str(one), one))
