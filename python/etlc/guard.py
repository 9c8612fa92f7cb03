"""Says at each step of a policy whether to go on: `Guard`."""

from __future__ import annotations

import itertools
import os
from pathlib import Path
from typing import Any, Callable, Mapping, Union

import numpy as np

from ._arguments import is_mapping
from .errors import EtlcWarning, InputError, warn
from .monitor import Monitor
from .names import no_such
from .verdicts import Verdict, Verdicts

#: The answers, the mildest first: of several monitors the strictest counts.
ANSWERS = ("continue", "retry", "hand_over", "stop")

Answers = Union[str, Mapping[str, str]]


class Guard:
    """Steps the monitors of a spec beside a policy, and says what to do. Always true.

    Args:
        monitor: the monitors.
        on_alarm: the answer where a monitor is violated for good: "continue", "retry", "hand_over"
            or "stop"; or one for some monitors, by name.
        on_fulfilled: likewise, where one is satisfied for good.
        on_unknown: likewise, where one is unknown, since a sample is missing or the encoder cannot
            tell.
        names: what an input is called in the observations: {"z": "observation.state"}.
        encode: makes the spec's only embedding of an observation, or a dict of inputs: an encoder,
            or the features of the policy itself; an `Encoder` refuses another policy.
        record: a folder for files of incidents, `incident0` and so on. An alarm writes one at once,
            without steps after it; a file that cannot be written is a warning. The monitor needs a
            recorder.

    Attributes:
        monitor: the monitors.
        verdicts: those of the last step; None before the first.

    Raises:
        InputError: an argument is invalid.
        NotKeptError: `record`, and the monitor was opened without a recorder.

    Example:
        >>> guard = etlc.Guard(etlc.Monitor("task.etl", history=600), on_alarm="hand_over")
        >>> answer = guard.step(observation)
    """

    def __init__(
        self,
        monitor: Monitor,
        *,
        on_alarm: Answers = "stop",
        on_fulfilled: Answers = "continue",
        on_unknown: Answers = "continue",
        names: Mapping[str, str] | None = None,
        encode: Callable[[Any], Any] | None = None,
        record: str | os.PathLike[str] | None = None,
    ) -> None:
        self.monitor = monitor
        self.verdicts: Verdicts | None = None
        self._record = None if record is None else Path(record)
        self._on_alarm = self._answers("on_alarm", on_alarm)
        self._on_fulfilled = self._answers("on_fulfilled", on_fulfilled)
        self._on_unknown = self._answers("on_unknown", on_unknown)
        self._encode = encode
        self._names = {name: name for name in monitor.inputs}
        for name in names or {}:
            if name not in self._names:
                raise InputError(no_such("input", name, tuple(self._names)))
        self._names.update(names or {})
        self._embeddings = [one.name for one in monitor.inputs.values() if one.shape]
        if self._record is not None:
            monitor.forget_incidents()
            self._record.mkdir(parents=True, exist_ok=True)

    def _answers(self, option: str, given: Answers) -> dict[str, str]:
        """Returns the answer for each monitor."""
        known = self.monitor.monitors
        by_name = dict.fromkeys(known, given) if isinstance(given, str) else dict(given)
        for name, answer in by_name.items():
            if name not in known:
                raise InputError(no_such("monitor", name, known))
            if answer not in ANSWERS:
                raise InputError(f"{option} is {answer!r}, expected one of {', '.join(ANSWERS)}")
        return {name: by_name.get(name, "continue") for name in known}

    def step(self, observation: Any) -> str:
        """Judges the next observation of the policy.

        Args:
            observation: a dict of arrays, tensors or numbers, as LeRobot and Gymnasium give them;
                or the sample itself, of a spec with one input. A leading dimension of 1, as of a
                batch, does not count. None: the sample is missing.

        Returns:
            "continue", "retry", "hand_over" or "stop".

        Raises:
            InputError: the observation lacks an input, or has one of another shape.

        Warns:
            EtlcWarning: an incident could not be written.
        """
        self.verdicts = self.monitor.step(**self._samples(observation))
        if self._record is not None and self.verdicts.alarms:
            self._write(self._record)
        return max(map(self._answer, self.verdicts), key=ANSWERS.index)

    def _answer(self, verdict: Verdict) -> str:
        if verdict.alarm:
            return self._on_alarm[verdict.name]
        if verdict.fulfilled:
            return self._on_fulfilled[verdict.name]
        return self._on_unknown[verdict.name] if verdict.unknown else "continue"

    def reset(self) -> None:
        """Begins a new episode."""
        self.monitor.reset()
        self.verdicts = None

    def why(self) -> dict[str, str]:
        """The explanation of each alarm of the last step, by monitor.

        Raises:
            NotKeptError: the monitor was opened without a history as long as the episode.
        """
        alarms = [] if self.verdicts is None else self.verdicts.alarms
        return {one.name: one.why.text for one in alarms}

    def _write(self, folder: Path) -> None:
        """Writes the incidents that the last step has begun."""
        self.monitor.close_incidents()
        names = (folder / f"incident{n}" for n in itertools.count())
        try:
            for incident in self.monitor.incidents:
                next(path for path in names if not path.exists()).write_bytes(incident)
        except OSError as error:  # the program must have its answer
            warn(EtlcWarning(f"an incident could not be written: {error}"))
        self.monitor.forget_incidents()

    def _samples(self, observation: Any) -> dict[str, Any]:
        given = dict(observation) if is_mapping(observation) else {}
        if self._encode is not None:
            made = self._encode(observation)
            given.update(made if is_mapping(made) else {self._only(self._embeddings): made})
        elif not is_mapping(observation):
            given[self._only(list(self._names))] = observation
        samples: dict[str, Any] = {}
        for name, called in self._names.items():
            key = name if self._encode is not None and name in given else called
            if key not in given and self.monitor.inputs[name].is_used:
                found = ", ".join(sorted(map(str, given))) or "nothing"
                raise InputError(f"the observation has no {key!r} for the input {name!r}: {found}")
            samples[name] = self._sample(name, given.get(key))
        return samples

    def _only(self, names: list[str]) -> str:
        if len(names) != 1:
            raise InputError(f"a dict of samples is expected: there are {', '.join(names)}")
        return self._names[names[0]] if self._encode is None else names[0]

    def _sample(self, name: str, value: Any) -> Any:
        """Returns a sample without the dimension of a batch of one."""
        if value is None:
            return None
        if hasattr(value, "detach"):  # a tensor of torch, perhaps on another device
            value = value.detach().cpu().numpy()
        array = np.asarray(value)
        wanted = len(self.monitor.inputs[name].shape)
        if array.ndim <= wanted or array.shape[0] != 1:
            return value  # the monitor converts it, or says what is wrong
        while array.ndim > wanted and array.shape[0] == 1:
            array = array[0]
        return array if array.ndim else array.item()
