#!/usr/bin/python3
"""guards_test.py FOLDER: the guards of examples/python end a rollout in the step of the alarm."""

import sys
import unittest
from pathlib import Path
from threading import Event
from types import SimpleNamespace
from unittest.mock import MagicMock, patch

import numpy as np
import stand_ins  # noqa: F401  for the packages that are missing

import etlc

FOLDER = Path(sys.argv.pop())
sys.path.append(str(FOLDER))

import gymnasium  # noqa: E402
import gymnasium_guard  # noqa: E402
import lerobot_guard  # noqa: E402
import py_trees  # noqa: E402
import py_trees_guard  # noqa: E402
from gymnasium import spaces  # noqa: E402
from gymnasium.vector import AutoresetMode, SyncVectorEnv  # noqa: E402
from lerobot.rollout import BaseStrategy, DAggerStrategy, EpisodicStrategy  # noqa: E402


def reach(**answers):
    return etlc.Guard(etlc.Monitor(FOLDER / "reach.etl", history=100), **answers)


def seen_at(x, closed):
    return {"z": np.array([x, 0], "f4"), "gripper": np.float32(closed)}


class Line(gymnasium.Env):
    """An arm on a line: each episode has its speed, and a place where it closes the gripper."""

    metadata = {"render_modes": []}
    observation_space = spaces.Dict({"z": spaces.Box(-9, 9, (2,)), "gripper": spaces.Box(0, 1, ())})
    action_space = spaces.Box(-1, 1, ())

    def __init__(self, episodes):
        self.episodes = iter(episodes)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.x, (self.speed, self.closes_at) = 0.0, next(self.episodes)
        return seen_at(0, 0), {"speed": self.speed}

    def step(self, action):
        self.x += self.speed
        closed = self.closes_at <= self.x <= 1.25
        return seen_at(self.x, closed), 7.0, False, self.x > 2, {"own": self.x}


EPISODES = [(0.125, 0.5), (0.125, 0.875), (0.01, 9), (0.25, 0.75), (0.5, 9), (0.125, 0.125)]


class Gymnasium(unittest.TestCase):
    def guarded(self, episodes, **answers):
        return gymnasium_guard.Guarded(
            Line(episodes), reach(**answers),
            lambda found: float(found.arrives.fulfilled) - float(found.careful.alarm))  # fmt: skip

    def episodes(self, env, n):
        """Returns the place, the reward, both flags and the answer at the end of each."""
        ends = []
        for _ in range(n):
            seen, info = env.reset(seed=1)
            self.assertEqual((seen["z"][0], info["etlc"]), (0, "continue"))
            over = False
            while not over:
                seen, reward, terminated, truncated, info = env.step(np.float32(0))
                over = terminated or truncated
            ends.append((float(seen["z"][0]), reward, terminated, truncated, info["etlc"]))
        return ends

    def test_ends_in_the_step_of_the_alarm(self):
        env = self.guarded(EPISODES[:3])
        (early, right, late) = self.episodes(env, 3)
        self.assertEqual(early, (0.5, -1, True, False, "stop"))
        self.assertEqual(right, (2.125, 1, False, True, "continue"))
        self.assertEqual((late[1:], round(late[0], 2)), ((0, True, False, "stop"), 0.2))
        self.assertEqual(list(env.guard.why()), ["arrives"])

    def test_ends_where_all_is_done_and_leaves_the_reward(self):
        env = gymnasium_guard.Guarded(Line(EPISODES), reach(on_fulfilled={"arrives": "stop"}))
        ends = self.episodes(env, 2)
        self.assertEqual(ends, [(0.5, 7, True, False, "stop"), (0.75, 7, True, False, "stop")])

    def test_ends_by_itself_too(self):
        env = gymnasium_guard.Guarded(Line(EPISODES), reach(on_alarm="continue"))
        self.assertEqual(self.episodes(env, 1), [(2.125, 7, False, True, "continue")])

    def test_all_modes_of_vectors(self):
        lists = [EPISODES, EPISODES[::-1], EPISODES[2:] + EPISODES[:2]]
        alone = [self.episodes(self.guarded(one), 5) for one in lists]
        for mode in AutoresetMode:
            makers = [lambda one=one: self.guarded(one + EPISODES) for one in lists]
            with self.subTest(mode):
                self.assertEqual(self.together(SyncVectorEnv(makers, autoreset_mode=mode)), alone)

    def together(self, envs):
        mode = getattr(envs, "metadata", {}).get("autoreset_mode", getattr(envs, "mode", None))
        ends = [[] for _ in range(3)]
        envs.reset()
        while min(map(len, ends)) < 5:
            seen, rewards, terminated, truncated, infos = envs.step(np.zeros(3, "f4"))
            over = terminated | truncated
            for i in np.flatnonzero(over):
                place, answer = seen["z"][i][0], infos["etlc"][i]
                if mode is AutoresetMode.SAME_STEP:
                    self.assertEqual((place, answer), (0, "continue"))  # of the next episode
                    place = infos["final_obs"][i]["z"][0]
                    answer = infos["final_info"]["etlc"][i]
                ends[i].append((float(place), rewards[i], terminated[i], truncated[i], answer))
            if mode is AutoresetMode.DISABLED and over.any():
                envs.reset(options={"reset_mask": over})
        return [one[:5] for one in ends]


class PyTrees(unittest.TestCase):
    def test_hands_over_in_the_tick_of_the_alarm(self):
        done, status = [], py_trees.common.Status

        class Act(py_trees.behaviour.Behaviour):
            def initialise(self):
                done.append(f"{self.name} begins")

            def update(self):
                done.append(self.name)
                return status.RUNNING

            def terminate(self, new_status):
                done.append(f"{self.name} ends")

        sights = []
        guard = reach(on_alarm="hand_over")
        guarded = py_trees_guard.Guarded("guard", guard, lambda: sights.pop(0))
        watched = py_trees.composites.Sequence("watched", False, [guarded, Act("policy")])
        root = py_trees.composites.Selector("root", False, [watched, Act("person")])
        for _ in range(2):
            sights += [seen_at(0, 0), seen_at(0.5, 0), seen_at(0.5, 1), seen_at(1, 1)]
            for _ in range(2):
                root.tick_once()
            self.assertEqual(done, ["policy begins", "policy", "policy"])
            self.assertEqual((guarded.status, guarded.answer), (status.SUCCESS, "continue"))
            root.tick_once()
            self.assertEqual(done[3:], ["policy ends", "person begins", "person"])
            self.assertEqual((guarded.status, guarded.answer), (status.FAILURE, "hand_over"))
            self.assertRegex(guarded.feedback_message, "hand_over: .*<careful: violated for good")
            root.tick_once()  # an alarm is for good, though `initialise` was called each time
            self.assertEqual(done[6:], ["person"])
            self.assertEqual(guard.monitor.steps, 4)
            guarded.begin()
            root.stop(status.INVALID)
            done.clear()


class Action(np.ndarray):
    """What tensors have, of which LeRobot needs nothing else here."""

    def cpu(self):
        return self

    clone = np.copy


class Robot:
    """Closes its gripper too early from the third observation of the policy on."""

    is_connected = False

    def __init__(self, sights):
        self.sights, self.sent, self.now = sights, [], 0

    inner = property(lambda self: self)

    def get_observation(self):
        """Calls what happens at this tick."""
        x, closed, happens = self.sights[self.now]
        self.now += 1
        happens()
        return seen_at(x, closed)

    def send_action(self, action):
        self.sent.append((self.now, action["arm.pos"]))


class LeRobot(unittest.TestCase):
    def rollout(self, kind, answer, sights):
        """Returns the context after a rollout; sights are functions of the context."""
        ctx = SimpleNamespace()
        cfg = SimpleNamespace(
            strategy=None, fps=1000, interpolation_multiplier=1, duration=0, task="",
            use_torch_compile=False, display_data=False, display_mode="", display_ip=None,
            display_port=None, display_compressed_images=False, play_sounds=False,
            return_to_initial_position=False,
            dataset=SimpleNamespace(episode_time_s=60, reset_time_s=0, num_episodes=1, fps=1000,
                                    single_task="reach", push_to_hub=False))  # fmt: skip
        config = SimpleNamespace(
            record_autonomous=False, num_episodes=9, input_device="keyboard", smooth_handover=False,
            target_video_file_size_mb=1, keyboard=MagicMock(), reset_to_initial_position=False)
        strategy = kind(config)
        robot = Robot([(*seen, lambda act=act: act(ctx, strategy)) for *seen, act in sights])
        engine = MagicMock()
        engine.get_action.side_effect = lambda _: np.array([robot.now], "f4").view(Action)
        teleop = MagicMock(is_connected=False, feedback_features={})
        teleop.get_action.side_effect = lambda: {"arm.pos": -robot.now}
        ctx.__dict__.update(
            runtime=SimpleNamespace(cfg=cfg, shutdown_event=None, cadence_report=None),
            hardware=SimpleNamespace(robot_wrapper=robot, teleop=teleop, initial_position=None),
            policy=SimpleNamespace(inference=engine),
            processors=SimpleNamespace(
                robot_observation_processor=lambda seen: seen,
                robot_action_processor=lambda pair: pair[0],
                teleop_action_processor=lambda pair: pair[0]),
            data=SimpleNamespace(dataset=MagicMock(num_episodes=0), dataset_features={},
                                 hw_features={}, ordered_action_keys=["arm.pos"]))  # fmt: skip

        def build(_, shutdown_event):
            ctx.runtime.shutdown_event = shutdown_event
            return ctx

        def handler(use_threads):
            return SimpleNamespace(shutdown_event=Event())

        named = lerobot_guard.__name__
        with patch(f"{named}.build_rollout_context", build), \
             patch(f"{named}.create_strategy", lambda _: strategy), \
             patch(f"{named}.ProcessSignalHandler", handler), \
             self.assertLogs(level="WARNING") as logs:  # fmt: skip
            lerobot_guard.rollout.__wrapped__(cfg, reach(on_alarm=answer))
        self.assertIn(f"{answer}: Verdicts(<careful: violated for good", "".join(logs.output))
        engine.stop.assert_called_once()
        return ctx, engine, robot

    fine, early = (0.0, 0), (0.5, 1)

    @staticmethod
    def nothing(ctx, strategy):
        pass

    @staticmethod
    def ends(ctx, strategy):
        ctx.runtime.shutdown_event.set()

    def test_stops(self):
        for answer in ("stop", "hand_over", "retry"):
            sights = [(*self.fine, self.nothing)] * 2 + [(*self.early, self.nothing)] * 3
            ctx, engine, robot = self.rollout(BaseStrategy, answer, sights)
            self.assertEqual(robot.sent, [(1, 1), (2, 2)])  # and nothing at the alarm
            self.assertEqual((robot.now, engine.notify_observation.call_count), (3, 3))
            self.assertTrue(ctx.runtime.shutdown_event.is_set())

    def test_hands_over(self):
        def corrects(ctx, strategy):
            strategy._events.request_transition("correction")

        def resumes(ctx, strategy):
            strategy._events.request_transition("pause_resume")

        calm = self.nothing
        sights = [
            (*self.fine, calm), (*self.fine, calm), (*self.early, calm),  # an alarm at the third
            (*self.early, calm), (*self.early, corrects),  # holds, and a person takes over
            (*self.early, calm), (*self.fine, corrects),  # who drives, and gives it back
            (*self.fine, resumes), (*self.fine, calm), (*self.fine, self.ends),
        ]  # fmt: skip
        _, engine, robot = self.rollout(DAggerStrategy, "hand_over", sights)
        self.assertEqual(robot.sent, [
            (1, 1), (2, 2), (4, 2), (5, 2), (6, -6), (7, -7), (8, -7), (9, 9), (10, 10),
        ])  # fmt: skip
        self.assertEqual(engine.notify_observation.call_count, 5)  # none while the person drives

    def test_tries_again(self):
        sights = [(*self.fine, self.nothing), (*self.early, self.nothing)] * 2
        sights += [(*self.fine, self.nothing)] * 2 + [(*self.fine, self.ends)]
        ctx, _, robot = self.rollout(EpisodicStrategy, "retry", sights)
        self.assertEqual(ctx.data.dataset.clear_episode_buffer.call_count, 2)
        ctx.data.dataset.save_episode.assert_called()
        self.assertEqual([at for at, _ in robot.sent], [1, 3, 5, 6, 7])


if __name__ == "__main__":
    unittest.main()
