#!/usr/bin/python3
"""gymnasium_test.py FOLDER: the wrapper of examples/python stops a rollout before the action that
raises an alarm. Without Gymnasium a stand-in has its interface."""

import sys
import types
import unittest
from pathlib import Path

import numpy as np

FOLDER = Path(sys.argv.pop())
try:
    import gymnasium
except ImportError:  # Debian 12 has no package
    gymnasium = types.ModuleType("gymnasium")

    class Env:
        """The methods of gymnasium.Env."""

        def reset(self, *, seed=None, options=None):
            pass

    class Wrapper(Env):
        """The attributes of gymnasium.Wrapper that wrappers use."""

        def __init__(self, env):
            self.env = env

        @property
        def unwrapped(self):
            return self.env

    gymnasium.Env, gymnasium.Wrapper = Env, Wrapper
    sys.modules["gymnasium"] = gymnasium

import etlc  # noqa: E402

sys.path.insert(0, str(FOLDER))
from stop_on_alarm import StopOnAlarm  # noqa: E402


class Line(gymnasium.Env):
    """An arm on a line: an action is a step and the closing of the gripper."""

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.x, self.actions = 0.0, 0
        return np.float32(self.x), {"seed": seed}

    def step(self, action):
        self.x += action[0]
        self.actions += 1
        return np.float32(self.x), 1.0, self.x > 2, self.actions >= 100, {"own": self.actions}


def samples(x, action):
    return {"z": np.array([x, 0], "f4"), "gripper": action[1]}


class Stopping(unittest.TestCase):
    def setUp(self):
        self.monitor = etlc.Monitor(FOLDER / "reach.etl", history=100)
        self.env = StopOnAlarm(Line(), self.monitor, samples)

    def rollout(self, closes_at, speed=0.125):
        """Returns the last result of a step, and the actions that the arm took."""
        x, info = self.env.reset(seed=4)
        self.assertEqual((x, info), (0, {"seed": 4}))
        for _ in range(50):
            x, *others = found = self.env.step((speed, float(closes_at <= x <= 1.25)))
            if others[1] or others[2]:
                break
        return found, self.env.unwrapped.actions

    def test_stops_before_the_action(self):
        for _ in range(2):  # the second episode knows nothing of the first
            (x, reward, terminated, truncated, info), actions = self.rollout(closes_at=0.5)
            self.assertEqual((x, reward, terminated, truncated), (0.5, 0, True, False))
            self.assertEqual(actions, 4)
            self.assertTrue(info["etlc"].careful.alarm)
            self.assertEqual(info["etlc_alarm"].data["monitor"], "careful")
            self.assertIn("closed holds at step 4", info["etlc_alarm"].text)

    def test_leaves_the_others_alone(self):
        (x, reward, terminated, truncated, info), actions = self.rollout(closes_at=0.75)
        self.assertTrue(terminated and not truncated)
        self.assertEqual((reward, info["own"], actions), (1.0, 17, 17))
        self.assertTrue(info["etlc"].arrives.fulfilled)
        self.assertNotIn("etlc_alarm", info)

    def test_stops_where_the_goal_is_out_of_time(self):
        (_, _, terminated, _, info), actions = self.rollout(closes_at=9, speed=0.01)
        self.assertEqual((terminated, actions), (True, 20))
        self.assertEqual([one.name for one in info["etlc"].alarms], ["arrives"])


if __name__ == "__main__":
    unittest.main()
