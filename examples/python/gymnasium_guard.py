"""A Gymnasium wrapper: a guard ends the episode, and gives the reward.

    env = Guarded(env, etlc.Guard(etlc.Monitor("reach.etl"), on_fulfilled={"arrives": "stop"}),
                  reward=lambda verdicts: float(verdicts.arrives.fulfilled))

A vector environment takes a wrapped environment for each of its own, and then any mode is right:
the environment that the guard ends is reset as one that ends by itself, and the guard with it.

    envs = gymnasium.vector.SyncVectorEnv([make_guarded] * 8, autoreset_mode=...)
"""

from __future__ import annotations

from typing import Any, Callable

import gymnasium

import etlc


class Guarded(gymnasium.Wrapper):
    """Judges each observation, the first one too.

    An answer other than "continue" terminates the episode, with the observation that it is about;
    `info["etlc"]` has it, and `guard.why()` the explanation until the next episode.
    `reward` replaces that of the environment.
    """

    def __init__(
        self,
        env: gymnasium.Env,
        guard: etlc.Guard,
        reward: Callable[[etlc.Verdicts], float] | None = None,
    ) -> None:
        super().__init__(env)
        self.guard = guard
        self._reward = reward

    def reset(self, **arguments: Any) -> tuple[Any, dict[str, Any]]:
        """Begins an episode of the environment and of the guard."""
        observation, info = self.env.reset(**arguments)
        self.guard.reset()
        return observation, {**info, "etlc": self.guard.step(observation)}

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Takes the action, and judges what came of it."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        answer = self.guard.step(observation)
        if self._reward is not None and self.guard.verdicts is not None:
            reward = self._reward(self.guard.verdicts)
        ends = terminated or answer != "continue"
        return observation, reward, ends, truncated, {**info, "etlc": answer}
