"""A Gymnasium wrapper that ends a rollout at the first alarm of a monitor, before the action.

    env = StopOnAlarm(env, etlc.Monitor("reach.etl", history=1000), samples)

`samples(observation, action)` returns the samples of a step by the names of the inputs, such as
{"z": encoder(observation["image"]), "gripper": action[-1]}.
"""

from __future__ import annotations

from typing import Any, Callable, Mapping

import gymnasium

import etlc


class StopOnAlarm(gymnasium.Wrapper):
    """Judges each observation with the action that the policy chose for it.

    Where that raises an alarm, the action is not executed: the episode terminates with the same
    observation and no reward. `info["etlc"]` has the verdicts of each step,
    and `info["etlc_alarm"]` the explanation of the first alarm.
    """

    def __init__(
        self,
        env: gymnasium.Env,
        monitor: etlc.Monitor,
        samples: Callable[[Any, Any], Mapping[str, Any]],
    ) -> None:
        super().__init__(env)
        self._monitor = monitor
        self._samples = samples
        self._observation: Any = None

    def reset(self, **arguments: Any) -> tuple[Any, dict[str, Any]]:
        """Begins an episode of the environment and of the monitor."""
        self._observation, info = self.env.reset(**arguments)
        self._monitor.reset()
        return self._observation, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Judges the action, and takes it unless there is an alarm."""
        verdicts = self._monitor.step(**self._samples(self._observation, action))
        for alarm in verdicts.alarms:
            why = self._monitor.explain(alarm.name)
            info = {"etlc": verdicts, "etlc_alarm": why}
            return self._observation, 0.0, True, False, info
        self._observation, reward, terminated, truncated, info = self.env.step(action)
        return self._observation, reward, terminated, truncated, {**info, "etlc": verdicts}
