"""Steps the monitors of a spec."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

import ctypes
import os
import warnings
from ctypes import byref, c_char_p, c_uint64
from typing import Any, Mapping

import numpy as np

from . import _library
from ._arguments import choice, count, flag, is_mapping, recorder_text, size
from ._library import call, encoded, encoded_path, library
from .arrays import VERDICT_DTYPE, BatchEpisode, Episode
from .batch import Batch
from .errors import EtlcWarning, InputError, diagnostics_of, warn, warn_of
from .grids import Grids, joined
from .kept import Keeping
from .reference import Referring
from .stepping import Stepping


class Monitor(Stepping, Keeping, Referring):
    """The monitors of a spec. Only one thread may use it at a time.

    Args:
        spec: the path of the spec, a .etl file; with `text`, files are looked up beside this path.
        text: the text of the spec.
        thresholds: a file; by default SPEC.thresholds.json beside the spec, if it exists.
        fitted: a file; by default SPEC.fitted.npz beside the spec, if it exists.
        embedded: a file of `embed`; by default SPEC.embedded.npz beside the spec, if it exists.
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
        embedded: str | os.PathLike[str] | None = None,
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
        self._threads = count("threads", threads)
        if text is None and isinstance(spec, str) and ("\n" in spec or ";" in spec):
            if not os.path.exists(spec):
                raise InputError(
                    "spec is the path of a spec, and this is the text of one: did you mean text=?"
                )
        if spec is None and text is None:
            raise InputError("there is no spec: pass its path, or text=")
        if settings is not None and not is_mapping(settings):
            raise InputError(f"settings is {settings!r}, expected a dict of constants")
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
            values=choice("values", values, ("robustness", "boolean")),
            targets_as=choice("targets_as", targets_as, ("f32", "f16", "i8")),
            lets=flag("lets", lets),
            max_state=size("max_state", max_state),
            max_code=size("max_code", max_code),
            max_work=size("max_work", max_work),
            history=size("history", history),
            recorder=recorder_text(recorder),
            embedded=None if embedded is None else encoded_path("embedded", embedded),
        )
        #: The arguments, to open it again.
        self._opened_with: dict[str, Any] = {
            "spec": spec if spec is None else os.fspath(spec), "text": text,
            "thresholds": thresholds if thresholds is None else os.fspath(thresholds),
            "fitted": fitted if fitted is None else os.fspath(fitted),
            "embedded": embedded if embedded is None else os.fspath(embedded),
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

    def run(
        self, arrays: Mapping[str, Any] | None = None, *, distances: bool = False, **more: Any
    ) -> Episode:
        """Runs a whole episode: `reset`, then a step for each row.

        Args:
            arrays: by the name of the input: an array of shape (N,) for a scalar or bool, (N, D)
                for an embedding. Samples that are NaN, masked (numpy.ma) or omitted are missing.
                Arrays of the input's own dtype are read without a copy, with any row stride.
            distances: also keep the distance of each predicate at each step, and its threshold.
            **more: the same as `arrays`, as arguments.

        Returns:
            The verdicts of each monitor at each step.

        Raises:
            InputError: as in `step`; no step was taken.

        Warns:
            EtlcWarning: an input that a monitor uses is missing at every step, and not None.
        """
        distances = flag("distances", distances)  # samples of such an input go into `arrays`
        given = joined(arrays, more)
        grids = Grids(self, given, ("N",))
        (steps,) = grids.lead
        columns = grids.columns()
        table = np.empty((steps, len(self.monitors)), VERDICT_DTYPE)
        measured = np.empty((2, len(self.predicates) if distances else 0, steps), "f4")
        self.reset()
        at_once = 1 if distances else steps
        for first in range(0, steps, max(at_once, 1)):
            call(
                library.etlc_run, self._session, ctypes.addressof(columns), len(columns), at_once,
                table.ctypes.data + first * table.strides[0], at_once * len(self.monitors),
            )  # fmt: skip
            for p, name in enumerate(self.predicates if distances else ()):
                found = self.measure(name)
                measured[:, p, first] = found.distance, found.threshold
            _library.advance(columns, at_once)
        self._said += steps
        self._warn_of_missing(steps, given)
        kept, thresholds = (dict(zip(self.predicates, one)) for one in measured)
        texts = {**self.predicates, **self.formulas}
        return Episode(self.monitors, table, kept, thresholds, texts, self.step_seconds)

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
        n = count("n", n)
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
        said: list[str] = []
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

    def __enter__(self) -> Monitor:
        return self

    def __repr__(self) -> str:
        return f"<etlc.Monitor {self.name}: {', '.join(self.monitors)}>"


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
