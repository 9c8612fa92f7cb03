#!/usr/bin/python3
"""The Python package, used by mistake: no argument is misread, and no mistake is silent.

python_mistakes_test.py PAGE: PAGE is docs/python.md.
"""

import inspect
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

import etlc
from python_arrays_test import SPEC, episode

PAGE = Path(sys.argv.pop()).resolve()

DOUBTFUL = """spec doubtful;
input x : f32;
predicate high = x > 1;
monitor stays = F G high;
"""


def caught(call):
    """Returns the result of a call, and its warnings."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        return call(), found


class Truth(unittest.TestCase):
    """Returns one instance of each public class."""

    def instances(self):
        monitor = etlc.Monitor(text=SPEC, history=1)
        steps = monitor.run(episode())
        monitor.reset()
        verdicts = monitor.step(x=1.0)
        place = etlc.Diagnostic("E0204", "error", "m")
        batch = monitor.batch(2)
        plans = monitor.ahead(x=np.zeros((2, 3), "f4"))
        together = batch.step(x=[1.0, 2.0])
        made = [
            batch, plans, plans.high, together, together.high, batch.measure("is_high"),
            monitor, steps, steps.high, verdicts, verdicts.high, verdicts.high.why,
            monitor.measure("is_high"), etlc.Drift(False, 1, 100, (0,) * 8),
            monitor.inputs["x"], place, etlc.Written(Path("f"), "r"),
            etlc.Evaluation({}, "r"), etlc.EtlcWarning("w"), etlc.Checked(),
            etlc.Suggestions({}), etlc.Run(steps, np.zeros((30, 6))),
            etlc.Labelling.__new__(etlc.Labelling), etlc.Watching.__new__(etlc.Watching),
            etlc.Proof("c"), etlc.Guard(monitor), etlc.Encoder.__new__(etlc.Encoder),
        ]  # fmt: skip
        made += [
            getattr(etlc, name)("m") for name in etlc.__all__ if name.endswith("Error")
        ]
        return {type(one).__name__: one for one in made}

    def test_raises_or_is_documented_as_safe(self):
        instances = self.instances()
        classes = {name for name in etlc.__all__ if inspect.isclass(getattr(etlc, name))}
        self.assertEqual(set(instances), classes)
        text = PAGE.read_text()
        safe = text[text.index("Always true"):].split("\n\n")[0]
        raising = []
        for name, one in instances.items():
            is_safe = f"`{name}`" in safe or isinstance(one, (etlc.Error, Warning))
            if is_safe:
                self.assertIs(bool(one), True, name)
            else:
                raising.append(name)
                self.expect_ambiguous(one)
        for name in (
            "Verdict", "Verdicts", "EpisodeVerdicts", "Episode", "Measurement", "Measurements",
            "BatchVerdicts", "BatchEpisode", "VerdictArrays", "RunVerdicts",
        ):  # fmt: skip
            self.assertIn(name, raising)
        self.assertIn("exceptions and warnings", " ".join(safe.split()))

    def expect_ambiguous(self, one):
        numbers = np.array([1, 2])
        for mistake in (
            lambda: bool(one), lambda: not one, lambda: one and 1, lambda: one or 1,
            lambda: 1 if one else 2, lambda: any([one]), lambda: all([one]),
            lambda: list(filter(None, [one])), lambda: [0 for _ in "a" if one],
            lambda: one == True, lambda: one != False, lambda: one == "violated",  # noqa: E712
            lambda: "alarm" == one, lambda: one == 0, lambda: one != np.float32(1),
            lambda: np.float32(1) == one, lambda: one == numbers, lambda: numbers == one,
            lambda: one in ("satisfied", "violated"), lambda: np.array([one, one], "O").any(),
        ):  # fmt: skip
            with self.assertRaises(etlc.AmbiguousError, msg=inspect.getsource(mistake)) as raised:
                mistake()
            named = [word.strip(".,:()[-1]") for word in str(raised.exception).split()
                     if word.startswith(".")]  # fmt: skip
            self.assertTrue(named)
        for mistake in (lambda: one < 0, lambda: one >= 0, lambda: float(one), lambda: int(one),
                        lambda: np.isnan(one), lambda: one + 1, lambda: np.any(one),
                        lambda: np.all(one)):  # fmt: skip
            with self.assertRaises(TypeError):
                mistake()
        self.assertIsInstance(raised.exception, ValueError)
        self.assertFalse(one == None)  # noqa: E711
        self.assertTrue(one is not None and one == one)
        self.assertIn(one, [one])

    def test_every_name_in_the_message_is_there(self):
        for name, one in self.instances().items():
            try:
                bool(one)
            except etlc.AmbiguousError as error:
                asked = one
                if isinstance(one, etlc.Verdicts):
                    self.assertTrue(hasattr(one, "alarms"))
                    asked = one.high
                if isinstance(one, (etlc.Episode, etlc.BatchEpisode, etlc.BatchVerdicts)):
                    asked = one.high
                words = str(error).replace("(", " ").replace("[", " ").replace(",", " ").split()
                named = [word.strip(".") for word in words if word.strip(".") and word[0] == "."]
                named = [word.split(".")[0] for word in named if word != "alarms"]
                self.assertTrue(named, name)
                for attribute in named:
                    self.assertTrue(hasattr(asked, attribute), f"{name}.{attribute}")

    def test_mistakes_with_what_is_in_it(self):
        monitor = etlc.Monitor(text=SPEC)
        verdicts = monitor.step(x=1.0)
        steps = monitor.run(episode())
        for group in (verdicts, steps):
            for one in ("high", "violated", True, 0, None):
                with self.assertRaises(etlc.AmbiguousError):
                    one in group
            self.assertTrue(all(one in group for one in list(group)))
            for mistake in (any, all):
                with self.assertRaises(etlc.AmbiguousError):
                    mistake(group)

    def test_those_that_say_the_same_are_equal(self):
        first, second = (etlc.Monitor(text=SPEC) for _ in range(2))
        self.assertEqual(first.step(x=1.0), second.step(x=1.0))
        said, other = first.step(x=2.0), second.step(x=60.0)
        self.assertNotEqual(said, other)
        self.assertNotEqual(said.high, other.high)
        self.assertEqual(said.goes, other.goes)
        self.assertEqual(len({said.goes, other.goes, said.high}), 2)
        self.assertNotEqual(said.high, said.goes)
        self.assertEqual(first.run(episode()), second.run(episode()))
        self.assertNotEqual(first.run(episode()), second.run(episode(29)))


class Refusing(unittest.TestCase):
    def test_texts_that_are_none(self):
        with tempfile.TemporaryDirectory() as folder:
            spec = Path(folder) / "t.etl"
            spec.write_text(SPEC)
            monitor = etlc.Monitor(spec)
            verdicts, steps = monitor.step(), monitor.run(episode())
            monitor.reset()
            for text in ("a\ud800b", "a\udcffb", "a\0b"):
                mistakes = [
                    lambda: etlc.Monitor(text), lambda: etlc.Monitor(Path(text)),
                    lambda: etlc.Monitor(text=text), lambda: etlc.Monitor(spec, thresholds=text),
                    lambda: etlc.Monitor(spec, fitted=text), lambda: monitor.measure(text),
                    lambda: etlc.Monitor(spec, settings={"n": text}), lambda: verdicts[text],
                    lambda: etlc.Monitor(spec, settings={text: 1}), lambda: monitor.let(text),
                    lambda: etlc.Monitor(spec, recorder=text), lambda: steps[text],
                    lambda: etlc.Monitor(spec, recorder=(text, 1, 1)),
                    lambda: etlc.Monitor(spec, values=text), lambda: monitor.restart(text),
                    lambda: etlc.Monitor(spec, targets_as=text), lambda: monitor.explain(text),
                    lambda: monitor.step(**{text: 1}), lambda: monitor.run({text: [1.0]}),
                    lambda: monitor.sample_counts(text), lambda: monitor.position(text),
                    lambda: monitor.step(stop=text), lambda: etlc.evaluate(spec, text),
                    lambda: etlc.calibrate(text, spec), lambda: etlc.calibrate(spec, [text]),
                    lambda: etlc.fit(spec, spec, output=text), lambda: etlc.embed(text),
                    lambda: etlc.fit(spec, spec, names={"x": text}), lambda: etlc.embed(spec, text),
                    lambda: etlc.incident(spec, text), lambda: etlc.incident(spec, b"", form=text),
                    lambda: etlc.calibrate(spec, spec, groups=text),
                    lambda: etlc.calibrate(spec, spec, settings={"n": text}),
                ]  # fmt: skip
                refused = 0
                for mistake in mistakes:
                    try:  # an unused file may have any name
                        mistake()
                    except etlc.Error:
                        refused += 1
                self.assertGreaterEqual(refused, len(mistakes) - (2 if "\udcff" in text else 0))
            with self.assertRaisesRegex(etlc.InputError, r"spec 'a\\ud800' has '\\ud800' in it"):
                etlc.Monitor("a\ud800")

    def test_options_that_are_none(self):
        for options, words in (
            ({"history": 1.5}, "history is 1.5, expected a whole number from 0 on"),
            ({"history": "1"}, "history is '1'"), ({"max_state": None}, "max_state is None"),
            ({"history": 2**50}, "^history is 1125899906842624, expected at most"),
            ({"values": None}, "values is None, expected robustness or boolean"),
            ({"thresholds": 7}, "thresholds is 7"), ({"thresholds": ""}, "thresholds is '', exp"),
            ({"fitted": ""}, "fitted is ''"), ({"spec": ""}, "spec is ''"),
            ({"text": 7}, "text is 7, expected a str"), ({"text": b"s"}, "text is b's', expected"),
            ({"text": None}, "there is no spec: pass its path, or text="),
            ({"recorder": (1, 2)}, "^recorder: found '1,2', expected BEFORE,AFTER,INCIDENTS"),
            ({"recorder": 5}, r"recorder is 5, expected \(before, after, alarms\)"),
            ({"settings": [1]}, r"settings is \[1\], expected a dict"),
            ({"settings": "n=1"}, "settings is 'n=1', expected a dict"),
            ({"settings": {"n": None}}, "^settings takes NAME=NUMBER .*, not 'n=None'"),
            ({"lets": "no"}, "lets is 'no', expected True or False"),
            ({"threads": True}, "threads is True, expected a whole number from 1 on"),
        ):
            with self.assertRaisesRegex(etlc.InputError, words):
                etlc.Monitor(**{"text": SPEC, **options})
        self.assertEqual(etlc.Monitor(text=SPEC, history=np.int64(3)).name, "all_types")


    def test_samples_without_their_names(self):
        monitor = etlc.Monitor(text=SPEC)
        batch = monitor.batch(2)
        for one in (monitor, batch):
            for given in (({"x": 1.0},), (np.zeros(3),), (None,), (1.0, 2.0)):
                with self.assertRaisesRegex(
                    TypeError,
                    r"step takes samples by the name of their input: step\(z=..., x=..., stop=..., "
                    r"...\), or of a dict step\(\*\*samples\)",
                ):
                    one.step(*given)
        short = etlc.Monitor(text="spec s; input x : f32; monitor m = F x > 1;")
        with self.assertRaisesRegex(TypeError, r"input: step\(x=...\), or"):
            short.step({"x": 1})
        self.assertEqual((monitor.steps, batch.steps.tolist()), (0, [0, 0]))
        for call in (monitor.run, monitor.ahead, batch.run, batch.ahead):
            with self.assertRaisesRegex(etlc.InputError, "is of ndarray, expected a dict by in"):
                call(np.zeros((2, 3)))

    def test_names_that_are_no_texts(self):
        monitor = etlc.Monitor(text=SPEC, history=9)
        batch = monitor.batch(2)
        steps, verdicts = monitor.run(x=[1.0], **dict.fromkeys(("z", "stop", "half", "byte"))), None
        verdicts = monitor.step(x=1.0)
        for name in ([0, 1], {}, None, 3, b"high", np.array(["high"])):
            for call in (monitor.position, monitor.restart, monitor.measure, monitor.explain,
                         monitor.let, monitor.sample_counts, batch.restart, batch.measure,
                         verdicts.__getitem__, steps.__getitem__):  # fmt: skip
                with self.assertRaisesRegex(etlc.InputError, "no (monitor|predicate|let|input) "):
                    call(name)

    def test_labels_and_frames_that_are_none(self):
        monitor = etlc.Monitor(text=SPEC)
        for distance, truth, words in (
            (None, True, "^distance is None, expected a number"), ("1", True, "distance is '1'"),
            ([1.0], True, r"distance is an array of float64 and the shape \(1,\), expected a num"),
            (1.0, None, "^truth is None, expected a bool"), (1.0, 2, "truth is 2, expected a bool"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                monitor.observe("is_high", distance, truth)
        for frame in (None, True, 1.0, "0", 4, -1, 2**40, np.array([1])):
            with self.assertRaisesRegex(etlc.InputError, "frame is .*, expected 0 to 3"):
                monitor.encoder_difference(frame, [1.0])
        for embedding in (None, "z", np.zeros((2, 2)), np.zeros(2, "i8"), np.ma.array([1.0])):
            with self.assertRaisesRegex(etlc.InputError, "^embedding is "):
                monitor.encoder_difference(0, embedding)
        with self.assertRaisesRegex(etlc.InputError, "^the spec has no encoder$"):
            monitor.encoder_agrees(0, [1.0])
        with self.assertRaisesRegex(etlc.InputError, r"^input 'x' is 10000+\.\.\., expected a num"):
            monitor.step(stop=False, x=np.array(10**400, "O"))
        monitor.finish()
        with self.assertRaisesRegex(etlc.ClosedError, r"with finish\(\): reset\(\) begins another"):
            monitor.step()


class Saying(unittest.TestCase):
    def test_of_the_compiler_point_to_the_caller(self):
        line = inspect.currentframe().f_lineno + 1
        monitor, found = caught(lambda: etlc.Monitor("d.etl", text=DOUBTFUL))
        self.assertEqual([one.category for one in found], [etlc.EtlcWarning])
        self.assertEqual((found[0].filename, found[0].lineno), (__file__, line))
        self.assertRegex(str(found[0].message), r"^d.etl:4:17: warning: .* \[W0501\]\n  note: ")
        self.assertEqual(found[0].message.diagnostic.code, "W0501")
        self.assertEqual(len(found[0].message.diagnostic.notes), 1)
        self.assertIn("W0501", monitor.warnings)
        with warnings.catch_warnings():
            warnings.simplefilter("error", etlc.EtlcWarning)
            with self.assertRaises(etlc.EtlcWarning):
                etlc.Monitor(text=DOUBTFUL)
        self.assertEqual(caught(lambda: etlc.Monitor(text=SPEC))[1], [])

        class Own(etlc.Monitor):
            def __init__(self):
                super().__init__(text=DOUBTFUL)

        self.assertEqual(caught(Own)[1][0].filename, __file__)

    def test_of_commands_point_to_the_caller(self):
        with tempfile.TemporaryDirectory() as folder:
            spec = Path(folder) / "d.etl"
            spec.write_text("spec d; input x, y : f32; truth high = y > 0;"
                            "predicate high = x > calibrated(f1); monitor m = F high;")  # fmt: skip
            random = np.random.default_rng(1)
            for name in range(8):
                np.savez(f"{folder}/{name}.npz", **{
                    of: random.normal(size=40).astype("f4") for of in ("x", "y")})  # fmt: skip
            made, found = caught(lambda: etlc.calibrate(spec, folder))
            said = [one.code for one in made.diagnostics if one.severity == "warning"]
            self.assertIn("W0671", said)
            self.assertEqual([one.message.diagnostic.code for one in found], said)
            for one in found:
                self.assertIs(one.category, etlc.EtlcWarning)
                self.assertEqual(one.filename, __file__)

    def test_notes_of_errors_are_said(self):
        text = "spec t;\nrate 20 Hz;\ninput x : f32;\nmonitor m = F[0 s, 0.12 s] x > 1;\n"
        with tempfile.TemporaryDirectory() as folder:
            spec = Path(folder) / "t.etl"
            spec.write_text(text)
            for call in (lambda: etlc.Monitor(spec), lambda: etlc.evaluate(spec, folder)):
                with self.assertRaises(etlc.SpecError) as raised:
                    call()
                (found,) = raised.exception.diagnostics
                self.assertEqual(found.notes[0], f"{spec}:2:1: the rate is 20 Hz")
                self.assertEqual(raised.exception.notes, list(found.notes))
                self.assertIn("the rate is 20 Hz", str(raised.exception))
                self.assertIn("durations up", str(raised.exception))

    def test_of_runs_on_nothing(self):
        arrays = episode()
        nan = np.full_like(arrays["z"], np.nan)
        masked = np.ma.masked_all_like(arrays["byte"])
        monitor = etlc.Monitor(text=SPEC)
        for others, words in (
            ({"z": nan}, "of 'z' is missing or not finite"),
            ({"x": np.full(30, np.inf)}, "of 'x' is missing or not finite"),
            ({"x": np.full(30, 101.0)}, r"of 'x' is out of its range, \[-100, 100\]"),
            ({"x": np.linspace(100, np.nan, 30) + 1}, "of 'x' is missing or"),
            ({"byte": masked}, "of 'byte' is missing"),
            ({"z": nan, "half": np.full((30, 2), np.nan)}, "of 'z'.*of 'half'"),
        ):
            said, found = caught(lambda: monitor.run({**arrays, **others}))
            self.assertEqual(len(found), 1, words)
            self.assertEqual((found[0].category, found[0].filename), (etlc.EtlcWarning, __file__))
            self.assertRegex(str(found[0].message), "every sample " + words)
        self.assertFalse(said.far.satisfied.any() or said.far.violated.any())
        del arrays["stop"]
        _, found = caught(lambda: monitor.run(arrays))
        self.assertIn("every sample of 'stop' is missing: it is not given", str(found[0].message))
        arrays["z"][1:] = np.nan
        for quiet in ({"stop": None}, {"stop": np.zeros(30, "?")}):
            self.assertEqual(caught(lambda: monitor.run({**arrays, **quiet}))[1], [])
        none = {name: array[:0] for name, array in arrays.items()}
        self.assertEqual(caught(lambda: monitor.run(none, stop=[]))[1], [])


if __name__ == "__main__":
    unittest.main()
