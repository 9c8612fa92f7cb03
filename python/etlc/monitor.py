"""Steps the monitors of a spec."""

from __future__ import annotations

import ctypes
import os
import warnings
from ctypes import POINTER, byref, c_char_p, c_double, c_float, c_size_t, c_uint32, c_uint64
from ctypes import c_void_p
from typing import Any, Callable, Mapping

import numpy as np

from . import _library, conversion
from ._library import call, decoded, encoded, encoded_path, library
from ._types import Array
from .batch import Batch
from .description import REFERENCE_FRAMES, Described, Input, Measurement
from .errors import EtlcWarning, InputError, diagnostics_of, warn, warn_of
from .grids import Grids, joined
from .names import no_such
from .verdicts import VERDICT_DTYPE, BatchEpisode, Episode, Explanation, Verdicts


class Monitor(Described):
    """The monitors of a spec. Only one thread may use it at a time.

    Args:
        spec: the path of the spec, a .etl file; with `text`, files are looked up beside this path.
        text: the text of the spec.
        thresholds: a file; by default SPEC.thresholds.json beside the spec, if it exists.
        fitted: a file; by default SPEC.fitted.npz beside the spec, if it exists.
        settings: other values for constants: {"limit": 0.25, "deadline": "2s"}.
        values: "robustness", or "boolean" for verdicts without numbers.
        targets_as: the storage of target sets: "f32", "f16" or "i8".
        lets: keep the robustness of lets at each step, for `let`.
        history: the number of steps that `why` and `explain` can look back. Each takes some bytes
            per predicate, and measures it once more.
        recorder: keep the steps around each alarm, for `incidents`: the numbers of steps before and
            after it, and of alarms, as (40, 20, 4) or, if the spec has a rate, "2s,1s,4".
        max_state, max_code, max_work: limits of the plan, as the options of etlc.
        threads: the number of threads for `ahead` and for the calls of `batch`.

    Raises:
        SpecError: the spec does not compile; its `diagnostics` give the places.
        InputError: an argument is invalid.

    Warns:
        EtlcWarning: the spec is legal but hardly intended; its `diagnostic` gives the place.

    Example:
        >>> monitor = etlc.Monitor("dock.etl")
        >>> verdicts = monitor.step(z=embedding, charge=0.3)
        >>> verdicts.returns.alarm
        False
    """

    def __init__(
        self,
        spec: str | os.PathLike[str] | None = None,
        *,
        text: str | None = None,
        thresholds: str | os.PathLike[str] | None = None,
        fitted: str | os.PathLike[str] | None = None,
        settings: Mapping[str, object] | None = None,
        values: str = "robustness",
        targets_as: str = "f32",
        lets: bool = False,
        history: int = 0,
        recorder: str | tuple[int | str, int | str, int] | None = None,
        max_state: int = 0,
        max_code: int = 0,
        max_work: int = 0,
        threads: int = 1,
    ) -> None:
        self._session = c_uint64(0)
        self._threads = _count("threads", threads)
        if text is None and isinstance(spec, str) and ("\n" in spec or ";" in spec):
            if not os.path.exists(spec):
                raise InputError(
                    "spec is the path of a spec, and this is the text of one: did you mean text=?"
                )
        words = [
            encoded("a setting", f"{name}={value}") for name, value in (settings or {}).items()
        ]
        options = _library.Options(
            struct_size=ctypes.sizeof(_library.Options),
            api_version=_library.API_VERSION,
            path=None if spec is None else encoded_path("spec", spec),
            text=None if text is None else encoded("text", text),
            thresholds=None if thresholds is None else encoded_path("thresholds", thresholds),
            fitted=None if fitted is None else encoded_path("fitted", fitted),
            settings=(c_char_p * len(words))(*words),
            setting_count=len(words),
            values=_choice("values", values, ("robustness", "boolean")),
            targets_as=_choice("targets_as", targets_as, ("f32", "f16", "i8")),
            lets=bool(lets),
            max_state=_size("max_state", max_state),
            max_code=_size("max_code", max_code),
            max_work=_size("max_work", max_work),
            history=_size("history", history),
            recorder=_recorder(recorder),
        )
        #: The arguments, to open it again.
        self._opened_with: dict[str, Any] = {
            "spec": spec if spec is None else os.fspath(spec), "text": text,
            "thresholds": thresholds if thresholds is None else os.fspath(thresholds),
            "fitted": fitted if fitted is None else os.fspath(fitted),
            "settings": None if settings is None else dict(settings), "values": values,
            "targets_as": targets_as, "lets": lets, "history": history, "recorder": recorder,
            "max_state": max_state, "max_code": max_code, "max_work": max_work,
            "threads": threads,
        }  # fmt: skip
        call(library.etlc_open, byref(options), byref(self._session))
        found = diagnostics_of(library.etlc_message_json())
        self._describe()
        self._make_room()
        warn_of(found)

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
                view[0] = as_element(name, value)
            if name in missing:
                missing.discard(name)
                sample.data = place

        return put

    def _embedding_put(
        self, one: Input, elements: Array, sample: Any, place: int
    ) -> Callable[[Any], None]:
        name, missing = one.name, self._missing
        shape, dtype = one.shape, elements.dtype
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
                elements[:] = conversion.as_elements(name, value, dtype, shape)
            if name in missing:
                missing.discard(name)
                sample.data = place

        return put

    def _mark_missing(self, name: str, sample: Any) -> None:
        self._missing.add(name)
        sample.data = None

    def step(self, /, **samples: Any) -> Verdicts:
        """Takes one step.

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
        put = self._put
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

    def run(self, arrays: Mapping[str, Any] | None = None, **more: Any) -> Episode:
        """Runs a whole episode: `reset`, then a step for each row.

        Args:
            arrays: by the name of the input: an array of shape (N,) for a scalar or bool, (N, D)
                for an embedding. Samples that are NaN, masked (numpy.ma) or omitted are missing.
                Arrays of the input's own dtype are read without a copy, with any row stride.
            **more: the same, as arguments.

        Returns:
            The verdicts of each monitor at each step.

        Raises:
            InputError: as in `step`; no step was taken.

        Warns:
            EtlcWarning: an input that a monitor uses is missing at every step, and not None.
        """
        given = joined(arrays, more)
        grids = Grids(self, given, ("N",))
        (steps,) = grids.lead
        columns = grids.columns()
        table = np.empty((steps, len(self.monitors)), VERDICT_DTYPE)
        self.reset()
        if steps > 0:
            call(
                library.etlc_run, self._session, ctypes.addressof(columns), len(columns), steps,
                table.ctypes.data, table.size,
            )  # fmt: skip
        self._said += steps
        self._warn_of_missing(steps, given)
        return Episode(self.monitors, table)

    def ahead(
        self, arrays: Mapping[str, Any] | None = None, **more: Any
    ) -> Episode | BatchEpisode:
        """Returns the verdicts of a continuation that has not happened. The monitor stays as it is.

        Args:
            arrays: by the name of the input: its next samples, an array of shape (N,) for a scalar
                or bool, (N, D) for an embedding, as in `run`; or those of K plans, each from the
                present step on: (K, N) or (K, N, D).
            **more: the same, as arguments.

        Returns:
            The verdicts of each monitor at each step of the continuation; of each plan, if there
            are several. `history` and `recorder` take no part.

        Raises:
            InputError: as in `step`.
            ClosedError: the monitor is closed, or `finish` was called.
        """
        grids = Grids(self, joined(arrays, more), ("N",), ("K", "N"))
        table = np.empty((*grids.lead, len(self.monitors)), VERDICT_DTYPE)
        plans = 1 if len(grids.lead) == 1 else grids.lead[0]
        if table.size > 0:
            call(
                library.etlc_ahead, self._session, grids.place, len(grids), plans, grids.lead[-1],
                self._threads, table.ctypes.data, table.size,
            )  # fmt: skip
        several = len(grids.lead) > 1
        return BatchEpisode(self.monitors, table) if several else Episode(self.monitors, table)

    def batch(self, n: int) -> Batch:
        """Returns `n` environments that share this spec, each before its first step."""
        session = c_uint64(0)
        n = _count("n", n)
        call(library.etlc_open_batch, self._session, n, byref(session))
        return Batch(session, n, self._opened_with, self._threads)

    def __copy__(self) -> Monitor:
        """Copies the monitor with its state, history and incidents; the copy steps by itself."""
        return self._of_session(self._copied(), self._opened_with, self._said, self._begin)

    def __deepcopy__(self, _: object) -> Monitor:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the arguments of the monitor and its state."""
        return _reopened, (self._opened_with, self._saved(), self._said, self._begin)

    @classmethod
    def _of_session(
        cls, session: c_uint64, opened_with: Mapping[str, Any], said: int, begin: int
    ) -> Monitor:
        """Takes an open session."""
        monitor = cls.__new__(cls)
        monitor._session = session
        monitor._opened_with = dict(opened_with)
        monitor._threads = opened_with["threads"]
        monitor._describe()
        monitor._make_room()
        monitor._said, monitor._begin = said, begin
        return monitor

    def _warn_of_missing(self, steps: int, given: Mapping[str, Any]) -> None:
        """Warns of inputs that monitors use and that have no sample in the episode."""
        said = []
        for name, one in self.inputs.items():
            if steps == 0 or not one.is_used or given.get(name, ...) is None:
                continue
            counts = self.sample_counts(name)
            if counts["missing"] + counts["out_of_range"] < steps:
                continue
            why = "missing or not finite"
            if name not in given:
                why = "missing: it is not given"
            elif counts["out_of_range"] > 0:
                bounds = f"[{one.low:g}, {one.high:g}]"
                why = f"{'missing or ' if counts['missing'] else ''}out of its range, {bounds}"
            said.append(f"every sample of {name!r} is {why}")
        if said:
            end = "; predicates that measure it are unknown throughout"
            warn(EtlcWarning("; ".join(said) + end))

    def finish(self) -> Verdicts:
        """Ends the episode: sliding monitors report one of the remaining positions.

        Call it `horizon` times to get all of them. `reset` begins another episode.
        """
        call(library.etlc_finish, self._session, self._verdicts, len(self.monitors))
        self._said += 1
        self._begin += 1
        return Verdicts(self, self._call[-1].tobytes(), self._said)

    def reset(self) -> None:
        """Begins a new episode. Adaptive thresholds keep their values."""
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
        nearest = measured.nearest if self._nearest[at] else None
        return Measurement(measured.distance, measured.threshold, nearest)

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

    def encoder_difference(self, frame: int, embedding: Any, encoder: str | None = None) -> float:
        """Returns how far this machine's encoder is from the one of calibration.

        Args:
            frame: the number of a reference frame, from 0 to REFERENCE_FRAMES - 1. `etlc embed
                --write-reference FOLDER` writes them.
            embedding: what the encoder makes of it.
            encoder: the name of the encoder; may be left out where the spec has one.

        Returns:
            |z - r| / |r|, where r is what `etlc embed` made of the frame; infinity where the
            embedding is not finite.

        Raises:
            NotKeptError: the embeddings of the spec were made by an earlier version of etlc embed.
        """
        array = conversion.as_elements(
            "embedding", embedding, np.dtype("f4"), (np.size(embedding),)
        )  # fmt: skip
        values = np.ascontiguousarray(array)
        if not 0 <= frame < REFERENCE_FRAMES:
            raise InputError(f"frame is {frame}, expected 0 to {REFERENCE_FRAMES - 1}")
        name = None if encoder is None else encoded("encoder", encoder)
        difference = c_double()
        call(
            library.etlc_encoder_difference, self._session, name, frame,
            values.ctypes.data_as(POINTER(c_float)), values.size, byref(difference),
        )  # fmt: skip
        return difference.value

    def encoder_agrees(
        self, frame: int, embedding: Any, encoder: str | None = None, tolerance: float = 1e-3
    ) -> bool:
        """Returns whether this machine's encoder is the one of calibration, but for rounding.

        Ask for each reference frame before the first step: verdicts mean nothing with another
        encoder. `encoder_difference` says what the arguments are. `tolerance` is its largest value.
        """
        return self.encoder_difference(frame, embedding, encoder) <= tolerance

    @property
    def incidents(self) -> tuple[bytes, ...]:
        """The complete incidents, each an alarm with the steps around it, for `etlc incident`.

        An incident is complete some steps after its alarm, or at the end of the episode (`reset`,
        `close_incidents`). It does not change after that.

        Raises:
            NotKeptError: the monitor was opened without a recorder.
        """
        incidents = []
        for n in range(self._incident_counts()[0]):
            data, size = c_void_p(), c_size_t()
            call(library.etlc_incident, self._session, n, byref(data), byref(size))
            incidents.append(ctypes.string_at(data, size.value))
        return tuple(incidents)

    @property
    def lost_incidents(self) -> int:
        """The number of alarms that began while there was no room for another incident."""
        return self._incident_counts()[1]

    def close_incidents(self) -> None:
        """Completes pending incidents with the steps so far."""
        call(library.etlc_close_incidents, self._session)

    def forget_incidents(self) -> None:
        """Deletes the incidents to make room for new ones."""
        call(library.etlc_forget_incidents, self._session)

    def _incident_counts(self) -> tuple[int, int]:
        complete, lost = c_uint32(), c_uint32()
        call(library.etlc_incidents, self._session, byref(complete), byref(lost))
        return complete.value, lost.value

    def explain(self, monitor: str) -> Explanation:
        """Explains the last verdict of a monitor, like `etlc explain`.

        Raises:
            NotKeptError: the monitor was opened without a history as long as the episode.
            UndecidedError: there is no verdict yet.
        """
        import json

        at = self._at(self._monitor_at, "monitor", monitor)
        said = []
        for form in (0, 1):
            text = c_char_p()
            call(library.etlc_explain, self._session, at, form, byref(text))
            said.append(decoded(text.value))
        return Explanation(said[0], json.loads(said[1]))

    def __enter__(self) -> Monitor:
        return self

    def __repr__(self) -> str:
        return f"<etlc.Monitor {self.name}: {', '.join(self.monitors)}>"

def _choice(name: str, value: str, choices: tuple[str, ...]) -> int:
    if value not in choices:
        raise InputError(f"{name} is {value!r}, expected {' or '.join(choices)}")
    return choices.index(value)


def _reopened(opened_with: dict[str, Any], state: bytes, said: int, begin: int) -> Monitor:
    """Opens a pickled monitor. The spec and its files must be those that it was opened with."""
    monitor = opened_again(opened_with)
    monitor._load(state)
    monitor._said, monitor._begin = said, begin
    return monitor


def opened_again(opened_with: Mapping[str, Any]) -> Monitor:
    """Opens a monitor that was opened before, without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", EtlcWarning)
        return Monitor(**opened_with)


def _recorder(given: str | tuple[int | str, int | str, int] | None) -> bytes | None:
    if given is None:
        return None
    return encoded("recorder", given if isinstance(given, str) else ",".join(map(str, given)))


def _size(name: str, value: int) -> int:
    if not isinstance(value, (int, np.integer)) or not 0 <= value < 1 << 63:
        raise InputError(f"{name} is {value!r}, expected a whole number from 0 on")
    return int(value)


def _count(name: str, value: int) -> int:
    if _size(name, value) == 0 or value > 0xFFFFFFFF:
        raise InputError(f"{name} is {value!r}, expected a whole number from 1 on")
    return int(value)
