#!/usr/bin/python3
"""The Python package: the results of each call, and its refusals.

python_test.py FOLDER: FOLDER is that of the tests of specs.
"""

import inspect
import json
import re
import shutil
import struct
import sys
import tempfile
import threading
import unittest
import warnings
import zlib
from pathlib import Path

import numpy as np

import etlc
from etlc import conversion

SPECS = Path(sys.argv.pop()).resolve()

DOCK = """spec dock;
rate 10 Hz;
input z      : f32[3] hold 1;
input charge : f32 in [0, 1];
input stop   : bool;
input half   : f16[2];
input byte   : i8[2] scale 0.5;
target bay = [[1, 0, 0], [0, 1, 0]];
target origin = [[0, 0]];
predicate at_bay = min l2(z, bay) <= 0.5;
predicate is_low = charge <= 0.25;
predicate small  = l1(half, origin) + l1(byte, origin) <= 8;
let docked = at_bay && !stop;
monitor returns = G (is_low -> F[0 s, 0.2 s] docked);
restartable monitor visits = F docked;
sliding monitor calm = G[0, 2 steps] small;
"""

#: To a run: there are none of these.
NO_OTHERS = dict.fromkeys(("charge", "stop", "half", "byte"))


def quiet(call):
    """Returns the result of a call, without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", etlc.EtlcWarning)
        return call()


def samples(**others):
    """Returns the samples of one step: at the first bay, with a full battery."""
    given = {
        "z": np.array([1, 0, 0], "f4"), "charge": 1.0, "stop": False,
        "half": np.array([1, 0], "f2"), "byte": np.array([2, -2], "i1"),
    }  # fmt: skip
    return {**given, **others}


def png(pixel, size):
    """Returns a square of one colour."""
    def chunk(kind, data):
        crc = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", crc)

    head = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    rows = (b"\0" + pixel * size) * size
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows))
            + chunk(b"IEND", b""))  # fmt: skip


class Describing(unittest.TestCase):
    def test_says_what_is_in_the_spec(self):
        dock = etlc.Monitor(text=DOCK, lets=True)
        self.assertEqual(dock.name, "dock")
        self.assertEqual(dock.monitors, ("returns", "visits", "calm"))
        self.assertEqual(dock.formulas["visits"], "F (at_bay && !stop)")
        self.assertEqual(dock.predicates["at_bay"], "min l2(z, bay) <= 0.5")
        self.assertEqual(dock.step_seconds, 0.1)
        self.assertEqual(dock.horizon, 2)
        self.assertEqual(dock.warnings, "")
        self.assertEqual(len(dock.fingerprint), 3)
        self.assertEqual(
            dock.inputs["z"],
            etlc.Input("z", np.dtype("f4"), (3,), 1, 0, -np.inf, np.inf, True),
        )
        self.assertEqual(dock.inputs["charge"].shape, ())
        self.assertEqual(dock.inputs["charge"].high, 1)
        self.assertEqual(dock.inputs["stop"].dtype, np.dtype(bool))
        self.assertEqual(dock.inputs["half"].dtype, np.dtype("f2"))
        self.assertEqual(dock.inputs["byte"].dtype, np.dtype("i1"))
        self.assertIn("returns, visits, calm", repr(dock))

    def test_opens_files_with_what_lies_beside_them(self):
        adaptive = etlc.Monitor(SPECS / "ok" / "adaptive.etl")
        self.assertTrue(adaptive.monitors)

    def test_everything_has_a_docstring(self):
        for name in etlc.__all__:
            thing = getattr(etlc, name)
            self.assertTrue(inspect.getdoc(thing), name)
            if not inspect.isclass(thing):
                continue
            for member, value in inspect.getmembers(thing):
                if member.startswith("_") or issubclass(thing, Exception):
                    continue
                if callable(value) or isinstance(value, property):
                    self.assertTrue(inspect.getdoc(value), f"{name}.{member}")


    def test_the_page_has_an_example_of_every_call(self):
        page = (SPECS.parent.parent / "docs" / "python.md").read_text()
        examples = "".join(re.findall(r"```python\n(.*?)```", page, re.S))
        calls = [name for name in etlc.__all__ if not inspect.isclass(getattr(etlc, name))]
        for kind in (etlc.Monitor, etlc.Verdict, etlc.Verdicts, etlc.Episode,
                     etlc.EpisodeVerdicts, etlc.Explanation, etlc.Batch, etlc.BatchVerdicts,
                     etlc.BatchEpisode, etlc.VerdictArrays, etlc.RunVerdicts, etlc.Run,
                     etlc.Encoder, etlc.Guard, etlc.Labelling):  # fmt: skip
            calls += [name for name, _ in inspect.getmembers(kind) if not name.startswith("_")]
        calls += [name for name in vars(etlc.Monitor(text=DOCK)) if not name.startswith("_")]
        self.assertGreater(len(calls), 50)
        for name in calls:
            self.assertRegex(examples, rf"\.{name}\b")
        for name in etlc.__all__:
            if name.endswith("Error") and name != "Error":
                self.assertIn(name, page)


class Stepping(unittest.TestCase):
    def test_gives_verdicts(self):
        dock = etlc.Monitor(text=DOCK, lets=True)
        verdicts = dock.step(**samples(z=np.array([0.75, 0, 0], "f4")))
        visits = verdicts.visits
        self.assertEqual(visits.robustness, 0.25)
        self.assertEqual(visits.bounds, (0.25, 0.5))
        self.assertEqual((visits.lower, visits.upper), visits.bounds)
        self.assertTrue(visits.fulfilled and visits.satisfied and visits.final and visits.decided)
        self.assertFalse(visits.alarm or visits.violated or visits.unknown)
        self.assertEqual(visits.status, "satisfied")
        self.assertEqual(verdicts["calm"].status, "undecided")
        self.assertTrue(np.isnan(verdicts.calm.robustness))
        self.assertEqual([one.name for one in verdicts], ["returns", "visits", "calm"])
        self.assertEqual(len(verdicts), 3)
        self.assertEqual(verdicts.alarms, [])
        self.assertIn("satisfied for good", repr(verdicts))
        self.assertEqual(dock.measure("at_bay"), etlc.Measurement(0.25, 0.5, 0))
        self.assertIsNone(dock.measure("small").nearest)
        self.assertEqual(dock.let("docked"), 0.25)
        self.assertEqual(dock.steps, 1)
        self.assertEqual(dock.position("visits"), 0)

    def test_verdicts_stay_when_the_monitor_steps_on(self):
        dock = etlc.Monitor(text=DOCK)
        first = dock.step(**samples())
        was = first.returns.robustness
        for _ in range(4):
            last = dock.step(**samples(charge=0.0, z=np.array([9, 0, 0], "f4")))
        self.assertEqual(first.returns.robustness, was)
        self.assertEqual([one.name for one in last.alarms], ["returns"])
        self.assertTrue(last.returns.alarm)

    def test_what_is_none_or_not_given_or_not_finite_is_missing(self):
        for given in (
            {}, {"z": None, "charge": None, "stop": None, "half": None, "byte": None},
            {"z": np.full(3, np.nan, "f4"), "charge": float("inf"), "half": np.full(2, np.inf)},
        ):  # fmt: skip
            dock = etlc.Monitor(text=DOCK)
            verdicts = dock.step(**given)
            self.assertTrue(verdicts.visits.unknown, given)
            self.assertEqual(dock.sample_counts("z")["missing"], 1)
        dock.step(**samples(charge=2.0))
        self.assertEqual(dock.sample_counts("charge")["out_of_range"], 1)
        dock.step(**samples())
        dock.step(charge=1.0)
        self.assertEqual(dock.sample_counts("z")["held"], 1)

    def test_numbers_in_other_forms_give_the_same(self):
        expected = etlc.Monitor(text=DOCK).step(**samples(charge=0.75))
        for others in (
            {"z": [1, 0, 0]}, {"z": (1.0, 0.0, 0.0)}, {"z": np.array([1.0, 0, 0])},
            {"z": np.array([1, 0, 0], ">f4")}, {"z": np.array([1, 9, 0, 9, 0, 9], "f4")[::2]},
            {"z": np.array([0, 0, 1], "f4")[::-1]}, {"z": np.array([1, 0, 0], "f2")},
            {"charge": np.float32(0.75)}, {"charge": np.array(0.75)}, {"stop": np.False_},
            {"stop": 0}, {"half": [1.0, 0.0]}, {"byte": [2, -2]}, {"byte": np.array([2, -2])},
        ):  # fmt: skip
            found = etlc.Monitor(text=DOCK).step(**samples(**{"charge": 0.75, **others}))
            self.assertEqual(repr(found), repr(expected), others)

    def test_arrays_that_lie_elsewhere_give_the_same(self):
        expected = etlc.Monitor(text=DOCK).step(**samples())
        fixed = np.array([1, 0, 0], "f4")
        fixed.flags.writeable = False
        unaligned = np.zeros(1, [("pad", "u1"), ("z", "f4", 3)])["z"][0]
        unaligned[:] = fixed
        self.assertFalse(unaligned.flags.aligned)
        grid = np.zeros((3, 3), "f4", order="F")
        grid[1] = fixed
        wide = np.array([1, 0, 0], np.longdouble)
        for z in (fixed, unaligned, grid[1], grid.T[:, 1], wide):
            found = etlc.Monitor(text=DOCK).step(**samples(z=z))
            self.assertEqual(repr(found), repr(expected), z)

    def test_what_float32_cannot_hold_is_missing(self):
        dock = etlc.Monitor(text=DOCK)
        dock.step(**samples(z=np.array([1e300, 0, 0]), charge=1e300))
        with self.assertWarnsRegex(etlc.EtlcWarning, "every sample of 'z' is missing"):
            dock.run(z=np.full((1, 3), -1e300), charge=np.array([np.float64(1e300)]))
        self.assertEqual(dock.sample_counts("z")["missing"], 1)
        self.assertEqual(dock.sample_counts("charge")["missing"], 1)

    def test_restarts_finishes_and_resets(self):
        dock = etlc.Monitor(text=DOCK)
        dock.step(**samples())
        dock.restart("visits")
        dock.step(**samples())
        self.assertEqual(dock.position("visits"), 1)
        dock.finish()
        self.assertEqual(dock.finish().calm.robustness, 5)
        with self.assertRaisesRegex(etlc.ClosedError, "begins another one"):
            dock.step(**samples())
        dock.reset()
        self.assertEqual(dock.steps, 0)
        dock.step(**samples())
        self.assertEqual(dock.steps, 1)

    def test_adaptive_thresholds_move(self):
        adaptive = etlc.Monitor(SPECS / "ok" / "adaptive.etl")
        moved = 0
        for name in adaptive.predicates:
            try:
                before = adaptive.measure(name).threshold
                adaptive.observe(name, 1e6, True)
                moved += adaptive.measure(name).threshold != before
            except etlc.InputError as error:
                self.assertIn("is not adaptive", str(error))
        self.assertGreater(moved, 0)

    def test_constants_and_values_are_chosen(self):
        text = "spec t; const n = 1; input x : f32; monitor m = F x > n;"
        self.assertEqual(etlc.Monitor(text=text, settings={"n": 0.25}).step(x=1.0).m.lower, 0.75)
        truth = etlc.Monitor(text=text, values="boolean").step(x=2.0)
        self.assertEqual(truth.m.robustness, np.inf)


class Running(unittest.TestCase):
    def episode(self, steps=40):
        random = np.random.default_rng(1)
        arrays = {
            "z": random.normal(size=(steps, 3)).astype("f4"),
            "charge": random.uniform(-0.1, 1.1, steps).astype("f4"),
            "stop": random.random(steps) < 0.2,
            "half": random.normal(size=(steps, 2)).astype("f2"),
            "byte": random.integers(-128, 128, (steps, 2)).astype("i1"),
        }  # fmt: skip
        arrays["z"][::7, 1] = np.nan
        return arrays

    def stepped(self, arrays):
        dock = etlc.Monitor(text=DOCK)
        rows = zip(*arrays.values())
        return [dock.step(**dict(zip(arrays, row))) for row in rows]

    def expect_same(self, episode, stepped):
        self.assertEqual(len(episode), len(stepped))
        for one in episode:
            raw = [verdicts[one.name] for verdicts in stepped]
            for field in ("robustness", "lower", "upper", "alarm", "satisfied", "violated",
                          "decided", "final"):  # fmt: skip
                expected = [getattr(verdict, field) for verdict in raw]
                np.testing.assert_array_equal(getattr(one, field), expected, f"{one} {field}")

    def test_gives_what_steps_give(self):
        arrays = self.episode()
        episode = etlc.Monitor(text=DOCK).run(arrays)
        self.expect_same(episode, self.stepped(arrays))
        self.assertEqual(episode.monitors, ("returns", "visits", "calm"))
        first = episode.returns.first_alarm
        self.assertEqual(first, list(episode["returns"].alarm).index(True))
        self.assertIn("first alarm at step", repr(episode))
        self.assertIsNone(episode.visits.first_alarm)

    def test_arrays_of_other_orders_and_strides_give_the_same(self):
        arrays = self.episode()
        stepped = self.stepped(arrays)
        wide = np.zeros((40, 8), "f4")
        wide[:, 2:5] = arrays["z"]
        twice = np.repeat(arrays["z"], 2, axis=0)
        packed = np.zeros(40, [("pad", "u1"), ("z", "f4", 3), ("byte", "i1", 2)])
        packed["z"], packed["byte"] = arrays["z"], arrays["byte"]
        fixed = arrays["z"].copy()
        fixed.flags.writeable = False
        grid = np.zeros((40, 3, 2), "f4")
        grid[:, :, 1] = arrays["z"]
        for z in (
            np.asfortranarray(arrays["z"]), wide[:, 2:5], twice[::2], packed["z"],
            np.ascontiguousarray(arrays["z"][::-1])[::-1], arrays["z"].astype("f8"),
            arrays["z"].astype(">f4"), arrays["z"].tolist(), fixed, grid[:, :, 1],
            arrays["z"].astype(np.longdouble),
        ):  # fmt: skip
            self.expect_same(etlc.Monitor(text=DOCK).run(arrays, z=z), stepped)
        same = {"z": np.broadcast_to(np.array([1, 0, 0], "f4"), (40, 3))}
        held = {"z": np.tile(np.array([1, 0, 0], "f4"), (40, 1))}
        self.assertEqual(
            etlc.Monitor(text=DOCK).run(arrays, **same).table.tobytes(),
            etlc.Monitor(text=DOCK).run(arrays, **held).table.tobytes(),
        )
        others = {"byte": packed["byte"], "stop": arrays["stop"].astype("i8")}
        self.expect_same(etlc.Monitor(text=DOCK).run(arrays, **others), stepped)

    def test_arrays_of_the_right_type_are_read_where_they_lie(self):
        z = self.episode()["z"]
        for array in (z, z[::2], z[::-1]):
            rows = conversion.as_rows("z", array, np.dtype("f4"), (3,), ("N",))
            self.assertIsNone(rows.present)
            self.assertTrue(np.shares_memory(rows.data, z))

    def test_masked_rows_are_missing(self):
        arrays = self.episode()
        mask = np.arange(40) % 5 == 2
        masked = {name: np.ma.array(array, mask=np.broadcast_to(
            mask.reshape((-1,) + (1,) * (array.ndim - 1)), array.shape))
            for name, array in arrays.items()}  # fmt: skip
        dock = etlc.Monitor(text=DOCK)
        stepped = [
            dock.step(**({} if mask[n] else {name: array[n] for name, array in arrays.items()}))
            for n in range(40)
        ]
        self.expect_same(etlc.Monitor(text=DOCK).run(masked), stepped)

    def test_begins_a_new_episode_each_time(self):
        arrays = self.episode()
        dock = etlc.Monitor(text=DOCK)
        first = dock.run(arrays).table
        self.assertEqual(dock.run(arrays).table.tobytes(), first.tobytes())
        self.assertEqual(dock.steps, 40)
        none = {name: array[:0] for name, array in arrays.items()}
        self.assertEqual(len(dock.run(none)), 0)

    def test_refuses_what_does_not_fit(self):
        arrays = self.episode()
        dock = etlc.Monitor(text=DOCK)
        for others, words in (
            ({"z": arrays["z"][:, :2]}, r"shape \(40, 2\), expected the shape \(N, 3\)"),
            ({"z": arrays["z"][0]}, r"expected the shape \(N, 3\)"),
            ({"z": np.zeros((40, 3), "i4")}, "int32.*expected float32"),
            ({"z": arrays["z"].astype("c8")}, "complex64"),
            ({"z": arrays["z"].astype("O")}, "object"),
            ({"z": [[1, 2, 3], [1, 2]]}, "no array|object"),
            ({"charge": arrays["z"]}, r"expected the shape \(N,\)"),
            ({"charge": arrays["charge"][:5]}, "has 5 steps, others have 40"),
            ({"stop": arrays["charge"]}, "expected bool"),
            ({"stop": np.full(40, 2)}, "expected bool"),
            ({"stop": np.full(40, 2, "u1")}, "expected 0 or 1"),
            ({"byte": arrays["z"][:, :2]}, "expected int8"),
            ({"byte": np.full((40, 2), 128)}, "expected int8"),
            ({"zz": arrays["z"]}, "did you mean 'z'"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                dock.run(arrays, **others)
        with self.assertRaisesRegex(etlc.InputError, "no input"):
            dock.run()


class Explaining(unittest.TestCase):
    def test_says_why(self):
        dock = etlc.Monitor(text=DOCK, history=10)
        for step in range(6):
            charge = 1.0 if step < 2 else 0.125
            verdicts = dock.step(**samples(charge=charge, z=np.array([4, 0, 0], "f4")))
        why = verdicts.returns.why
        self.assertIn("is_low holds at step 2", str(why))
        self.assertEqual(why.data["monitor"], "returns")
        self.assertEqual(dock.explain("returns"), why)
        dock.step(**samples())
        with self.assertRaisesRegex(etlc.NotKeptError, "stepped on"):
            verdicts.returns.why
        dock.reset()
        with self.assertRaisesRegex(etlc.NotKeptError, "stepped on"):
            verdicts.returns.why

    def test_needs_a_history(self):
        with self.assertRaisesRegex(etlc.NotKeptError, "with a history"):
            etlc.Monitor(text=DOCK).step(**samples()).visits.why
        dock = etlc.Monitor(text=DOCK, history=1)
        dock.step(**samples())
        with self.assertRaisesRegex(etlc.NotKeptError, "holds 1 of the episode's 2 steps"):
            dock.step(**samples()).visits.why
        with self.assertRaisesRegex(etlc.UndecidedError, "'calm' has no verdict yet"):
            etlc.Monitor(text=DOCK, history=1).step(**samples()).calm.why

    def test_what_would_turn_it_does(self):
        """Applied to the samples, if == and != decide; if there is no change, nothing changes."""
        random = np.random.default_rng(5)
        grid = [np.float32(n / 2) for n in range(7)]
        beside = [np.nextafter(n, np.float32(end)) for n in grid for end in (-np.inf, np.inf)]
        numbers = [float(n) for n in (*grid, *beside, -9.0, 9.0)]

        def formula(depth):
            if depth == 0:
                name = random.choice(["x", "y", "b"])
                if name == "b":
                    return "b"
                compared = random.choice(["==", "!=", "==", "!=", "<=", ">"])
                return f"{name} {compared} {random.choice(grid)}"
            left, right = (formula(random.integers(0, depth)) for _ in range(2))
            return random.choice([
                f"({left} && {right})", f"({left} || {right})", f"({left} -> {right})",
                f"({left} <-> {right})", f"!({left})", f"(F[0, 1] {left})", f"(G[0, 2] {left})",
                f"({left} U[0, 1] {right})", f"(O[0, 1] {left})",
            ])  # fmt: skip

        turned = 0
        for _ in range(150):
            text = ("spec t; input x : f32 in [0, 3]; input y : f32; input b : bool;"
                    f"sliding monitor m = {formula(3)};")  # fmt: skip
            try:
                monitor = quiet(lambda: etlc.Monitor(text=text, history=20))
            except etlc.SpecError:
                continue  # the history covers a formula that looks ahead without bounds
            steps = monitor.horizon + 1
            rows = {
                "x": random.choice(grid, steps), "y": random.choice(grid, steps),
                "b": random.random(steps) < 0.5,
            }  # fmt: skip
            status = self.said_of(monitor, rows)
            change = monitor.explain("m").data["change"]
            if change is None or change["name"] == "b":
                for name, step in [(name, step) for name in "xy" for step in range(steps)]:
                    for other in numbers:
                        if name == "y" or 0 <= other <= 3:
                            found = self.said_of(monitor, self.altered(rows, name, step, other))
                            self.assertEqual(found, status, (text, rows, name, step, other))
            if change is None:
                for step in range(steps):
                    other = not rows["b"][step]
                    found = self.said_of(monitor, self.altered(rows, "b", step, other))
                    self.assertEqual(found, status, (text, rows, step))
                continue
            turned += 1
            changed = self.altered(rows, change["name"][0], change["step"], change["instead"])
            found = self.said_of(monitor, changed)
            self.assertEqual(found, change["status"], (text, rows, change))
            self.assertNotEqual(found, status, (text, rows, change))
        self.assertGreater(turned, 60)

    def altered(self, rows, name, step, value):
        column = rows[name].copy()
        column[step] = value
        return {**rows, name: column}

    def said_of(self, monitor, rows):
        monitor.reset()
        for row in zip(*rows.values()):
            last = monitor.step(**dict(zip(rows, row)))
        return last.m.status


class Recording(unittest.TestCase):
    def alarm(self, dock):
        for _ in range(4):
            dock.step(**samples(charge=0.0, z=np.array([9, 0, 0], "f4")))

    def test_keeps_incidents(self):
        with tempfile.TemporaryDirectory() as folder:
            spec = Path(folder) / "dock.etl"
            spec.write_text(DOCK)
            dock = etlc.Monitor(spec, recorder="0.2s,1,2")
            self.alarm(dock)
            self.assertEqual(dock.incidents, ())
            dock.close_incidents()
            (first,) = dock.incidents
            self.assertTrue(first.startswith(b"\x89ETLINC\n"))
            table = etlc.incident(spec, first)
            self.assertIn("alarm of returns at step 2 (0.2 s)", table)
            path = Path(folder) / "incident0"
            path.write_bytes(first)
            self.assertEqual(etlc.incident(spec, path), table)
            self.assertIn("distance_at_bay", etlc.incident(spec, first, form="csv"))
            with self.assertRaisesRegex(etlc.SpecError, "was changed"):
                etlc.incident(spec, first[:100] + b"?" + first[101:])
            dock.reset()
            self.assertEqual(dock.incidents, (first,))
            for _ in range(2):
                self.alarm(dock)
                dock.reset()
            self.assertEqual((len(dock.incidents), dock.lost_incidents), (2, 1))
            dock.forget_incidents()
            self.assertEqual((dock.incidents, dock.lost_incidents), ((), 0))

    def test_takes_numbers_of_steps(self):
        dock = etlc.Monitor(text=DOCK, recorder=(2, 1, 1))
        self.alarm(dock)
        dock.reset()
        self.assertEqual(len(dock.incidents), 1)

    def test_needs_a_recorder(self):
        dock = etlc.Monitor(text=DOCK)
        for call in (lambda: dock.incidents, lambda: dock.lost_incidents, dock.close_incidents,
                     dock.forget_incidents):  # fmt: skip
            with self.assertRaisesRegex(etlc.NotKeptError, "no incident is kept"):
                call()
        for wrong in ("2s", (1, 2), (1, 2, 0), (1.5, 2, 1), "1\0,2,3"):
            with self.assertRaisesRegex(etlc.InputError, "BEFORE,AFTER,INCIDENTS|NUL"):
                etlc.Monitor(text=DOCK, recorder=wrong)


class Refusing(unittest.TestCase):
    def test_specs_that_do_not_compile(self):
        with self.assertRaises(etlc.SpecError) as caught:
            etlc.Monitor("folder/t.etl", text="spec t;\ninput x : f32;\nmonitor m = F y > 1;\n")
        found = caught.exception.diagnostics
        self.assertEqual(len(found), 1)
        self.assertEqual(
            (found[0].code, found[0].severity, found[0].file, found[0].line, found[0].column),
            ("E0204", "error", "folder/t.etl", 3, 15),
        )
        self.assertIn("folder/t.etl:3:15: error: 'y' is not declared", str(caught.exception))
        with self.assertRaisesRegex(etlc.SpecError, "no such file"):
            etlc.Monitor("/there/is/no/such.etl")

    def test_samples_that_do_not_fit(self):
        dock = etlc.Monitor(text=DOCK)
        for others, words in (
            ({"zz": 1}, "no input 'zz'; did you mean 'z'"),
            ({"z": np.zeros(4, "f4")}, r"shape \(4,\), expected the shape \(3,\)"),
            ({"z": np.zeros((1, 3), "f4")}, r"shape \(1, 3\)"),
            ({"z": 1.0}, r"is 1.0, expected the shape"),
            ({"z": np.zeros(3, "i4")}, "int32.*expected float32"),
            ({"z": np.zeros(3, "c8")}, "complex64.*expected float32"),
            ({"z": np.array(["a", "b", "c"])}, "expected float32"),
            ({"z": np.array([1, None, 2])}, "object.*expected float32"),
            ({"z": np.ma.masked_array([1.0, 2.0, 3.0])}, "masked array"),
            ({"charge": "full"}, "is 'full', expected a number"),
            ({"charge": np.zeros(1)}, "expected a number"),
            ({"charge": 1j}, "expected a number"),
            ({"charge": True}, "expected a number"),
            ({"stop": 2}, "expected a bool"),
            ({"stop": 0.0}, "expected a bool"),
            ({"stop": "yes"}, "expected a bool"),
            ({"half": np.zeros(2, "i2")}, "expected float16"),
            ({"byte": np.zeros(2, "f4")}, "expected int8"),
            ({"byte": np.array([0, 200])}, "expected int8"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                dock.step(**samples(**others))
        self.assertEqual(dock.steps, 0)

    def test_names_and_options_that_mean_nothing(self):
        dock = etlc.Monitor(text=DOCK)
        verdicts = dock.step(**samples())
        for call, words in (
            (lambda: verdicts["return"], "did you mean 'returns'"),
            (lambda: dock.restart("nobody"), "no monitor 'nobody', only returns, visits, calm"),
            (lambda: dock.restart("calm"), "'calm' does not restart"),
            (lambda: dock.measure("at_bae"), "did you mean 'at_bay'"),
            (lambda: dock.observe("at_bay", 1.0, True), "is not adaptive"),
            (lambda: dock.let("docked"), "no let 'docked'"),
            (lambda: dock.sample_counts("zz"), "did you mean 'z'"),
            (lambda: dock.run(NO_OTHERS, z=np.zeros((1, 3)))["nobody"], "no monitor 'nobody'"),
            (lambda: etlc.Monitor(text=DOCK, values="truth"), "values is 'truth'"),
            (lambda: etlc.Monitor(text=DOCK, targets_as="f64"), "targets_as is 'f64'"),
            (lambda: etlc.Monitor(text=DOCK, history=-1), "history is -1"),
            (lambda: etlc.Monitor(text=DOCK, settings={"n": "x"}), "n=x"),
            (lambda: etlc.Monitor(text="spec t;\0"), "NUL"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                call()
        with self.assertRaises(AttributeError):
            verdicts.nobody
        with self.assertRaises(etlc.Error):
            etlc.Monitor()
        with self.assertRaises(MemoryError):
            etlc.Monitor(text=DOCK, history=1 << 40)

    def test_monitors_that_are_closed(self):
        with etlc.Monitor(text=DOCK) as dock:
            dock.step(**samples())
        dock.close()
        for call in (
            lambda: dock.step(**samples()), lambda: dock.run(z=np.zeros((1, 3), "f4")),
            dock.reset, dock.finish, lambda: dock.position("visits"),
            lambda: dock.measure("at_bay"), lambda: dock.restart("visits"),
            lambda: dock.observe("at_bay", 1.0, True), lambda: dock.sample_counts("z"),
            lambda: dock.explain("visits"), lambda: dock.incidents, dock.close_incidents,
            lambda: dock.lost_incidents, dock.forget_incidents,
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.ClosedError, "the monitor is closed"):
                call()

    def test_monitors_of_another_thread(self):
        dock = etlc.Monitor(text=DOCK)
        z = np.zeros((20000, 3), "f4")
        seen = threading.Event()
        failures = []

        def runs():
            while not seen.is_set():
                try:
                    dock.run(NO_OTHERS, z=z)
                except etlc.BusyError:
                    pass
                except BaseException as error:
                    failures.append(error)
                    return

        thread = threading.Thread(target=runs)
        thread.start()
        while not seen.is_set() and thread.is_alive():
            try:
                dock.measure("at_bay")
            except etlc.BusyError as error:
                self.assertIn("another thread", str(error))
                seen.set()
        thread.join()
        self.assertEqual(failures, [])
        self.assertTrue(seen.is_set())

    def test_many_monitors_in_threads(self):
        z = np.random.default_rng(2).normal(size=(2000, 3)).astype("f4")
        expected = etlc.Monitor(text=DOCK).run(NO_OTHERS, z=z).table
        found = [None] * 4

        def runs(n):
            found[n] = etlc.Monitor(text=DOCK).run(NO_OTHERS, z=z).table

        threads = [threading.Thread(target=runs, args=(n,)) for n in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for table in found:
            self.assertEqual(table.tobytes(), expected.tobytes())


class Commands(unittest.TestCase):
    """Writes episodes in which `near` holds while x is small."""

    SPEC = """spec reach;
input z : f32[2];
input x : f32;
target goal = {target};
predicate near = min l2(z, goal) <= {threshold};
truth near = x <= 1;
monitor arrives = F near;
"""

    def folder(self, target="[[0, 0]]", threshold="calibrated(f1)"):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        (path / "reach.etl").write_text(self.SPEC.format(target=target, threshold=threshold))
        random = np.random.default_rng(3)
        for part in ("data", "others"):
            (path / part).mkdir()
            for episode in range(12):
                x = np.abs(random.normal(size=30) * 2).astype("f4")
                z = np.stack([x, 0.1 * random.normal(size=30)], axis=1).astype("f4")
                np.savez(path / part / f"{episode}.npz", z=z, x=x)
        return path

    def test_calibrates_and_evaluates(self):
        path = self.folder()
        made = etlc.calibrate(path / "reach.etl", path / "data")
        self.assertEqual(made.path, path / "reach.thresholds.json")
        self.assertIn("near", made.report)
        threshold = etlc.Monitor(path / "reach.etl").measure("near").threshold
        self.assertAlmostEqual(threshold, 1, delta=0.2)
        with self.assertRaisesRegex(etlc.SpecError, "were calibrated on"):
            etlc.evaluate(path / "reach.etl", path / "data")
        judged = etlc.evaluate(path / "reach.etl", [path / "others"], by_episode=True)
        self.assertIn("near", judged.report)
        self.assertIn("near", json.dumps(judged.data))
        other = etlc.calibrate(
            path / "reach.etl", path / "data", output=path / "other.json", jobs=1
        )
        self.assertEqual(other.path.read_text(), made.path.read_text())

    def test_labels_in_tables_and_folders(self):
        path = self.folder()
        (path / "reach.etl").write_text(
            re.sub(r"truth near = .*\n", "", (path / "reach.etl").read_text())
        )
        with self.assertRaisesRegex(etlc.SpecError, "E0810"):
            etlc.calibrate(path / "reach.etl", path / "data")
        tables = [path / "first.csv", path / "second.csv"]
        for part, table in enumerate(tables):
            rows = [f"{episode},near,3,9\n" for episode in range(6 * part, 6 * part + 6)]
            table.write_text("episode,predicate,start,end\n" + "".join(rows))
        made = etlc.calibrate(path / "reach.etl", path / "data", labels=tables)
        self.assertIn("labels: 72 frames positive, 288 negative", made.report)
        (path / "data").rename(path / "near")
        made = etlc.calibrate(path / "reach.etl", path / "near", label_by="folder")
        self.assertIn("labels: 360 frames positive, 0 negative", made.report)

    def test_fits(self):
        path = self.folder("fitted(kmeans, k = 2, of = z, where = near)", "1")
        with self.assertRaises(etlc.SpecError):
            etlc.Monitor(path / "reach.etl")
        made = etlc.fit(path / "reach.etl", path / "data")
        self.assertEqual(made.path, path / "reach.fitted.npz")
        self.assertIn("goal", made.report)
        self.assertEqual(etlc.Monitor(path / "reach.etl").monitors, ("arrives",))

    def test_embeds(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name)
        page = (SPECS.parent.parent / "docs" / "recordings.md").read_text()
        code = re.search(r"```python\n(import struct.*?)```", page, re.S)[1]
        (path / "encoder.py").write_text(code)
        (path / "look.etl").write_text("""spec look;
rate 10 Hz;
encoder mine = load("encoder.py");
input z : f32[4] by mine;
target bay = images("bay.png") by mine;
monitor docked = F min l2(z, bay) <= 0.3;
""")
        image = png(bytes([0, 200, 0]), 16)
        (path / "bay.png").write_bytes(image)
        (path / "drive").mkdir()
        for step in range(3):
            (path / "drive" / f"{step}.png").write_bytes(image)
        encoder = f"{sys.executable} {path}/encoder.py"
        try:
            made = etlc.embed(path / "look.etl", encoder_command=encoder)
        except etlc.SpecError as error:
            self.assertIn("E1016", str(error))
            self.skipTest("etlc embed is not there")
        self.assertEqual(made.path, path / "look.embedded.npz")
        made = etlc.embed(path / "look.etl", path / "drive", output=path / "episodes",
                          encoder_command=encoder)  # fmt: skip
        self.assertEqual(made.path, path / "episodes")
        with np.load(path / "episodes" / "drive.npz") as episode:
            verdicts = etlc.Monitor(path / "look.etl").run(z=episode["z"])
        self.assertEqual(verdicts.docked.satisfied.tolist(), [True] * 3)

    def test_one_verdict_of_many(self):
        text = "spec a; input x : f32; predicate p = x > 0; monitor f = F p; monitor g = G p;"
        monitor = etlc.Monitor(text=text)
        verdicts = monitor.run(x=[-1, 2, 3])
        each = [monitor.step(x=x) for x in (-1, 2, 3) if x > -1 or monitor.reset() is None]
        for step, one in enumerate(each):
            self.assertEqual(verdicts.f[step], one.f)
            self.assertEqual(verdicts.g[step], one.g)
        self.assertEqual(list(verdicts.f), [one.f for one in each])
        self.assertTrue(verdicts.g[-1].alarm)
        self.assertEqual(repr(verdicts.f[0]), "<f: not yet satisfied, -1 in [-1, inf]>")
        with self.assertRaises(IndexError):
            verdicts.f[3]
        with self.assertRaises(IndexError):
            verdicts.f[0:2]

    def test_guard(self):
        class Tensor:  # as torch has them, of a batch of one
            def __init__(self, *numbers):
                self.numbers = np.array([numbers], "f4")

            detach = cpu = lambda self: self

            def numpy(self):
                return self.numbers

        monitor = etlc.Monitor(history=9, text="""spec a;
            input z : f32[2]; input s : f32; target home = [[0, 0]];
            predicate near = l2(z, home) <= 1;
            monitor safe = G (s < 1 -> !near); monitor done = F near;""")
        guard = etlc.Guard(monitor, on_alarm="hand_over", on_fulfilled={"done": "stop"},
                           on_unknown="retry", names={"z": "observation.state", "s": "speed"})
        self.assertIsNone(guard.verdicts)
        far, here = Tensor(3, 4), Tensor(0, 0.5)

        def see(z, s):
            return guard.step({"observation.state": z, "speed": s, "observation.image": None})

        self.assertEqual(see(far, [0.5]), "continue")
        self.assertEqual(see(here, 2.0), "stop")
        self.assertEqual(guard.why(), {})
        guard.reset()
        self.assertEqual(see(None, 2), "retry")  # no sample of `z`
        guard.reset()
        guard = etlc.Guard(monitor, on_alarm="hand_over", names={"z": "observation.state"},
                           encode=lambda observation: {"z": observation["frame"], "s": 0.0})
        self.assertEqual(guard.step({"frame": [3, 4]}), "continue")
        self.assertEqual(guard.step({"frame": [0, 0]}), "hand_over")
        self.assertIn("near holds at step 1", guard.why()["safe"])
        self.assertEqual(guard.step({"frame": [3, 4]}), "hand_over")  # until the next episode
        guard.reset()
        self.assertEqual(guard.step({"frame": [3, 4]}), "continue")
        encoded = etlc.Guard(monitor, encode=lambda observation: np.ones((1, 2)))
        self.assertEqual(encoded.step({"s": 5}), "continue")
        alone = etlc.Guard(etlc.Monitor(
            text="spec a; input x : f32; predicate p = x > 0; monitor m = G p;"))
        self.assertEqual([alone.step(x) for x in (1, np.array([2.0]), -1)],
                         ["continue", "continue", "stop"])
        for call, why in (
            (lambda: guard.step({}), "frame"), (lambda: encoded.step({"x": 1}), "no 's'"),
            (lambda: etlc.Guard(monitor).step(3), "there are z, s"),
            (lambda: etlc.Guard(monitor).step({"s": 1}), "no 'z' for the input 'z': s"),
            (lambda: etlc.Guard(monitor).step({"z": [1, 2, 3], "s": 1}), "z"),
            (lambda: etlc.Guard(monitor, on_alarm="halt"), "expected one of continue, retry"),
            (lambda: etlc.Guard(monitor, on_alarm={"saf": "stop"}), "did you mean 'safe'"),
            (lambda: etlc.Guard(monitor, names={"y": "z"}), "no input 'y'"),
        ):
            with self.assertRaisesRegex((etlc.InputError, KeyError), why):
                call()

    def test_guard_writes_incidents(self):
        text = """spec a; input x : f32; predicate p = x > 0;
                  monitor good = G p; sliding monitor now = p;"""
        box = tempfile.TemporaryDirectory()
        self.addCleanup(box.cleanup)
        folder = Path(box.name)
        monitor = etlc.Monitor(text=text, recorder=(2, 3, 4))
        guard = etlc.Guard(monitor, record=folder / "a" / "b")
        names = []
        for x in (1, 1, -1, 1, -1):
            guard.step(x)
            names.append(sorted(path.name for path in folder.glob("a/b/*")))
        self.assertEqual(names, [[], [], ["incident0"], ["incident0"], ["incident0", "incident1"]])
        again = etlc.Guard(monitor, record=folder / "a" / "b")
        again.reset()
        self.assertEqual([again.step(x) for x in (1, -1)], ["continue", "stop"])
        (folder / "a.etl").write_text(text)
        for n, alarm in enumerate(("good, now at step 2", "now at step 4", "now at step 1")):
            self.assertIn(alarm, etlc.incident(folder / "a.etl", folder / f"a/b/incident{n}"))
        self.assertEqual(monitor.incidents, ())
        shutil.rmtree(folder / "a")
        again.reset()
        with self.assertWarnsRegex(etlc.EtlcWarning, "could not be written.*incident0"):
            self.assertEqual(again.step(-1), "stop")  # an answer in any case
        with self.assertRaises(etlc.NotKeptError):
            etlc.Guard(etlc.Monitor(text=text), record=folder / "c")
        self.assertFalse((folder / "c").exists())

    def test_no_module_looks_like_a_function(self):
        self.assertEqual({name for name in dir(etlc) if not name.startswith("_")},
                         set(etlc.__all__))
        self.assertFalse(hasattr(etlc, "batch"))
        import etlc.batch as module  # those who need it have it

        self.assertIs(module.Batch, etlc.Batch)

    def test_say_why_they_fail(self):
        path = self.folder(threshold="nothing")
        with self.assertRaises(etlc.SpecError) as caught:
            etlc.calibrate(path / "reach.etl", path / "data")
        self.assertEqual(caught.exception.diagnostics[0].severity, "error")
        self.assertIn("reach.etl:5:", str(caught.exception))
        path = self.folder(threshold="1")
        with self.assertRaisesRegex(etlc.SpecError, "no-such"):
            etlc.evaluate(path / "reach.etl", path / "no-such")
        with self.assertRaisesRegex(etlc.SpecError, r"^[^:]*no-such: "):
            etlc.evaluate(path / "reach.etl", path / "no-such")
        with self.assertRaisesRegex(etlc.SpecError, "E1008"):
            etlc.embed(path / "reach.etl")
        with self.assertRaisesRegex(etlc.SpecError, "expected an incident"):
            etlc.incident(path / "reach.etl", b"")


if __name__ == "__main__":
    unittest.main()
