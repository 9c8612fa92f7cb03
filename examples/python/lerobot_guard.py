#!/usr/bin/env python3
"""lerobot-rollout with a guard, which judges each observation before the policy acts on it.

    python3 lerobot_guard.py --policy.path=... --robot.type=... --strategy.type=dagger ...

It takes the options of lerobot-rollout (LeRobot 0.6), except --interactive.
At an alarm the policy sends no action any more, from this tick on, and

- "hand_over": the strategy `dagger` pauses, and holds the robot until a person takes over;
- "retry": the strategy `episodic` discards the episode, and records it once more;
- "stop", and these where the strategy is another: the rollout ends, as at Ctrl-C. Then LeRobot
  drives the robot to where it began, unless --return_to_initial_position=false.
"""

import logging

import etlc
from lerobot.configs import parser
from lerobot.rollout import (
    DAggerStrategy,
    EpisodicStrategy,
    RolloutConfig,
    build_rollout_context,
    create_strategy,
)
from lerobot.scripts import lerobot_rollout  # noqa: F401  knows robots, cameras, teleoperators
from lerobot.utils.import_utils import register_third_party_plugins
from lerobot.utils.process import ProcessSignalHandler
from lerobot.utils.utils import init_logging


class Guarded:
    """An inference engine of LeRobot with a guard.

    A strategy calls `notify_observation` with what the policy is about to act on, and with nothing
    else, neither while a person drives nor between episodes; and `reset` where the policy begins.
    """

    def __init__(self, engine, guard, strategy, shutdown):
        self._engine, self._guard, self._strategy = engine, guard, strategy
        self._shutdown = shutdown
        self._answer = "continue"

    def __getattr__(self, name):  # the rest of the interface
        return getattr(self._engine, name)

    def reset(self):
        self._engine.reset()
        self._guard.reset()
        self._answer = "continue"

    def notify_observation(self, obs):
        self._engine.notify_observation(obs)
        self._answer = self._guard.step(obs)
        if self._answer == "continue":
            return
        if self._answer == "hand_over" and isinstance(self._strategy, DAggerStrategy):
            self._strategy._events.request_transition("pause_resume")  # as its key does
        elif self._answer == "retry" and isinstance(self._strategy, EpisodicStrategy):
            self._strategy._events.update(rerecord_episode=True, exit_early=True)  # likewise
        else:
            self._shutdown.set()
        logging.warning("%s: %s", self._answer, self._guard.verdicts)

    def get_action(self, obs_frame):
        return self._engine.get_action(obs_frame) if self._answer == "continue" else None


@parser.wrap()
def rollout(cfg: RolloutConfig, guard: etlc.Guard):
    shutdown = ProcessSignalHandler(use_threads=True).shutdown_event
    ctx = build_rollout_context(cfg, shutdown)
    strategy = create_strategy(cfg.strategy)
    ctx.policy.inference = Guarded(ctx.policy.inference, guard, strategy, shutdown)
    try:
        strategy.setup(ctx)
        strategy.run(ctx)
    finally:
        strategy.teardown(ctx)


if __name__ == "__main__":
    init_logging()
    register_third_party_plugins()
    eye = etlc.Encoder("task.etl")  # your spec; or a function of your own, of images
    monitor = etlc.Monitor("task.etl", recorder=(60, 0, 9))
    rollout(etlc.Guard(monitor, on_alarm="hand_over", record="incidents",
                       names={"gripper": "gripper.pos"}, encode=lambda seen: eye(seen["front"])))
