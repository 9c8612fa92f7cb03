"""Steps the monitors of a spec for many environments at once."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

from ctypes import byref, c_uint64
from typing import TYPE_CHECKING, Any, Iterable, Mapping, NoReturn, Union

import numpy as np

from ._arguments import is_whole
from ._library import call, library
from ._types import Array
from .description import Described, Measurements
from .errors import InputError
from .conversion import chosen_of
from .grids import Grids, joined, warn_of_absent
from .arrays import VERDICT_DTYPE, BatchEpisode, BatchVerdicts

if TYPE_CHECKING:
    from .monitor import Monitor

#: Some environments: a bool for each, or the numbers of some, each once; None: all.
Which = Union[None, int, Iterable[int], Array]

_MEASURED = np.dtype([("distance", "f4"), ("threshold", "f4"), ("nearest", "u4")])


class Batch(Described):
    """Many environments that share a spec: `Monitor.batch` makes one.

    Each environment has the verdicts that a Monitor of its own would have, bit for bit. `len` is
    their number. Only one thread may use a batch at a time. There is no history and no recorder;
    `monitor` copies one environment as a Monitor.

    Example:
        >>> batch = etlc.Monitor("dock.etl").batch(1000)
        >>> verdicts = batch.step(z=embeddings, charge=charges)
        >>> verdicts.returns.alarm.shape
        (1000,)
    """

    def __init__(
        self, session: c_uint64, size: int, opened_with: Mapping[str, Any], threads: int
    ) -> None:
        """For `Monitor.batch`."""
        self._session = session
        self._size = size
        self._opened_with = dict(opened_with)
        self._threads = threads
        self._describe()

    def __len__(self) -> int:
        return self._size

    def step(self, /, *unnamed: NoReturn, **samples: Any) -> BatchVerdicts:
        """Takes one step in all environments. The samples are arguments, as in `Monitor.step`.

        Args:
            **samples: by the name of the input: an array of shape (n,) for a scalar or bool, (n, D)
                for an embedding. A row that is not finite or masked (numpy.ma) is missing in that
                environment, an input that is None or omitted in all. Arrays of the input's own
                dtype are read without a copy; other types are converted or refused as by
                `Monitor.step`.

        Returns:
            The verdicts of each monitor, as arrays of n environments.

        Raises:
            InputError: the spec does not have this name, shape or type; no step was taken.
            ClosedError: the batch is closed, or `finish` was called for some environment.
        """
        if unnamed:
            raise self._without_names()
        grids = Grids(self, samples, (self._size,))
        table = np.empty((self._size, len(self.monitors)), VERDICT_DTYPE)
        self._run(grids, 1, table)
        return BatchVerdicts(self.monitors, table)

    def run(self, arrays: Mapping[str, Any] | None = None, **more: Any) -> BatchEpisode:
        """Runs a whole episode in each environment: `reset`, then a step for each column.

        Args:
            arrays: by the name of the input: an array of shape (n, T) for a scalar or bool,
                (n, T, D) for an embedding. Missing samples are NaN or masked.
            **more: the same, as arguments.

        Returns:
            The verdicts of each monitor, in each environment at each step.

        Raises:
            InputError: as in `step`; no step was taken.

        Warns:
            EtlcWarning: an input that a monitor uses is not given, and not None.
        """
        given = joined(arrays, more)
        grids = Grids(self, given, (self._size, "T"))
        steps = grids.lead[1]
        table = np.empty((self._size, steps, len(self.monitors)), VERDICT_DTYPE)
        self.reset()
        self._run(grids, steps, table)
        if steps > 0:
            warn_of_absent(self, given)
        return BatchEpisode(self.monitors, table)

    def _run(self, grids: Grids, steps: int, table: Array) -> None:
        call(
            library.etlc_run_batch, self._session, grids.place, len(grids), steps, self._threads,
            table.ctypes.data, table.size,
        )  # fmt: skip

    def ahead(self, arrays: Mapping[str, Any] | None = None, **more: Any) -> BatchEpisode:
        """Returns the verdicts of continuations that have not happened. The batch stays as it is.

        Args:
            arrays: by the name of the input: a plan for each environment, an array of shape (n, T)
                for a scalar or bool, (n, T, D) for an embedding; or K plans for each: (n, K, T) or
                (n, K, T, D).
            **more: the same, as arguments.

        Raises:
            InputError: as in `step`.
            ClosedError: the batch is closed, or `finish` was called for some environment.
        """
        grids = Grids(self, joined(arrays, more), (self._size, "T"), (self._size, "K", "T"))
        table = np.empty((*grids.lead, len(self.monitors)), VERDICT_DTYPE)
        plans = 1 if len(grids.lead) == 2 else grids.lead[1]
        if table.size > 0:
            call(
                library.etlc_ahead, self._session, grids.place, len(grids), plans, grids.lead[-1],
                self._threads, table.ctypes.data, table.size,
            )  # fmt: skip
        return BatchEpisode(self.monitors, table)

    def reset(self, which: Which = None) -> None:
        """Begins a new episode in some environments: adaptive thresholds keep their values.

        Args:
            which: a bool for each environment, or the numbers of some; None: all of them. Integers
                are always numbers of environments; what may be a mask of integers is refused.

        Raises:
            InputError: there is no such environment, or a number is repeated.
        """
        call(library.etlc_reset_batch, self._session, *self._chosen(which)[1:])

    def restart(self, monitor: str, which: Which = None) -> None:
        """Restarts a restartable or repeating monitor in some environments, with their next step.

        `which`: as in `reset`.
        """
        at = self._at(self._monitor_at, "monitor", monitor)
        call(library.etlc_restart_batch, self._session, at, *self._chosen(which)[1:])

    def finish(self, which: Which = None) -> BatchVerdicts:
        """Ends the episode of some environments: sliding monitors report a remaining position.

        Call it `horizon` times to get all of them. `reset` begins another episode.

        Args:
            which: as in `reset`.

        Returns:
            The verdicts; those of the other environments are undecided.
        """
        kept = self._chosen(which)  # it holds what its address points to
        table = np.zeros((self._size, len(self.monitors)), VERDICT_DTYPE)
        for name in ("robustness", "lower", "upper"):
            table[name] = np.nan
        call(
            library.etlc_finish_batch, self._session, *kept[1:], table.ctypes.data, table.size
        )
        return BatchVerdicts(self.monitors, table)

    @property
    def steps(self) -> Array:
        """uint64: the number of steps of each environment since it was opened or reset."""
        steps = np.empty(self._size, "u8")
        call(library.etlc_steps_batch, self._session, steps.ctypes.data, self._size)
        return steps

    def measure(self, predicate: str) -> Measurements:
        """Returns the values of a predicate at the last step of each environment."""
        at = self._at(self._predicate_at, "predicate", predicate)
        table = np.empty(self._size, _MEASURED)
        call(library.etlc_measure_batch, self._session, at, table.ctypes.data, self._size)
        nearest = table["nearest"] if self._nearest[at] else None
        return Measurements(table["distance"], table["threshold"], nearest)

    def monitor(self, environment: int) -> Monitor:
        """Returns a Monitor that goes on from the state of one environment."""
        from .monitor import Monitor

        session = c_uint64(0)
        number = self._number(environment)
        call(library.etlc_copy_environment, self._session, number, byref(session))
        steps = int(self.steps[number])
        opened_with = {**self._opened_with, "history": 0, "recorder": None}
        return Monitor._of_session(session, opened_with, steps, 0)

    def __copy__(self) -> Batch:
        """Copies the batch with the states of all environments."""
        return Batch(self._copied(), self._size, self._opened_with, self._threads)

    def __deepcopy__(self, _: object) -> Batch:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the arguments of the monitor and the states."""
        return _reopened, (self._opened_with, self._size, self._saved())

    def __enter__(self) -> Batch:
        return self

    def __repr__(self) -> str:
        return f"<etlc.Batch {self.name}: {self._size} environments, {', '.join(self.monitors)}>"

    def _number(self, environment: Any) -> int:
        if not is_whole(environment):
            raise InputError(f"environment is {environment!r}, expected a whole number")
        if not 0 <= environment < self._size:
            raise InputError(
                f"there is no environment {environment}, only 0 to {self._size - 1}"
            )
        return int(environment)

    def _chosen(self, which: Which) -> tuple[Array | None, int | None, int]:
        """Returns a byte for each environment (None: all), its place and size."""
        if which is None:
            return None, None, self._size
        chosen = chosen_of(which, self._size)
        return chosen, chosen.ctypes.data, self._size


def _reopened(opened_with: dict[str, Any], environments: int, state: bytes) -> Batch:
    """Opens a pickled batch. The spec and its files must be those that it was opened with."""
    from .monitor import opened_again

    with opened_again(opened_with) as monitor:
        batch = monitor.batch(environments)
    batch._load(state)
    return batch
