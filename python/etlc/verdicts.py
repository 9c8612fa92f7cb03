"""The verdicts of monitors, for one step and for an episode."""

from __future__ import annotations

from dataclasses import dataclass
from struct import Struct
from typing import Any, Generic, Iterator, TypeVar

import numpy as np

from ._ambiguous import Ambiguous
from ._library import ALARM, DECIDED, FINAL, FULFILLED, SATISFIED, VIOLATED
from ._types import Array
from .errors import AmbiguousError, InputError, NotKeptError
from .names import Names, names_of, no_such

_VERDICT = Struct("=3fI")
VERDICT_DTYPE = np.dtype(
    [("robustness", "f4"), ("lower", "f4"), ("upper", "f4"), ("status", "u4")]
)


@dataclass(frozen=True, eq=False)
class Explanation(Ambiguous):
    """The explanation of a verdict by `etlc explain`.

    Attributes:
        text: the explanation for people.
        data: the same for programs; docs/explanations.md lists the keys.
    """

    text: str
    data: dict[str, Any]

    _ask = "its .text or .data"

    def __str__(self) -> str:
        return self.text


class Verdict(Ambiguous):
    """The verdict of one monitor after one step. It does not change with later steps.

    Its truth value raises AmbiguousError: use `alarm`.

    Attributes:
        name: the name of the monitor.
        robustness: the margin, in the units of its predicates; pessimistic if
            a sample is missing; NaN if undecided.
        lower, upper: bounds on the robustness for every continuation.
    """

    __slots__ = ("_monitor", "_said", "_status", "lower", "name", "robustness", "upper")
    _ask = "its .alarm, .fulfilled, .satisfied, .violated, .unknown or .status"

    def __init__(self, monitor: Names, said: int, name: str, raw: bytes, at: int) -> None:
        self._monitor = monitor
        self._said = said
        self.name = name
        self.robustness: float
        self.lower: float
        self.upper: float
        self._status: int
        self.robustness, self.lower, self.upper, self._status = _VERDICT.unpack_from(raw, at)

    @property
    def bounds(self) -> tuple[float, float]:
        """(lower, upper)."""
        return self.lower, self.upper

    @property
    def alarm(self) -> bool:
        """Whether it is violated for good: nothing can repair it."""
        return self._status & ALARM == ALARM

    @property
    def fulfilled(self) -> bool:
        """Whether it is satisfied for good."""
        return self._status & FULFILLED == FULFILLED

    @property
    def satisfied(self) -> bool:
        """Whether it would be satisfied if the episode ended now."""
        return self._status & SATISFIED != 0

    @property
    def violated(self) -> bool:
        """Whether it would be violated if the episode ended now; mostly "not yet" until final."""
        return self._status & VIOLATED != 0

    @property
    def decided(self) -> bool:
        """Whether there is a verdict; false only before a sliding monitor has seen its horizon."""
        return self._status & DECIDED != 0

    @property
    def unknown(self) -> bool:
        """Whether a missing sample leaves it open."""
        return self.decided and not self.satisfied and not self.violated

    @property
    def final(self) -> bool:
        """Whether no continuation can change it between satisfied and violated."""
        return self._status & FINAL != 0

    @property
    def status(self) -> str:
        """"satisfied", "violated", "unknown" or "undecided"."""
        if not self.decided:
            return "undecided"
        return "satisfied" if self.satisfied else "violated" if self.violated else "unknown"

    @property
    def why(self) -> Explanation:
        """The explanation of this verdict, computed on demand.

        Raises:
            NotKeptError: the monitor was opened without a history, or has stepped since.
            UndecidedError: there is no verdict.
        """
        explain = getattr(self._monitor, "explain", None)
        if explain is None:
            raise NotKeptError(
                "this verdict is a copy without its monitor, which has the explanation"
            )
        if self._said != self._monitor._said:
            raise NotKeptError(
                "only the last verdict can be explained: the monitor has stepped on since"
            )
        explanation: Explanation = explain(self.name)
        return explanation

    def __reduce__(self) -> tuple[Any, ...]:
        return _verdict, (self.name, *self.bounds, self.robustness, self._status)

    def _content(self) -> tuple[Any, ...]:
        return self.name, _VERDICT.pack(*self.bounds, self.robustness, self._status)

    def __repr__(self) -> str:
        text = f"<{self.name}: {self.status}{' for good' if self.final else ''}"
        if self.decided:
            text += f", {self.robustness:.6g} in [{self.lower:.6g}, {self.upper:.6g}]"
        return text + ">"


class Verdicts(Ambiguous):
    """The verdicts of all monitors after one step: `verdicts.NAME` or `verdicts["NAME"]`.

    Its truth value raises AmbiguousError: use `alarms`.
    """

    __slots__ = ("_monitor", "_raw", "_said")
    _ask = "its .alarms, or the .alarm, .fulfilled, .violated, ... of one of its verdicts"

    def __init__(self, monitor: Names, raw: bytes, said: int) -> None:
        self._monitor = monitor
        self._raw = raw
        self._said = said

    def __getitem__(self, name: str) -> Verdict:
        at = self._monitor._offsets.get(name)
        if at is None:
            raise InputError(no_such("monitor", name, self._monitor.monitors))
        return Verdict(self._monitor, self._said, name, self._raw, at)

    def __getattr__(self, name: str) -> Verdict:
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._monitor._offsets:
            raise AttributeError(no_such("monitor", name, self._monitor.monitors))
        return self[name]

    def __iter__(self) -> Iterator[Verdict]:
        return (self[name] for name in self._monitor.monitors)

    def __len__(self) -> int:
        return len(self._monitor.monitors)

    def __contains__(self, one: object) -> bool:
        return _contains(self, one, "its .alarms")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._monitor.monitors]

    def keys(self) -> tuple[str, ...]:
        """The names of the monitors, so that dict(verdicts) has the verdicts by name."""
        return self._monitor.monitors

    def __reduce__(self) -> tuple[Any, ...]:
        return _verdicts, (self._monitor.monitors, self._raw)

    def _content(self) -> tuple[Any, ...]:
        return self._monitor.monitors, self._raw

    @property
    def alarms(self) -> list[Verdict]:
        """The verdicts that are violated for good, in the order of the spec."""
        return [verdict for verdict in self if verdict.alarm]

    def __repr__(self) -> str:
        return f"Verdicts({', '.join(map(repr, self))})"


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

    def _counted(self) -> str:
        return f"{int(self.alarm.sum())} alarms"

    def __repr__(self) -> str:
        shape = " x ".join(map(str, self._status.shape))
        missing = int(self.unknown.sum())
        return f"<{self.name}: {shape} verdicts, {self._counted()}{_unknown(missing)}>"


class EpisodeVerdicts(VerdictArrays):
    """The verdicts of one monitor at every step of an episode, as arrays of N steps.

    Its truth value raises AmbiguousError: use `alarm.any()`.

    Attributes:
        name: the name of the monitor.
        robustness, lower, upper: float32; NaN where undecided.
    """

    _ask = "its .first_alarm, .alarm.any(), .satisfied[-1], .violated[-1], ..."

    @property
    def first_alarm(self) -> int | None:
        """The first step with an alarm, or None."""
        alarms = self.alarm
        return int(np.argmax(alarms)) if alarms.any() else None

    def __repr__(self) -> str:
        first = self.first_alarm
        said = "no alarm" if first is None else f"first alarm at step {first}"
        return f"<{self.name}: {len(self)} steps, {said}{_unknown(int(self.unknown.sum()))}>"


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

    def _counted(self) -> str:
        return f"alarms in {int((self.first_alarm >= 0).sum())} rows"


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

    def __init__(self, monitors: tuple[str, ...], table: Array) -> None:
        self.monitors = monitors
        self.table = table

    def __getitem__(self, name: str) -> Arrays:
        if name not in self.monitors:
            raise InputError(f"there is no monitor {name!r}, only {', '.join(self.monitors)}")
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

    def __contains__(self, one: object) -> bool:
        return _contains(self, one, self._ask)

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
    """

    _ask = "the .first_alarm, .alarm.any(), .violated[-1], ... of one of its monitors"
    _arrays = EpisodeVerdicts


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


def _contains(verdicts: Verdicts | Tables[Any], one: object, ask: str) -> bool:
    """Implements `in` for verdicts; "violated", or a name, would be ambiguous."""
    if isinstance(one, (Verdict, VerdictArrays)):
        return any(one == other for other in verdicts)
    raise AmbiguousError(
        f"{one!r} in {verdicts._shown()} is ambiguous: ask for {ask}, or for a name in .monitors"
    )


def _verdict(name: str, lower: float, upper: float, robustness: float, status: int) -> Verdict:
    """Makes a verdict that was pickled."""
    return Verdict(
        names_of((name,)), 0, name, _VERDICT.pack(robustness, lower, upper, status), 0
    )


def _verdicts(monitors: tuple[str, ...], raw: bytes) -> Verdicts:
    """Makes verdicts that were pickled."""
    return Verdicts(names_of(monitors), raw, 0)
