"""Stands in for Gymnasium, py_trees and LeRobot where they are not installed.

Each has the interface that examples/python uses, and calls it in the order of the package, of which
the versions were Gymnasium 1.4.0, py_trees 2.2.3 and LeRobot 0.6.2.
"""

import enum
import functools
import importlib.util
import sys
import types
from threading import Event

import numpy as np


def offer(name, **content):
    """Makes a module, unless its package is installed."""
    if name.partition(".")[0] not in STOOD_IN:
        return
    module = sys.modules[name] = types.ModuleType(name)
    module.__dict__.update(content)
    package, _, last = name.rpartition(".")
    if package:
        setattr(sys.modules[package], last, module)


STOOD_IN = [name for name in ("gymnasium", "py_trees", "lerobot")
            if importlib.util.find_spec(name) is None]  # fmt: skip


# Gymnasium.
class Env:
    def reset(self, *, seed=None, options=None):
        pass


class Wrapper(Env):
    def __init__(self, env):
        self.env = env


class AutoresetMode(enum.Enum):
    NEXT_STEP, SAME_STEP, DISABLED = "NextStep", "SameStep", "Disabled"


class SyncVectorEnv:
    def __init__(self, makers, *, autoreset_mode=AutoresetMode.NEXT_STEP):
        self.envs, self.mode = [make() for make in makers], autoreset_mode
        self.over = np.zeros(len(makers), bool)

    def reset(self, *, options=None):
        mask = (options or {}).get("reset_mask", np.ones(len(self.envs), bool))
        if mask.all():
            self.seen = [None] * len(self.envs)
        for i in np.flatnonzero(mask):
            self.seen[i], self.over[i] = self.envs[i].reset()[0], False
        return self.together(self.seen), {}

    def step(self, actions):
        infos = {"etlc": np.full(len(self.envs), None, object)}
        rewards, flags = np.zeros(len(self.envs)), np.zeros((2, len(self.envs)), bool)
        for i, env in enumerate(self.envs):
            if self.mode is AutoresetMode.NEXT_STEP and self.over[i]:
                self.seen[i], info = env.reset()
            else:
                assert not (self.mode is AutoresetMode.DISABLED and self.over[i])
                self.seen[i], rewards[i], *flags[:, i], info = env.step(actions[i])
                if self.mode is AutoresetMode.SAME_STEP and flags[:, i].any():
                    for key, value in (("final_obs", self.seen[i]), ("final_info", info)):
                        infos.setdefault(key, np.full(len(self.envs), None, object))[i] = value
                    self.seen[i], info = env.reset()
            infos["etlc"][i] = info["etlc"]
        if "final_info" in infos:  # by key, as all information
            infos["final_info"] = {"etlc": np.array(
                [one and one["etlc"] for one in infos["final_info"]], object)}  # fmt: skip
        self.over = flags.any(axis=0)
        return self.together(self.seen), rewards, *flags, infos

    @staticmethod
    def together(seen):
        return {key: np.stack([one[key] for one in seen]) for key in seen[0]}


offer("gymnasium", Env=Env, Wrapper=Wrapper)
offer("gymnasium.spaces", Box=lambda *_, **__: None, Dict=lambda _: None)
offer("gymnasium.vector", AutoresetMode=AutoresetMode, SyncVectorEnv=SyncVectorEnv)


# py_trees.
class Status(enum.Enum):
    SUCCESS, FAILURE, RUNNING, INVALID = "SUCCESS", "FAILURE", "RUNNING", "INVALID"


class Behaviour:
    def __init__(self, name):
        self.name, self.status, self.feedback_message = name, Status.INVALID, ""

    def initialise(self):
        pass

    def terminate(self, new_status):
        pass

    def stop(self, new_status):
        self.terminate(new_status)
        self.status = new_status

    def tick_once(self):
        if self.status is not Status.RUNNING:
            self.initialise()
        status = self.update()
        if status is not Status.RUNNING:
            self.stop(status)
        self.status = status


class Sequence(Behaviour):
    goes_on = Status.SUCCESS

    def __init__(self, name, memory, children):
        super().__init__(name)
        assert not memory, "the stand-in has no memory"
        self.children = children

    def update(self):
        for at, child in enumerate(self.children):
            child.tick_once()
            if child.status is not self.goes_on:
                self.interrupt(self.children[at + 1 :])
                return child.status
        return self.goes_on

    def stop(self, new_status):
        if new_status is Status.INVALID:
            self.interrupt(self.children)
        super().stop(new_status)

    @staticmethod
    def interrupt(children):
        for child in children:
            if child.status is not Status.INVALID:
                child.stop(Status.INVALID)


class Selector(Sequence):
    goes_on = Status.FAILURE


offer("py_trees")
offer("py_trees.common", Status=Status)
offer("py_trees.behaviour", Behaviour=Behaviour)
offer("py_trees.composites", Sequence=Sequence, Selector=Selector)


# LeRobot's rollout. `_handle_warmup`, interpolation, telemetry and timers are left out.
class RolloutConfig:
    pass


class RolloutStrategy:
    def __init__(self, config):
        self.config = config

    def setup(self, ctx):
        self._engine = ctx.policy.inference
        self._engine.reset()
        self._engine.start()

    def teardown(self, ctx):
        self._engine.stop()

    def tick(self, ctx, seen):
        """Returns the action that was sent, if there was one."""
        seen = ctx.processors.robot_observation_processor(seen)
        self._engine.notify_observation(seen)
        action = self._engine.get_action(seen)
        if action is None:
            return None
        action = dict(zip(ctx.data.ordered_action_keys, map(float, action)))
        ctx.hardware.robot_wrapper.send_action(
            ctx.processors.robot_action_processor((action, seen)))  # fmt: skip
        return action


class BaseStrategy(RolloutStrategy):
    def run(self, ctx):
        self._engine.resume()
        while not ctx.runtime.shutdown_event.is_set():
            seen = ctx.hardware.robot_wrapper.get_observation()
            self.tick(ctx, seen)
            self._engine.pump_query(seen)


class DAggerPhase(enum.Enum):
    AUTONOMOUS, PAUSED, CORRECTING = "autonomous", "paused", "correcting"


class DAggerEvents:
    NEXT = {("autonomous", "pause_resume"): "paused", ("paused", "pause_resume"): "autonomous",
            ("paused", "correction"): "correcting", ("correcting", "correction"): "paused"}

    def __init__(self):
        self.stop_recording = Event()
        self.reset()

    def reset(self):
        self.phase, self.pending = DAggerPhase.AUTONOMOUS, None

    def request_transition(self, event):
        if (self.phase.value, event) in self.NEXT:
            self.pending = event

    def consume_transition(self):
        event, self.pending = self.pending, None
        if event is None:
            return None
        old, self.phase = self.phase, DAggerPhase(self.NEXT[self.phase.value, event])
        return old, self.phase


class DAggerStrategy(RolloutStrategy):
    def __init__(self, config):
        super().__init__(config)
        self._events = DAggerEvents()

    def run(self, ctx):
        robot, last = ctx.hardware.robot_wrapper, None
        self._engine.reset()
        self._events.reset()
        self._engine.resume()
        while not ctx.runtime.shutdown_event.is_set():
            changed = self._events.consume_transition()
            if changed is not None and changed[1] is DAggerPhase.PAUSED:
                self._engine.pause()
            if changed is not None and changed[1] is DAggerPhase.AUTONOMOUS:
                self._engine.reset()
                self._engine.resume()
                last = None
            phase, seen = self._events.phase, robot.get_observation()
            if phase is DAggerPhase.CORRECTING:
                ctx.processors.robot_observation_processor(seen)
                action = ctx.hardware.teleop.get_action()
                last = ctx.processors.robot_action_processor((action, seen))
                robot.send_action(last)
            elif phase is DAggerPhase.PAUSED:
                if last:
                    robot.send_action(last)
            else:
                last = self.tick(ctx, seen) or last
        self._engine.pause()


class EpisodicStrategy(RolloutStrategy):
    def setup(self, ctx):
        super().setup(ctx)
        self._events = dict.fromkeys(("exit_early", "rerecord_episode", "stop_recording"), False)

    def run(self, ctx):
        events, dataset, recorded = self._events, ctx.data.dataset, 0
        while recorded < ctx.runtime.cfg.dataset.num_episodes and not events["stop_recording"]:
            if ctx.runtime.shutdown_event.is_set():
                break
            self._engine.reset()
            self._engine.resume()
            while not ctx.runtime.shutdown_event.is_set():
                if events["exit_early"]:
                    events["exit_early"] = False
                    break
                if self.tick(ctx, ctx.hardware.robot_wrapper.get_observation()) is not None:
                    dataset.add_frame({})
            if events["rerecord_episode"]:
                events["rerecord_episode"] = events["exit_early"] = False
                dataset.clear_episode_buffer()
                continue
            dataset.save_episode()
            recorded += 1


def wrap():
    """The configuration is from the command line, and the other arguments from the call."""
    return lambda function: functools.wraps(function)(
        lambda *others: function(RolloutConfig(), *others))  # fmt: skip


offer("lerobot")
offer("lerobot.configs", parser=types.SimpleNamespace(wrap=wrap))
offer("lerobot.rollout", RolloutConfig=RolloutConfig, BaseStrategy=BaseStrategy,
      DAggerStrategy=DAggerStrategy, EpisodicStrategy=EpisodicStrategy,
      build_rollout_context=None, create_strategy=None)
offer("lerobot.scripts", lerobot_rollout=None)
offer("lerobot.utils")
offer("lerobot.utils.import_utils", register_third_party_plugins=None)
offer("lerobot.utils.process",
      ProcessSignalHandler=lambda use_threads: types.SimpleNamespace(shutdown_event=Event()))
offer("lerobot.utils.utils", init_logging=None)
