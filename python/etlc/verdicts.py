"""The verdicts of monitors after one step."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

from dataclasses import dataclass
from struct import Struct
from typing import Any, Iterator

from . import _frames, _html
from ._ambiguous import Ambiguous
from ._library import ALARM, DECIDED, FINAL, FULFILLED, SATISFIED, VIOLATED
from .errors import AmbiguousError, InputError, NotKeptError
from .names import Names, is_text, names_of, no_such

_VERDICT = Struct("=3fI")
_HEAD = ("monitor", "status", "robustness", "lower", "upper")


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

    def _repr_html_(self) -> str:
        """Returns the text, for notebooks."""
        return _html.preformatted(self.text)


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
        """Whether a missing sample leaves it open, or a number between two thresholds."""
        return self.decided and not self.satisfied and not self.violated

    @property
    def final(self) -> bool:
        """Whether no continuation can change it. Of a repeating monitor it may be unknown."""
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
        return verdict_of, (self.name, *self.bounds, self.robustness, self._status)

    def _content(self) -> tuple[Any, ...]:
        return self.name, _VERDICT.pack(*self.bounds, self.robustness, self._status)

    def __repr__(self) -> str:
        text = f"<{self.name}: {_frames.standing(self)}"
        if self.decided:
            text += f", {self.robustness:.6g} in [{self.lower:.6g}, {self.upper:.6g}]"
        return text + ">"

    def _repr_html_(self) -> str:
        """Returns a small table, for notebooks."""
        return _html.table(_HEAD, _frames.rows_of_step([self]))


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
        at = self._monitor._offsets.get(name) if is_text(name) else None
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
        return contains(self, one, "its .alarms")

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

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with a row for each monitor.

        Raises:
            ImportError: pandas is not installed.
        """
        return _frames.frame_of_step(self)

    def __repr__(self) -> str:
        return f"Verdicts({', '.join(map(repr, self))})"

    def _repr_html_(self) -> str:
        """Returns a small table, for notebooks."""
        return _html.table(_HEAD, _frames.rows_of_step(self))


def contains(verdicts: Any, one: object, ask: str) -> bool:
    """Implements `in` for verdicts; "violated", or a name, would be ambiguous."""
    among = list(verdicts)
    if isinstance(one, Ambiguous) and isinstance(one, tuple(map(type, among))):
        return any(one == other for other in among)
    raise AmbiguousError(
        f"{one!r} in {verdicts._shown()} is ambiguous: ask for {ask}, or for a name in .monitors"
    )


def verdict_of(name: str, lower: float, upper: float, robustness: float, status: int) -> Verdict:
    """Makes a verdict that was pickled, or is one of an array."""
    return Verdict(
        names_of((name,)), 0, name, _VERDICT.pack(robustness, lower, upper, status), 0
    )


def _verdicts(monitors: tuple[str, ...], raw: bytes) -> Verdicts:
    """Makes verdicts that were pickled."""
    return Verdicts(names_of(monitors), raw, 0)
