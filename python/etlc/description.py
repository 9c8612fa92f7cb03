"""What a compiled spec says of itself."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

import ctypes
from ctypes import byref, c_char_p, c_uint64
from dataclasses import dataclass
from typing import Any, Mapping

import numpy as np

from . import _html, _library
from ._ambiguous import Ambiguous
from ._library import BOOL, F16, F32, I8, call, decoded, library
from ._types import Array
from .errors import Error, InputError
from .names import Names, is_text, no_such

_DTYPES: dict[int, np.dtype[Any]] = {
    F32: np.dtype("f4"), BOOL: np.dtype("u1"), F16: np.dtype("f2"), I8: np.dtype("i1")
}  # fmt: skip

REFERENCE_FRAMES = 4


@dataclass(frozen=True)
class Input:
    """An input of the spec.

    Attributes:
        name: the name of the argument of `step`.
        dtype: the type of its elements: float32, bool, float16 or int8.
        shape: () for a scalar or bool, (D,) for an embedding.
        hold: the number of missing samples in a row that the last one replaces.
        stale_after: the number of equal samples in a row that count; 0: all of them.
        low, high: the range of a scalar; values outside count as missing.
        is_used: whether a monitor uses it.
    """

    name: str
    dtype: np.dtype[Any]
    shape: tuple[int, ...]
    hold: int
    stale_after: int
    low: float
    high: float
    is_used: bool


@dataclass(frozen=True, eq=False)
class Measurement(Ambiguous):
    """The values of a predicate at the last step.

    Its truth value raises AmbiguousError: compare its distance with its threshold.

    Attributes:
        distance: the distance or expression; NaN if it is unknown, or no monitor needs it.
        threshold: the number it is compared with.
        nearest: the nearest row of the target for a plain distance, else None.
        inner_threshold: of two thresholds, the one within which the predicate is true, while it is
            false beyond the other and unknown between them; else None.
    """

    distance: float
    threshold: float
    nearest: int | None
    inner_threshold: float | None = None

    _ask = "its .distance, .threshold or .nearest"


@dataclass(frozen=True, eq=False)
class Drift(Ambiguous):
    """What a drift knows after the episodes so far.

    Its truth value raises AmbiguousError: ask for its alarm.

    Attributes:
        alarm: whether episodes no longer score like those of calibration. It stays. While nothing
            has changed it is ever raised with probability at most the level.
        wealth: the martingale, 1 at first; the alarm is raised where it reaches `limit`.
        limit: 1 / level.
        counts: the episodes that ended regularly, up to the alarm, by the cell of their score; of
            the 8 cells the first has the most usual scores.
    """

    alarm: bool
    wealth: float
    limit: float
    counts: tuple[int, ...]

    _ask = "its .alarm"

    @property
    def episodes(self) -> int:
        """The number of episodes that ended regularly, up to the alarm."""
        return sum(self.counts)


@dataclass(frozen=True, eq=False)
class Measurements(Ambiguous):
    """The values of a predicate at the last step of each environment of a batch.

    Its truth value raises AmbiguousError, and so does ==.

    Attributes:
        distance: float32, per environment; NaN if it is unknown, or no monitor needs it.
        threshold: float32, per environment.
        nearest: uint32, per environment: the nearest row of the target for a plain distance,
            else None.
    """

    distance: Array
    threshold: Array
    nearest: Array | None

    _ask = "its .distance, .threshold or .nearest"

    def _content(self) -> tuple[Any, ...]:
        nearest = b"" if self.nearest is None else self.nearest.tobytes()
        return self.distance.tobytes(), self.threshold.tobytes(), nearest


class Described(Names):
    """An open session of libetlc, or batch, with its description."""

    #: The session; 0 when it is closed.
    _session: c_uint64

    def _describe(self) -> None:
        spec = _described(_library.Description, library.etlc_describe, self._session)
        #: The name of the spec.
        self.name: str = spec.name.decode()
        #: The length of a step in seconds; 0 if the spec has no rate.
        self.step_seconds: float = spec.step_seconds
        #: The warnings of etlc; empty if there are none.
        self.warnings: str = decoded(spec.warnings)
        #: The greatest delay of a sliding monitor, in steps.
        self.horizon: int = spec.horizon
        #: XXH64 of the spec, its data and its thresholds, as in the generated class.
        self.fingerprint: tuple[int, int, int] = (
            spec.spec_hash, spec.data_hash, spec.thresholds_hash
        )  # fmt: skip
        inputs = [
            _described(_library.InputDescription, library.etlc_describe_input, self._session, i)
            for i in range(spec.inputs)
        ]
        self._types: list[int] = [one.type for one in inputs]
        self._counts: list[int] = [one.dimension for one in inputs]
        self._elements_of: list[np.dtype[Any]] = [_DTYPES[one.type] for one in inputs]
        #: The inputs by name, in the order of the spec.
        self.inputs: dict[str, Input] = {
            one.name.decode(): Input(
                one.name.decode(),
                np.dtype(bool) if one.type == BOOL else _DTYPES[one.type],
                (one.dimension,) if one.is_embedding else (),
                one.hold, one.stale_after, one.low, one.high, bool(one.is_used),
            )
            for one in inputs
        }  # fmt: skip
        monitors = [
            _described(_library.MonitorDescription, library.etlc_describe_monitor, self._session, m)
            for m in range(spec.monitors)
        ]
        self._name_monitors(tuple(one.name.decode() for one in monitors))
        #: The formulas as text, by name of the monitor.
        self.formulas: dict[str, str] = {
            one.name.decode(): decoded(one.formula) for one in monitors
        }
        predicates = [
            _described(
                _library.PredicateDescription, library.etlc_describe_predicate, self._session, p
            )
            for p in range(spec.predicates)
        ]
        #: The predicates as text, by name: "min l2(z, goal) <= 0.25".
        self.predicates: dict[str, str] = {
            decoded(one.name): decoded(one.text) for one in predicates
        }
        self._nearest = [bool(one.has_nearest) for one in predicates]
        self._predicate_at = {decoded(one.name): p for p, one in enumerate(predicates)}
        self._monitor_at = {name: m for m, name in enumerate(self.monitors)}
        self._let_at: dict[str, int] = {}
        for let in range(spec.lets):
            name = c_char_p()
            call(library.etlc_describe_let, self._session, let, byref(name))
            self._let_at[(name.value or b"").decode()] = let

    def _repr_html_(self) -> str:
        """Returns small tables of inputs, predicates and monitors, for notebooks."""
        inputs = (
            (one.name, f"{one.dtype}{list(one.shape) or ''}") for one in self.inputs.values()
        )
        return "".join((
            _html.table(("input", "type"), inputs, f"{self!r}"),
            _html.table(("predicate", ""), self.predicates.items()),
            _html.table(("monitor", "formula"), self.formulas.items()),
        ))  # fmt: skip

    def close(self) -> None:
        """Closes it. Every later call except close() raises ClosedError."""
        if self._session.value != 0:
            session, self._session.value = self._session.value, 0
            call(library.etlc_close, session)

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        try:
            self.close()
        except (Error, AttributeError, TypeError):  # in use, or the interpreter is exiting
            pass

    def _without_names(self) -> TypeError:
        """Returns the error of a step whose samples were not given by name."""
        names = [f"{name}=..." for name in self.inputs]
        named = ", ".join(names if len(names) <= 3 else [*names[:3], "..."])
        return TypeError(
            f"step takes samples by the name of their input: step({named}), or of a dict "
            "step(**samples)"
        )

    def _at(self, places: Mapping[str, int], kind: str, name: str) -> int:
        if not is_text(name) or name not in places:
            raise InputError(no_such(kind, name, tuple(places)))
        return places[name]

    def _saved(self) -> bytes:
        """Returns the state of its monitors."""
        data, size = ctypes.c_void_p(), ctypes.c_size_t()
        call(library.etlc_save, self._session, byref(data), byref(size))
        return ctypes.string_at(data, size.value) if data.value is not None else b""

    def _load(self, state: bytes) -> None:
        call(library.etlc_load, self._session, state, len(state))

    def _copied(self) -> c_uint64:
        """Returns a copy of the session."""
        copy = c_uint64(0)
        call(library.etlc_copy, self._session, byref(copy))
        return copy


def _described(kind: Any, function: Any, *arguments: Any) -> Any:
    description = kind(struct_size=ctypes.sizeof(kind))
    call(function, *arguments, byref(description))
    return description
