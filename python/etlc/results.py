"""The results of commands."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import _frames, _html
from ._ambiguous import Ambiguous
from ._types import Array
from .errors import Diagnostic
from .arrays import Episode


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
class Checked(Ambiguous):
    """The result of `check`: the spec compiles.

    Its truth value raises AmbiguousError.

    Attributes:
        diagnostics: the warnings, and notes about files that do not exist yet.
    """

    diagnostics: tuple[Diagnostic, ...] = ()

    _ask = "its .diagnostics"


@dataclass(frozen=True, eq=False)
class Evaluation(Ambiguous):
    """The result of `evaluate` and `crossvalidate`.

    Its truth value raises AmbiguousError.

    Attributes:
        data: the figures of `etlc evaluate --json`, for programs (docs/calibration.md); empty for
            a shard, whose part of the result is a file.
        report: the printed tables, for people.
        diagnostics: the warnings.
    """

    data: dict[str, Any]
    report: str
    diagnostics: tuple[Diagnostic, ...] = ()

    _ask = "its .data or .report"

    def __str__(self) -> str:
        """Returns the tables."""
        return self.report

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame: a row for each predicate by frames, and for each monitor by
        steps and by episodes, with the bounds of 95 % intervals.

        Raises:
            ImportError: pandas is not installed.
        """
        return _frames.frame_of_figures(self.data)

    def plot(self) -> Any:
        """Draws the figures with their 95 % intervals: a matplotlib.figure.Figure.

        Raises:
            ImportError: matplotlib is not installed.
        """
        return _frames.plot_figures(self.data)

    def _repr_html_(self) -> str:
        """Returns small tables, for notebooks."""
        rows = list(_frames.figures(self.data))
        if not rows:
            return _html.preformatted(self.report)
        head = [name for name in rows[0] if not name.endswith(("_low", "_high"))]
        cells = ([_cell(row, name) for name in head] for row in rows)
        return _html.table(head, cells, "in brackets: 95 % intervals")


def _cell(row: dict[str, Any], name: str) -> str:
    """Returns "0.806 [0.652, 0.886]" for a figure."""
    if f"{name}_low" not in row:
        return str(row[name])
    shown = _html.number(row[name])
    low, high = row[f"{name}_low"], row[f"{name}_high"]
    return shown if low is None else f"{shown} [{low:.3g}, {high:.3g}]"


@dataclass(frozen=True, eq=False)
class Suggestions(Ambiguous):
    """The result of `suggest` and `propose`.

    Its truth value raises AmbiguousError.

    Attributes:
        data: what the command prints as JSON (docs/fitting.md, docs/labelling.md).
        diagnostics: the warnings.
    """

    data: dict[str, Any]
    diagnostics: tuple[Diagnostic, ...] = ()

    _ask = "its .data"


@dataclass(frozen=True, eq=False)
class Run(Ambiguous):
    """The result of `run`: verdicts on a recorded trace.

    Its truth value raises AmbiguousError.

    Attributes:
        episode: the verdicts of each monitor at each step, with the distances that were asked for.
        positions: int64 (N steps, M monitors), the step that each verdict is about; -1: undecided.
        lets: by name, float32 (N,), the robustness of each let that was asked for.
        summary: a line for each monitor, for people.
        diagnostics: the warnings.
    """

    episode: Episode
    positions: Array
    lets: dict[str, Array] = field(default_factory=lambda: dict[str, Array]())
    summary: str = ""
    diagnostics: tuple[Diagnostic, ...] = ()

    _ask = "its .episode or .summary"

    __hash__ = None  # type: ignore[assignment]

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with the columns of the CSV of `etlc run`.

        Raises:
            ImportError: pandas is not installed.
        """
        frame = self.episode.to_pandas()
        frame["position"] = self.positions.reshape(-1)
        for name, values in self.lets.items():
            frame[f"robustness_{name}"] = values.repeat(len(self.episode.monitors))
        return frame

    def plot(self) -> Any:
        """Draws the distances and the verdicts: a matplotlib.figure.Figure.

        Raises:
            ImportError: matplotlib is not installed.
        """
        return self.episode.plot()

    def _repr_html_(self) -> str:
        """Returns the summary and the timelines, for notebooks."""
        return _html.preformatted(self.summary) + self.episode._repr_html_()

    def _content(self) -> tuple[Any, ...]:
        lets = [(name, values.tobytes()) for name, values in self.lets.items()]
        return self.episode._content(), self.positions.tobytes(), lets, self.summary


@dataclass(frozen=True)
class Proof:
    """The result of `prove`: the class is right on all inputs of so many steps. Always true: a
    class that is not proved raises SpecError.

    Attributes:
        certificate: what was proved, and from what, in words.
        diagnostics: the warnings.
    """

    certificate: str
    diagnostics: tuple[Diagnostic, ...] = ()

    def __str__(self) -> str:
        """Returns the certificate."""
        return self.certificate
