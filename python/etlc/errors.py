"""What goes wrong: exceptions with the words, and the diagnostics, of etlc."""

from __future__ import annotations

import json
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Diagnostic:
    """One finding of etlc.

    Attributes:
        code: as in docs/diagnostics.md, "E0204".
        severity: "error", "warning" or "note".
        message: what was found and what was expected.
        file: the spec, or another file that it names.
        line, column: from 1; 0 where they are not known.
        notes: more about it.
    """

    code: str
    severity: str
    message: str
    file: str = ""
    line: int = 0
    column: int = 0
    notes: tuple[str, ...] = field(default=())


def diagnostics_of(text: str | bytes) -> list[Diagnostic]:
    """The diagnostics in what `etlc --diagnostics json` prints; none where it is something else."""
    try:
        found = json.loads(text)["diagnostics"]
    except (ValueError, KeyError, TypeError):
        return []
    return [
        Diagnostic(
            one["code"], one["severity"], one["message"], one.get("file") or "",
            one.get("line") or 0, one.get("column") or 0,
            tuple(note["message"] for note in one.get("notes", [])),
        )
        for one in found
    ]  # fmt: skip


class Error(Exception):
    """What etlc refuses. All exceptions of this package are of this class."""


class SpecError(Error):
    """A spec, or what it names, that does not compile; or a command that failed.

    Attributes:
        diagnostics: the findings, in the order of their places.
    """

    def __init__(self, message: str, diagnostics: list[Diagnostic] | None = None) -> None:
        super().__init__(message)
        self.diagnostics: list[Diagnostic] = diagnostics or []


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
