"""The calls of a Monitor that step it, and that tell what it measured."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

import math
from ctypes import byref, c_float, c_size_t, c_uint64, sizeof
from typing import Any, Callable, NoReturn

import numpy as np

from . import _library, conversion
from ._library import call, library
from ._types import Array
from .description import Described, Drift, Input, Measurement
from .errors import InputError
from .names import no_such
from .verdicts import Verdicts


class Stepping(Described):
    """An open session that takes a step at a time."""

    def _make_room(self) -> None:
        """Allocates the samples and verdicts of a step."""
        self._samples = (_library.Sample * len(self.inputs))()
        self._elements: list[Array] = []
        self._put: dict[str, Callable[[Any], None]] = {}
        self._missing = set(self.inputs)
        for at, one in enumerate(self.inputs.values()):
            elements = np.zeros(self._counts[at], self._elements_of[at])
            self._elements.append(elements)
            self._samples[at].count = self._counts[at]
            self._samples[at].type = self._types[at]
            place = elements.ctypes.data
            put = self._scalar_put if one.shape == () else self._embedding_put
            self._put[one.name] = put(one, elements, self._samples[at], place)
        self._verdicts = (_library.VerdictStruct * len(self.monitors))()
        self._said = 0  # how often verdicts were returned
        self._begin = 0  # how often before this episode
        # The arguments of a step, as ctypes objects.
        self._call = (
            library.etlc_step, self._session, self._samples, c_size_t(len(self.inputs)),
            self._verdicts, c_size_t(len(self.monitors)), memoryview(self._verdicts).cast("B"),
        )  # fmt: skip

    def _scalar_put(
        self, one: Input, elements: Array, sample: Any, place: int
    ) -> Callable[[Any], None]:
        name, missing = one.name, self._missing
        what = f"input {name!r}"
        is_bool = one.dtype == np.bool_
        as_element = conversion.as_bool if is_bool else conversion.as_number
        fast = (bool, np.bool_) if is_bool else (float, np.float32, np.float64)
        view: Any = memoryview(elements)  # type: ignore[arg-type]

        def put(value: Any) -> None:
            if value.__class__ in fast:
                view[0] = bool(value) if is_bool else value
            elif value is None:
                self._mark_missing(name, sample)
                return
            else:
                view[0] = as_element(what, value)
            if name in missing:
                missing.discard(name)
                sample.data = place

        return put

    def _embedding_put(
        self, one: Input, elements: Array, sample: Any, place: int
    ) -> Callable[[Any], None]:
        name, missing = one.name, self._missing
        what, shape, dtype = f"input {name!r}", one.shape, elements.dtype
        view: Any = memoryview(elements)  # type: ignore[arg-type]

        def put(value: Any) -> None:
            if value.__class__ is np.ndarray and value.dtype == dtype and value.shape == shape:
                try:
                    view[:] = value
                except ValueError:  # not aligned: its buffer reports another type
                    elements[:] = value
            elif value is None:
                self._mark_missing(name, sample)
                return
            else:
                elements[:] = conversion.as_elements(what, value, dtype, shape)
            if name in missing:
                missing.discard(name)
                sample.data = place

        return put

    def _mark_missing(self, name: str, sample: Any) -> None:
        self._missing.add(name)
        sample.data = None

    def step(self, /, *unnamed: NoReturn, **samples: Any) -> Verdicts:
        """Takes one step. The samples are arguments: `step(**samples)` takes a dict.

        Args:
            **samples: by the name of the input: a number for a scalar, a bool, or an array of shape
                (D,) for an embedding. A sample that is None, omitted, not finite or out of range is
                missing. Arrays of the input's own dtype are copied once;
                float16 and float64 in place of float32 are rounded once; others are refused.

        Returns:
            The verdict of each monitor.

        Raises:
            InputError: the spec does not have this name, shape or type; no step was taken.
            ClosedError: the monitor is closed, or `finish` was called.
        """
        if unnamed:
            raise self._without_names()
        put, name = self._put, ""
        try:
            for name, value in samples.items():
                put[name](value)
        except KeyError:
            if name in put:
                raise
            raise InputError(no_such("input", name, tuple(self.inputs))) from None
        if len(samples) != len(put):
            for at, name in enumerate(put):
                if name not in samples and name not in self._missing:
                    self._mark_missing(name, self._samples[at])
        function, session, given, inputs, verdicts, monitors, raw = self._call
        status = function(session, given, inputs, verdicts, monitors)
        if status != 0:
            _library.raise_for(status)
        self._said = said = self._said + 1
        return Verdicts(self, raw.tobytes(), said)

    def finish(self) -> Verdicts:
        """Ends the episode: sliding monitors report one of the remaining positions.

        Call it `horizon` times to get all of them. `reset` begins another episode.
        """
        call(library.etlc_finish, self._session, self._verdicts, len(self.monitors))
        self._said += 1
        self._begin += 1
        return Verdicts(self, self._call[-1].tobytes(), self._said)

    def end_episode(self) -> None:
        """Ends an episode that ended regularly: its scores count for the drifts.

        Call it after the last step, before `reset`, which alone drops an episode that was cut
        short.
        """
        call(library.etlc_end_episode, self._session)

    def drift(self, name: str) -> Drift:
        """Returns what a drift of the spec knows after the episodes that ended regularly.

        Raises:
            InputError: the spec has no drift of this name.
        """
        found = _library.DriftStruct(struct_size=sizeof(_library.DriftStruct))
        call(library.etlc_drifted, self._session, _library.encoded("name", name), byref(found))
        return Drift(bool(found.is_alarm), found.wealth, found.limit, tuple(found.counts))

    def reset(self) -> None:
        """Begins a new episode. Adaptive thresholds keep their values, drifts their episodes."""
        call(library.etlc_reset, self._session)
        self._said += 1
        self._begin = self._said

    def restart(self, monitor: str) -> None:
        """Restarts a restartable or repeating monitor: it judges from the next step on."""
        call(library.etlc_restart, self._session, self._at(self._monitor_at, "monitor", monitor))

    def observe(self, predicate: str, distance: float, truth: bool) -> None:
        """Passes a label to an adaptive threshold.

        Args:
            predicate: the name of the predicate.
            distance: its distance at some frame.
            truth: whether it should have held at that frame.
        """
        at = self._at(self._predicate_at, "predicate", predicate)
        call(
            library.etlc_observe, self._session, at, conversion.as_number("distance", distance),
            conversion.as_bool("truth", truth),
        )  # fmt: skip

    @property
    def steps(self) -> int:
        """The number of steps since the monitor was opened or reset."""
        return self._said - self._begin

    def position(self, monitor: str) -> int:
        """Returns the step that the last verdict of a monitor is about."""
        position = c_uint64()
        at = self._at(self._monitor_at, "monitor", monitor)
        call(library.etlc_position, self._session, at, byref(position))
        return position.value

    def measure(self, predicate: str) -> Measurement:
        """Returns the values of a predicate at the last step."""
        at = self._at(self._predicate_at, "predicate", predicate)
        measured = _library.Measured()
        call(library.etlc_measure, self._session, at, byref(measured))
        inner = c_float()
        call(library.etlc_inner_threshold, self._session, at, byref(inner))
        nearest = measured.nearest if self._nearest[at] else None
        within = None if math.isnan(inner.value) else inner.value
        return Measurement(measured.distance, measured.threshold, nearest, within)

    def let(self, name: str) -> float:
        """Returns the robustness of a let at the last step; NaN if a missing sample hides it."""
        at = self._at(self._let_at, "let", name)
        verdict = _library.VerdictStruct()
        call(library.etlc_let, self._session, at, byref(verdict))
        known = verdict.status & (_library.SATISFIED | _library.VIOLATED)
        return float(verdict.robustness) if known else float("nan")

    def sample_counts(self, name: str) -> dict[str, int]:
        """Counts the samples of an input that were missing, out_of_range and held.

        Stale samples count as missing.
        """
        at = self._at({one: i for i, one in enumerate(self.inputs)}, "input", name)
        counts = _library.Counts()
        call(library.etlc_count, self._session, at, byref(counts))
        return {
            "missing": counts.missing, "out_of_range": counts.out_of_range, "held": counts.held
        }  # fmt: skip
