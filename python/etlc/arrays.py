"""The verdicts of monitors as arrays: for an episode, and for many environments."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

from typing import Any, Generic, Iterator, Mapping, TypeVar

import numpy as np

from . import _frames, _html, _timeline
from ._ambiguous import Ambiguous
from ._library import ALARM, DECIDED, FINAL, FULFILLED, SATISFIED, VIOLATED
from ._types import Array, untyped
from .errors import InputError
from .names import is_text, no_such
from .verdicts import Verdict, contains, verdict_of

VERDICT_DTYPE = np.dtype(
    [("robustness", "f4"), ("lower", "f4"), ("upper", "f4"), ("status", "u4")]
)


class VerdictArrays(Ambiguous):
    """The verdicts of one monitor, as arrays: of a batch at a step, or at all steps of a run.

    Its truth value raises AmbiguousError: use `alarm.any()`.

    Attributes:
        name: the name of the monitor.
        robustness, lower, upper: float32; NaN where undecided.
    """

    __hash__ = None  # type: ignore[assignment]
    _ask = "its .alarm.any(), .satisfied, .violated, ..."

    def __init__(self, name: str, table: Array) -> None:
        self.name = name
        self.robustness: Array = table["robustness"]
        self.lower: Array = table["lower"]
        self.upper: Array = table["upper"]
        self._status: Array = table["status"]
        self._table = table

    @property
    def bounds(self) -> tuple[Array, Array]:
        """(lower, upper)."""
        return self.lower, self.upper

    @property
    def alarm(self) -> Array:
        """bool: violated for good."""
        return self._has(ALARM)

    @property
    def fulfilled(self) -> Array:
        """bool: satisfied for good."""
        return self._has(FULFILLED)

    @property
    def satisfied(self) -> Array:
        """bool."""
        return self._has(SATISFIED)

    @property
    def violated(self) -> Array:
        """bool."""
        return self._has(VIOLATED)

    @property
    def decided(self) -> Array:
        """bool."""
        return self._has(DECIDED)

    @property
    def unknown(self) -> Array:
        """bool: a missing sample leaves it open."""
        return self._has(DECIDED, among=DECIDED | SATISFIED | VIOLATED)

    @property
    def final(self) -> Array:
        """bool."""
        return self._has(FINAL)

    def _has(self, bits: int, among: int | None = None) -> Array:
        """Returns where these bits are set, and of `among` no others."""
        found: Array = (self._status & (bits if among is None else among)) == bits
        return found

    @property
    def status(self) -> Array:
        """str: "satisfied", "violated", "unknown" or "undecided"."""
        places = [~self.decided, self.satisfied, self.violated]
        return np.select(places, ["undecided", "satisfied", "violated"], "unknown")

    def __len__(self) -> int:
        return len(self._status)

    def _content(self) -> tuple[Any, ...]:
        numbers = (self.robustness, self.lower, self.upper, self._status)
        return self.name, self._status.shape, *(column.tobytes() for column in numbers)

    def _alarms(self) -> int:
        return int(np.count_nonzero(self.alarm))

    def _counted(self) -> str:
        return f"{self._alarms()} alarms"

    def __repr__(self) -> str:
        shape = " x ".join(map(str, self._status.shape))
        missing = int(np.count_nonzero(self.unknown))
        return f"<{self.name}: {shape} verdicts, {self._counted()}{_unknown(missing)}>"


class EpisodeVerdicts(VerdictArrays):
    """The verdicts of one monitor at every step of an episode, as arrays of N steps.

    Its truth value raises AmbiguousError: use `alarm.any()`.

    Attributes:
        name: the name of the monitor.
        robustness, lower, upper: float32; NaN where undecided.
    """

    _ask = "its .first_alarm, .alarm.any(), .satisfied[-1], .violated[-1], ..."

    def __getitem__(self, step: int) -> Verdict:
        """Returns the verdict of a step; the last one is -1.

        Raises:
            IndexError: there is no such step.
        """
        one = self._table[step]
        if np.ndim(one) != 0:
            raise IndexError(f"{step!r} is not one step: take them from .robustness, .status, ...")
        lower, upper, robustness = (float(one[key]) for key in ("lower", "upper", "robustness"))
        return verdict_of(self.name, lower, upper, robustness, int(one["status"]))

    @property
    def first_alarm(self) -> int | None:
        """The first step with an alarm, or None."""
        alarms = self.alarm
        return int(np.argmax(alarms)) if alarms.any() else None

    def _episode(self) -> Episode:
        """Returns an episode of this monitor alone."""
        return Episode((self.name,), self._table[:, np.newaxis])

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with a row for each step.

        Raises:
            ImportError: pandas is not installed.
        """
        return self._episode().to_pandas()

    def plot(self) -> Any:
        """Draws the robustness and its bounds over the steps: a matplotlib.figure.Figure.

        Raises:
            ImportError: matplotlib is not installed.
        """
        return self._episode().plot()

    def _repr_html_(self) -> str:
        """Returns a small table and the timeline, for notebooks."""
        return self._episode()._repr_html_()

    def __repr__(self) -> str:
        first = self.first_alarm
        said = "no alarm" if first is None else f"first alarm at step {first}"
        missing = _unknown(int(np.count_nonzero(self.unknown)))
        return f"<{self.name}: {len(self)} steps, {said}{missing}>"


class RunVerdicts(VerdictArrays):
    """The verdicts of one monitor for rows of steps: environments or plans.

    Its truth value raises AmbiguousError: use `alarm.any()`.

    Attributes:
        name: the name of the monitor.
        robustness, lower, upper: float32, the last axis is that of steps; NaN where undecided.
    """

    _ask = "its .first_alarm, .alarm.any(axis=-1), .satisfied[..., -1], .violated[..., -1], ..."

    @property
    def first_alarm(self) -> Array:
        """int, per row: the first step with an alarm; -1 where there is none."""
        alarms = self.alarm
        if alarms.shape[-1] == 0:
            return np.full(alarms.shape[:-1], -1)
        return np.where(alarms.any(axis=-1), alarms.argmax(axis=-1), -1)

    def _alarms(self) -> int:
        return int(np.count_nonzero(self.first_alarm >= 0))

    def _counted(self) -> str:
        return f"alarms in {self._alarms()} rows"


def _least(numbers: Array) -> float:
    known = numbers[~np.isnan(numbers)]
    return float(untyped.min(known)) if known.size > 0 else float("nan")


def _unknown(count: int) -> str:
    return f", {count} unknown" if count > 0 else ""


Arrays = TypeVar("Arrays", bound=VerdictArrays)


class Tables(Ambiguous, Generic[Arrays]):
    """The verdicts of all monitors, as arrays: `verdicts.NAME` or `verdicts["NAME"]`.

    Its truth value raises AmbiguousError.

    Attributes:
        table: a structured array with the fields robustness, lower, upper and status; its last
            axis is that of monitors.
        monitors: the names of the monitors, in the order of the last axis.
    """

    __hash__ = None  # type: ignore[assignment]
    _ask = "the .alarm.any(), .violated, ... of one of its monitors"
    _arrays: type[Arrays]
    #: The names of the leading axes; the second for several plans of each environment.
    _axes: tuple[str, ...] = ("environment",)
    _more_axes: tuple[str, ...] = ()

    def __init__(self, monitors: tuple[str, ...], table: Array) -> None:
        self.monitors = monitors
        self.table = table

    def __getitem__(self, name: str) -> Arrays:
        if not is_text(name) or name not in self.monitors:
            raise InputError(no_such("monitor", name, self.monitors))
        return self._arrays(name, self.table[..., self.monitors.index(name)])

    def __getattr__(self, name: str) -> Arrays:
        if name.startswith("_") or name in ("monitors", "table"):
            raise AttributeError(name)
        if name not in self.monitors:
            raise AttributeError(f"there is no monitor {name!r}")
        return self[name]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.monitors]

    def keys(self) -> tuple[str, ...]:
        """The names of the monitors, so that dict() has the verdicts by name."""
        return self.monitors

    def __iter__(self) -> Iterator[Arrays]:
        return (self[name] for name in self.monitors)

    def __len__(self) -> int:
        return len(self.table)

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with a row for each monitor at each place of the other axes.

        Raises:
            ImportError: pandas is not installed.
        """
        axes = self._axes if self.table.ndim == len(self._axes) + 1 else self._more_axes
        return _frames.frame_of_tables(self, axes)

    def _repr_html_(self) -> str:
        """Returns a small table, for notebooks."""
        rows = (
            (one.name, one._alarms(), *(int(np.count_nonzero(where)) for where in (
                one.satisfied, one.violated, one.unknown)),
             _html.number(_least(one.robustness)))
            for one in self
        )  # fmt: skip
        shape = " x ".join(map(str, self.table.shape[:-1]))
        head = ("monitor", "alarms", "satisfied", "violated", "unknown", "least robustness")
        return _html.table(head, rows, f"{shape} verdicts")

    def __contains__(self, one: object) -> bool:
        return contains(self, one, self._ask)

    def _content(self) -> tuple[Any, ...]:
        return self.monitors, self.table.shape, self.table.tobytes()

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self))})"


class Episode(Tables[EpisodeVerdicts]):
    """The verdicts of all monitors for an episode: `episode.NAME` or `episode["NAME"]`.

    Its truth value raises AmbiguousError: `len` is its number of steps.

    Attributes:
        table: a structured array (N steps, M monitors) with the fields robustness, lower, upper
            and status.
        monitors: the names of the monitors, in the order of the columns.
        distances: by predicate, float32 (N,): its distance or expression at each step; NaN where
            it is unknown. Only if they were asked for: `run(..., distances=True)`.
        thresholds: by predicate, float32 (N,): the number that it is compared with; not for those
            that `etlc.run` read.
        texts: the formulas of monitors and the predicates as text, by name, if they are known.
        step_seconds: the length of a step; 0 if it is unknown.
    """

    _ask = "the .first_alarm, .alarm.any(), .violated[-1], ... of one of its monitors"
    _arrays = EpisodeVerdicts
    _axes = ("step",)

    def __init__(
        self, monitors: tuple[str, ...], table: Array,
        distances: Mapping[str, Array] | None = None,
        thresholds: Mapping[str, Array] | None = None,
        texts: Mapping[str, str] | None = None, step_seconds: float = 0.0,
    ) -> None:  # fmt: skip
        super().__init__(monitors, table)
        self.distances: dict[str, Array] = dict(distances or {})
        self.thresholds: dict[str, Array] = dict(thresholds or {})
        self.texts: dict[str, str] = dict(texts or {})
        self.step_seconds = step_seconds

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with a row for each monitor at each step, and the distances.

        Raises:
            ImportError: pandas is not installed.
        """
        return _frames.frame_of_episode(self)

    def plot(self) -> Any:
        """Draws the distances and the verdicts over the steps.

        Returns:
            A matplotlib.figure.Figure.

        Raises:
            ImportError: matplotlib is not installed.
        """
        return _frames.plot(self)

    def svg(self) -> str:
        """Returns the timelines as a picture, as the report draws them."""
        return _timeline.timeline(self)

    def _repr_html_(self) -> str:
        """Returns a small table and the timelines, for notebooks."""
        rows = (
            (one.name, _html.number(one.first_alarm), int(np.count_nonzero(one.unknown)),
             one.status[-1] if len(self) > 0 else "–")
            for one in self
        )  # fmt: skip
        head = ("monitor", "first alarm", "unknown steps", "at the end")
        table = _html.table(head, rows, f"{len(self)} steps")
        return table + (self.svg() if len(self) > 0 else "")

    def _content(self) -> tuple[Any, ...]:
        distances = [(name, values.tobytes()) for name, values in self.distances.items()]
        return *super()._content(), distances


class BatchVerdicts(Tables[VerdictArrays]):
    """The verdicts of all monitors of a batch at a step: `verdicts.NAME` or `verdicts["NAME"]`.

    Its truth value raises AmbiguousError: `len` is its number of environments.

    Attributes:
        table: a structured array (N environments, M monitors) with the fields robustness, lower,
            upper and status.
        monitors: the names of the monitors, in the order of the columns.
    """

    _arrays = VerdictArrays


class BatchEpisode(Tables[RunVerdicts]):
    """The verdicts of all monitors for rows of steps, of environments or plans.

    Its truth value raises AmbiguousError: `len` is its number of environments, or of plans.

    Attributes:
        table: a structured array (N rows, T steps, M monitors) with the fields robustness, lower,
            upper and status; (N environments, K plans, T steps, M monitors) where each environment
            has several plans.
        monitors: the names of the monitors, in the order of the columns.
    """

    _ask = "the .first_alarm, .alarm.any(axis=-1), ... of one of its monitors"
    _arrays = RunVerdicts
    _axes = ("row", "step")
    _more_axes = ("environment", "plan", "step")
