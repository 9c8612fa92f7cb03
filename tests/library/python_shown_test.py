#!/usr/bin/python3
"""What notebooks show of results: small tables, timelines, frames of pandas and figures."""

import html.parser
import json
import struct
import sys
import unittest
import warnings
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from unittest import mock

import numpy as np

import etlc

SPEC = """spec shown;
rate 10 Hz;
input z : f32[2];
input x : f32;
target goal = [[0, 0]];
predicate near = l2(z, goal) <= 0.5;
predicate high = x > 1;
monitor arrives = F near;
monitor calm = G !high;
sliding monitor soon = F[0, 3 steps] near;
"""


MASK = (1 << 64) - 1
PRIMES = (11400714785074694791, 14029467366897019727, 1609587929392839161, 9650029242287828579,
          2870177450012600261)  # fmt: skip


def xxh64(data):
    """XXH64 with the seed 0, by its specification."""
    def turned(x, bits):
        return (x << bits | x >> (64 - bits)) & MASK

    def round_of(lane, word):
        return turned((lane + word * PRIMES[1]) & MASK, 31) * PRIMES[0] & MASK

    one, two, three, four, five = PRIMES
    lanes = [(one + two) & MASK, two, 0, -one & MASK]
    whole = len(data) // 32 * 32
    for at in range(0, whole, 32):
        words = struct.unpack_from("<4Q", data, at)
        lanes = [round_of(lane, word) for lane, word in zip(lanes, words)]
    found = five
    if whole > 0:
        found = sum(turned(lane, bits) for lane, bits in zip(lanes, (1, 7, 12, 18))) & MASK
        for lane in lanes:
            found = ((found ^ round_of(0, lane)) * one + four) & MASK
    found = (found + len(data)) & MASK
    rest = len(data) - whole
    for at in range(whole, whole + rest // 8 * 8, 8):
        (word,) = struct.unpack_from("<Q", data, at)
        found = (turned(found ^ round_of(0, word), 27) * one + four) & MASK
    at = whole + rest // 8 * 8
    if rest % 8 >= 4:
        (word,) = struct.unpack_from("<I", data, at)
        found = (turned(found ^ word * one & MASK, 23) * two + three) & MASK
        at += 4
    for byte in data[at:]:
        found = turned(found ^ byte * five & MASK, 11) * one & MASK
    for bits, prime in ((33, two), (29, three)):
        found = (found ^ found >> bits) * prime & MASK
    return found ^ found >> 32


class Words(html.parser.HTMLParser):
    """The cells of tables, and whether each element is closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.cells = [], []
        self.feed(text)
        assert not self.open, self.open

    def handle_starttag(self, tag, _):
        self.open.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] in (["td"], ["th"]):
            self.cells[-1] += data


def arrays(steps=40):
    x = np.linspace(2, 0, steps, dtype="f4")
    return {"z": np.stack([x, 0 * x], axis=1), "x": np.where(x < 0.3, 2.0, 0.0)}


class Showing(unittest.TestCase):
    def setUp(self):
        self.monitor = etlc.Monitor(text=SPEC, history=50)

    def test_tables(self):
        shown = Words(self.monitor._repr_html_()).cells
        for cell in ("float32[2]", "F near", "l2(z, goal) <= 0.5", "G !high"):
            self.assertIn(cell, shown)
        verdicts = self.monitor.step(z=[0, 0], x=2.0)
        self.assertIn("violated for good", Words(verdicts.calm._repr_html_()).cells)
        self.assertIn("satisfied for good", Words(verdicts._repr_html_()).cells)
        self.assertIn("undecided", Words(verdicts._repr_html_()).cells)
        batch = self.monitor.batch(3)
        together = batch.step(z=np.zeros((3, 2), "f4"), x=[2.0, 0, np.nan])
        row = Words(together._repr_html_()).cells
        at = row.index("calm")
        self.assertEqual(row[at : at + 5], ["calm", "1", "1", "1", "1"])
        self.assertIn("x", Words(batch._repr_html_()).cells)
        self.assertIn("after step", verdicts.calm.why._repr_html_())

    def test_text_of_users_is_escaped(self):
        text = etlc.Explanation('<script>&"\x1b[0m', {})._repr_html_()
        self.assertEqual(text, "<pre>&lt;script&gt;&amp;&quot;\\x1b[0m</pre>")

    def test_timelines(self):
        episode = self.monitor.run(arrays(), distances=True)
        picture = ElementTree.fromstring(episode.svg())
        kinds = [one.get("class") for one in picture.iter()]
        self.assertEqual(kinds.count("line"), len(episode.distances) + 3)
        self.assertEqual(kinds.count("name"), len(episode.distances) + 3)
        self.assertEqual(kinds.count("violated so-far"), 1)  # arrives, at first
        self.assertEqual(kinds.count("violated"), 2)  # calm in the end, soon at first
        self.assertIn("time, s", [one.text for one in picture.iter()])
        of = [one for one in picture.iter() if one.get("class") in ("name", "violated")]
        violated = next(b for a, b in zip(of, of[1:]) if a.text == "calm")
        first = episode.calm.first_alarm
        self.assertAlmostEqual(float(violated.get("x")), (first - 0.5) / 39 * 816, delta=0.06)
        self.assertIn("<svg", episode._repr_html_())
        alone = ElementTree.fromstring(self.svg_of(episode.calm))
        self.assertEqual([one.get("class") for one in alone.iter()].count("line"), 1)

    def svg_of(self, verdicts):
        text = verdicts._repr_html_()
        return text[text.index("<svg") :]

    def test_a_line_goes_through_the_extremes_of_each_pixel(self):
        steps = 100_000
        given = {"z": np.zeros((steps, 2), "f4"), "x": np.zeros(steps, "f4")}
        given["x"][54_321] = 8
        episode = self.monitor.run(given)
        given["x"][54_321] = 0
        picture = ElementTree.fromstring(episode.svg())
        self.assertLess(len(episode.svg()), 200_000)
        lines = [one.get("d") for one in picture.iter() if one.get("class") == "line"]
        heights = [float(point.split()[1]) for point in lines[1][1:].split("L")]
        self.assertGreater(max(heights) - min(heights), 50)

    def test_strange_episodes(self):
        monitor = etlc.Monitor(text=SPEC.replace("rate 10 Hz;", ""))
        for steps, values in ((1, 0.0), (2, np.nan), (5, 1e30), (3, np.inf)):
            x = np.full(steps, values)
            episode = self.quiet(monitor, steps, x)
            shown = episode._repr_html_()
            ElementTree.fromstring(episode.svg())
            self.assertNotIn("nan", shown)
            self.assertNotIn("inf", episode.svg())
        empty = monitor.run(z=np.zeros((0, 2), "f4"), x=np.zeros(0, "f4"))
        self.assertIn("0 steps", empty._repr_html_())

    def quiet(self, monitor, steps, x):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", etlc.EtlcWarning)
            return monitor.run(z=np.full((steps, 2), np.nan), x=x, distances=True)

    def test_distances_are_those_of_each_step(self):
        episode = self.monitor.run(arrays(), distances=True)
        plain = self.monitor.run(arrays())
        self.assertEqual(plain.distances, {})
        for field in plain.table.dtype.names:
            np.testing.assert_array_equal(plain.table[field], episode.table[field])
        self.monitor.reset()
        for step, (z, x) in enumerate(zip(*arrays().values())):
            self.monitor.step(z=z, x=x)
            for name in self.monitor.predicates:
                found = self.monitor.measure(name)
                np.testing.assert_equal(episode.distances[name][step], np.float32(found.distance))
                self.assertEqual(episode.thresholds[name][step], np.float32(found.threshold))
        for wrong in (1, "yes", np.zeros(40)):
            with self.assertRaisesRegex(etlc.InputError, "distances is .*, expected True or False"):
                self.monitor.run(arrays(), distances=wrong)
        masked = np.ma.masked_array(arrays()["x"], mask=np.arange(40) % 3 == 0)
        strided = {"z": np.asfortranarray(arrays()["z"]), "x": masked}
        found = self.monitor.run(strided, distances=True)
        for field in plain.table.dtype.names:
            np.testing.assert_array_equal(
                found.table[field], self.monitor.run(strided).table[field]
            )

    def test_without_pandas_or_matplotlib(self):
        episode = self.monitor.run(arrays())
        for module, call in (("pandas", episode.to_pandas), ("matplotlib.pyplot", episode.plot)):
            with mock.patch.dict(sys.modules, {module: None}):
                with self.assertRaisesRegex(ImportError, "pip install (pandas|matplotlib)$"):
                    call()


@unittest.skipUnless(__import__("importlib.util").util.find_spec("pandas"), "no pandas")
class Frames(unittest.TestCase):
    def setUp(self):
        self.monitor = etlc.Monitor(text=SPEC)

    def test_of_an_episode(self):
        episode = self.monitor.run(arrays(), distances=True)
        frame = episode.to_pandas()
        self.assertEqual(len(frame), 120)
        calm = frame[frame.monitor == "calm"]
        np.testing.assert_array_equal(calm.robustness, episode.calm.robustness)
        np.testing.assert_array_equal(calm.step, np.arange(40))
        np.testing.assert_array_equal(calm.status, episode.calm.status)
        np.testing.assert_array_equal(calm.distance_near, episode.distances["near"])
        self.assertEqual(len(episode.calm.to_pandas()), 40)

    def test_of_others(self):
        frame = self.monitor.step(z=[0, 0], x=2.0).to_pandas()
        self.assertEqual(frame.loc["calm", "status"], "violated")
        batch = self.monitor.batch(2)
        z = np.zeros((2, 3, 2), "f4")
        frame = batch.step(z=z[:, 0], x=[2.0, 0]).to_pandas()
        self.assertEqual(frame.environment.tolist(), [0, 0, 0, 1, 1, 1])
        plans = batch.ahead(z=z[:, None], x=np.zeros((2, 1, 3)))
        self.assertEqual(list(plans.to_pandas().columns[:4]),
                         ["environment", "plan", "step", "monitor"])  # fmt: skip
        runs = batch.run(z=z, x=np.zeros((2, 3)))
        self.assertEqual(list(runs.to_pandas().columns[:3]), ["row", "step", "monitor"])


@unittest.skipUnless(__import__("importlib.util").util.find_spec("matplotlib"), "no matplotlib")
class Figures(unittest.TestCase):
    def test_of_an_episode(self):
        import matplotlib

        matplotlib.use("agg")
        monitor = etlc.Monitor(text=SPEC)
        episode = monitor.run(arrays(), distances=True)
        figure = episode.plot()
        self.assertEqual(len(figure.axes), len(episode.distances) + 3)
        drawn = figure.axes[0].lines[0].get_ydata()
        np.testing.assert_array_equal(drawn, next(iter(episode.distances.values())))
        self.assertEqual(figure.axes[-1].get_xlabel(), "time, s")
        figure.canvas.draw()
        self.assertEqual(len(episode.calm.plot().axes), 1)

    def test_of_an_evaluation(self):
        path = Path(__file__).parent.parent / "evaluate" / "dock.expected.json"
        found = etlc.Evaluation(json.loads(path.read_text()), "")
        figure = found.plot()
        self.assertEqual([ax.get_title("left") for ax in figure.axes],
                         ["f1", "precision", "recall", "agreement"])  # fmt: skip
        labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
        self.assertEqual(labels[::-1][:2], ["near frames", "arrive steps"])
        (low, high), (point,) = (line.get_xdata() for line in figure.axes[0].lines[-2:])
        figures = found.data["predicates"]["near"]
        self.assertEqual(([low, high], point), (figures["f1_interval"], figures["f1"]))
        cells = Words(found._repr_html_()).cells
        self.assertIn("0.8065 [0.652, 0.886]", cells)
        figure.canvas.draw()


class Kept(unittest.TestCase):
    def test_pickles_of_another_version_are_refused(self):
        import pickle

        monitor = etlc.Monitor(text=SPEC)
        monitor.step(x=1.0)
        reopen, (opened, state, *rest) = monitor.__reduce__()
        version = etlc.__version__.encode()
        other = state[:-8].replace(version, b"9" * len(version), 1)
        other += struct.pack("<Q", xxh64(other))
        with self.assertRaisesRegex(etlc.Error, f"saved by etlc 99+, this is {etlc.__version__}"):
            reopen(opened, other, *rest)
        for damaged in (state[:8] + b"9" + state[9:], state[:-1], b"", state + b"x"):
            with self.assertRaises(etlc.Error) as raised:
                reopen(opened, damaged, *rest)
            self.assertRegex(str(raised.exception), "etlc_save|version|state")
        self.assertEqual(pickle.loads(pickle.dumps(monitor)).steps, 1)
        episode = monitor.run(arrays(), distances=True)
        again = pickle.loads(pickle.dumps(episode))
        self.assertTrue(again == episode and again.texts == episode.texts)

    def test_arrays_of_other_devices(self):
        class Tensor:
            device = "cuda:0"

            def __array__(self, *_):
                raise TypeError("can't convert cuda:0 device type tensor to numpy")

        monitor = etlc.Monitor(text=SPEC)
        for call in (lambda: monitor.step(z=Tensor()), lambda: monitor.run(z=Tensor()),
                     lambda: monitor.batch(2).step(z=Tensor()),
                     lambda: monitor.ahead(z=Tensor())):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, r"cuda:0.*x\.detach\(\)\.cpu\(\)\.numpy"):
                call()


if __name__ == "__main__":
    unittest.main()
