#!/usr/bin/python3
"""What policies do, as docs/recipes.md measures it, against numpy on random chunks with gaps:
30,000 chunks, or with ETLC_EFFORT in the environment a million."""

import os
import unittest

import numpy as np

import etlc

ACTIONS, SIZE = 4, 2  # of a chunk, of an action
PARTS = (ACTIONS - 1) * SIZE
EYE = np.eye(ACTIONS * SIZE)
SPEC = f"""spec actions;
input chunk : f32[{ACTIONS * SIZE}];
input hand : f32[{SIZE}];
input half : f16[{SIZE}];
input byte : i8[{SIZE}] scale 0.1;
projection head = {EYE[:PARTS].astype(int).tolist()} in plans;
projection tail = {EYE[SIZE:].astype(int).tolist()} in plans;
target none = {[[0] * SIZE]};
target start = {[[0] * PARTS]} of head(chunk);
sliding monitor kept = l2(head(chunk), tail(chunk@1)) <= 0;
sliding monitor kept_too = linf(head(chunk) - tail(chunk@1), start) <= 0;
sliding monitor reversal = cosine(hand - hand@1, hand@1 - hand@2) <= 0;
sliding monitor idle = l2(hand, hand@3) <= 0;
sliding monitor jerk = linf(hand - 3 * hand@1 + 3 * hand@2 - hand@3, none) <= 0;
sliding monitor expected = l2(hand, 2 * hand@1 - hand@2) <= 0;
sliding monitor mixed = linf(0.3 * (half - byte)@1 + hand, none) <= 0;
sliding monitor cusum =
    max(2 * mean(l2(hand, hand@1) - 1, 2 steps), 8 * mean(l2(hand, hand@1) - 1, 8 steps)) <= 0;
"""


def samples(episodes, steps, seed=1):
    """Returns arrays with these leading axes; some rows of `chunk` and `hand` are missing."""
    random = np.random.default_rng(seed)
    lead = (episodes, steps)
    result = {
        "chunk": random.normal(size=(*lead, ACTIONS * SIZE)).astype("f4"),
        "hand": random.normal(size=(*lead, SIZE)).astype("f4"),
        "half": random.normal(size=(*lead, SIZE)).astype("f2"),
        "byte": random.integers(-128, 128, (*lead, SIZE)).astype("i1"),
    }
    for name in ("chunk", "hand"):
        result[name][random.random(lead) < 0.03] = np.nan
    return result


def ago(x, steps):
    """Returns what x was; NaN before the first step."""
    if steps == 0:
        return x
    return np.concatenate([np.full_like(x[:, :steps], np.nan), x[:, :-steps]], axis=1)


def length(x):
    return np.sqrt((x.astype("f8") ** 2).sum(-1))


def window(x, steps):
    """Returns the sum of the last values, this one included."""
    return sum(ago(x, n) for n in range(steps))


class Policies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        episodes = 2000 if "ETLC_EFFORT" in os.environ else 60
        cls.samples = samples(episodes, 500)
        cls.verdicts = etlc.Monitor(text=SPEC).batch(episodes).run(**cls.samples)

    def measured(self, monitor):
        """Returns the distance at each step, NaN where it is unknown: of `d <= 0` rho is -d."""
        verdict = getattr(self.verdicts, monitor)
        known = verdict.lower == verdict.upper
        return np.where(known, -verdict.robustness.astype("f8"), np.nan)

    def expect(self, monitor, expected, error=0.0):
        measured = self.measured(monitor)
        self.assertGreater(np.isfinite(expected).mean(), 0.5)
        np.testing.assert_array_equal(np.isnan(measured), np.isnan(expected))
        np.testing.assert_allclose(measured, expected, rtol=error, atol=error)

    def test_consistency(self):
        chunk = self.samples["chunk"]
        apart = chunk[..., :PARTS] - ago(chunk, 1)[..., SIZE:]  # in float32
        self.expect("kept_too", np.abs(apart).max(-1))
        self.expect("kept", length(apart), 1e-6)

    def test_reversals(self):
        hand = self.samples["hand"]
        now, before = hand - ago(hand, 1), ago(hand, 1) - ago(hand, 2)
        dot = (now.astype("f8") * before).sum(-1)
        self.expect("reversal", 1 - dot / (length(now) * length(before)), 2e-6)

    def test_idle(self):
        hand = self.samples["hand"]
        self.expect("idle", length(hand - ago(hand, 3)), 1e-6)

    def test_jerk_to_the_bit(self):
        hand, three = self.samples["hand"], np.float32(3)
        jerk = hand - three * ago(hand, 1) + three * ago(hand, 2) - ago(hand, 3)
        self.expect("jerk", np.abs(jerk).max(-1))
        self.expect("expected", length(hand - (2 * ago(hand, 1) - ago(hand, 2))), 2e-6)

    def test_narrow_inputs_to_the_bit(self):
        half = self.samples["half"].astype("f4")
        byte = self.samples["byte"].astype("f4") * np.float32(0.1)
        mixed = np.float32(0.3) * ago(half - byte, 1) + self.samples["hand"]
        self.expect("mixed", np.abs(mixed).max(-1))

    def test_cusum(self):
        hand = self.samples["hand"]
        excess = length(hand - ago(hand, 1)) - 1
        self.expect("cusum", np.maximum(window(excess, 2), window(excess, 8)), 1e-5)


if __name__ == "__main__":
    unittest.main()
