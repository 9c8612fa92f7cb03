#!/usr/bin/python3
"""Batches, plans, copies and pickles of the Python package."""

import copy
import pickle
import sys
import tempfile
import threading
import unittest
import warnings
from pathlib import Path

import numpy as np

import etlc

SPEC = """spec dock;
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
monitor returns = G (is_low -> F[0, 2] docked);
restartable monitor visits = F docked;
sliding monitor calm = G[0, 2] small;
"""
N = 7


def samples(*lead, seed=1):
    """Returns arrays with these leading axes, some rows of which are missing."""
    random = np.random.default_rng(seed)
    z = random.normal(size=(*lead, 3)).astype("f4")
    z[random.random(lead) < 0.2] = np.nan
    return {
        "z": z,
        "charge": random.uniform(-0.2, 1.2, lead).astype("f4"),
        "stop": np.ma.array(random.random(lead) < 0.3, mask=random.random(lead) < 0.2),
        "half": random.normal(size=(*lead, 2)).astype("f2"),
        "byte": random.integers(-8, 8, (*lead, 2)).astype("i1"),
    }  # fmt: skip


def at(arrays, *place):
    """Returns the samples of one step; None where they are masked."""
    return {name: None if array[place] is np.ma.masked else array[place]
            for name, array in arrays.items()}  # fmt: skip


def raw(verdicts):
    return verdicts._raw if isinstance(verdicts, etlc.Verdicts) else verdicts.table.tobytes()


class Stepping(unittest.TestCase):
    def setUp(self):
        self.monitor = etlc.Monitor(text=SPEC)
        self.batch = self.monitor.batch(N)
        self.alone = [etlc.Monitor(text=SPEC) for _ in range(N)]

    def step(self, seed):
        given = samples(N, seed=seed)
        found = self.batch.step(**given)
        expected = b"".join(
            raw(one.step(**at(given, n))) for n, one in enumerate(self.alone)
        )
        self.assertEqual(found.table.tobytes(), expected)
        return found

    def test_equals_monitors_that_end_at_different_times(self):
        for step in range(60):
            self.step(step)
            over = np.arange(N) % 5 == step % 11
            self.batch.reset(over if step % 2 else np.flatnonzero(over))
            for n in np.flatnonzero(over):
                self.alone[n].reset()
            if step % 7 == 0:
                self.batch.restart("visits", [0, 3])
                self.alone[0].restart("visits")
                self.alone[3].restart("visits")
            self.assertEqual(self.batch.steps.tolist(), [one.steps for one in self.alone])
        measured = self.batch.measure("at_bay")
        for n, one in enumerate(self.alone):
            alone = one.measure("at_bay")
            np.testing.assert_equal(measured.distance[n], np.float32(alone.distance))
            self.assertEqual(measured.threshold[n], alone.threshold)
            self.assertEqual(measured.nearest[n], alone.nearest)

    def test_arrays_per_monitor(self):
        found = self.step(3)
        self.assertEqual(len(found), N)
        self.assertEqual(list(dict(found)), list(self.batch.monitors))
        self.assertIn("returns", dir(found))
        visits = found.visits
        for n, one in enumerate(self.alone):
            alone = pickle.loads(pickle.dumps(one)).finish().visits  # prefix: the same again
            self.assertEqual(
                (visits.status[n], visits.alarm[n], visits.final[n], visits.unknown[n],
                 visits.fulfilled[n], visits.satisfied[n], visits.violated[n], visits.decided[n]),
                (alone.status, alone.alarm, alone.final, alone.unknown, alone.fulfilled,
                 alone.satisfied, alone.violated, alone.decided),
            )  # fmt: skip
            np.testing.assert_equal(visits.lower[n], np.float32(alone.lower))
        self.assertEqual(visits, self.batch.finish().visits)

    def test_finish_of_some(self):
        for step in range(4):
            self.step(step)
        for _ in range(self.batch.horizon):
            ends = self.batch.finish([1, 4])
            for n in (1, 4):
                self.assertEqual(ends.table[n].tobytes(), raw(self.alone[n].finish()))
            self.assertEqual(set(np.flatnonzero(ends.returns.decided)), {1, 4})
        with self.assertRaisesRegex(etlc.ClosedError, "environment 1 has ended"):
            self.batch.step(**samples(N))
        self.batch.reset([1, 4])
        self.alone[1].reset()
        self.alone[4].reset()
        self.step(9)

    def test_runs_equal_steps_and_threads_give_the_same_bytes(self):
        arrays = samples(N, 30)
        found = self.batch.run(arrays)
        for n, one in enumerate(self.alone):
            episode = one.run({name: array[n] for name, array in arrays.items()})
            self.assertEqual(found.table[n].tobytes(), episode.table.tobytes())
            first = found.returns.first_alarm[n]
            self.assertEqual(None if first < 0 else first, episode.returns.first_alarm)
        with etlc.Monitor(text=SPEC, threads=3).batch(N) as batch:
            self.assertEqual(batch.run(arrays).table.tobytes(), found.table.tobytes())
            self.assertEqual(batch.run(arrays), found)

    def test_arrays_of_any_layout(self):
        arrays = samples(N, 4)
        expected = raw(self.batch.run(arrays))
        wide = np.zeros((N, 4, 6), "f4")
        wide[..., ::2] = arrays["z"]
        for z in (arrays["z"].astype("f8"), np.asfortranarray(arrays["z"]), wide[..., ::2],
                  arrays["z"].astype(">f4"), arrays["z"][::-1].copy()[::-1]):  # fmt: skip
            self.assertEqual(raw(self.batch.run({**arrays, "z": z})), expected)
        steps = np.moveaxis(np.ascontiguousarray(np.moveaxis(arrays["z"], 1, 0)), 0, 1)
        self.assertEqual(raw(self.batch.run({**arrays, "z": steps})), expected)

    def test_missing_samples(self):
        given = samples(N)
        left_out = self.batch.step(**{**given, "z": None}).table.tobytes()
        self.batch.reset()
        nan = np.full((N, 3), np.nan, "f4")
        self.assertEqual(self.batch.step(**{**given, "z": nan}).table.tobytes(), left_out)
        self.batch.reset()
        masked = np.ma.array(np.zeros((N, 3), "f4"), mask=True)
        self.assertEqual(self.batch.step(**{**given, "z": masked}).table.tobytes(), left_out)
        with self.assertWarnsRegex(etlc.EtlcWarning, "every sample of 'charge' is missing"):
            self.batch.run(z=np.zeros((N, 2, 3), "f4"), stop=None, half=None, byte=None)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.batch.run(samples(N, 2))

    def test_one_environment_as_a_monitor(self):
        for step in range(5):
            self.step(step)
        one = self.batch.monitor(2)
        self.assertEqual(one.steps, 5)
        self.assertEqual(one.sample_counts("z"), self.alone[2].sample_counts("z"))
        given = at(samples(N, seed=8), 2)
        self.assertEqual(one.step(**given), self.alone[2].step(**given))

    def test_outlives_its_monitor(self):
        self.monitor.close()
        self.step(1)
        self.assertIn("7 environments", repr(self.batch))


class Ahead(unittest.TestCase):
    PLANS, STEPS = 1000, 30

    def test_of_1000_plans_equals_1000_copies(self):
        monitor = etlc.Monitor(text=SPEC, threads=2)
        for step in range(8):
            monitor.step(**at(samples(8), step))
        before = monitor._saved()
        plans = samples(self.PLANS, self.STEPS)
        found = monitor.ahead(plans)
        self.assertEqual(found.table.shape, (self.PLANS, self.STEPS, 3))
        self.assertEqual(monitor._saved(), before)
        for n in range(self.PLANS):
            one = copy.copy(monitor)
            rows = b"".join(raw(one.step(**at(plans, n, t))) for t in range(self.STEPS))
            self.assertEqual(found.table[n].tobytes(), rows)
        first = monitor.ahead({name: array[0] for name, array in plans.items()})
        self.assertIsInstance(first, etlc.Episode)
        self.assertEqual(first.table.tobytes(), found.table[0].tobytes())

    def test_of_a_batch(self):
        batch = etlc.Monitor(text=SPEC).batch(N)
        batch.step(**samples(N))
        before = batch._saved()
        plans = samples(N, 3, 5)
        found = batch.ahead(plans)
        self.assertEqual(found.table.shape, (N, 3, 5, 3))
        self.assertEqual(batch._saved(), before)
        self.assertEqual(found.returns.first_alarm.shape, (N, 3))
        for plan in range(3):
            one = batch.ahead({name: array[:, plan] for name, array in plans.items()})
            self.assertEqual(one.table.tobytes(), found.table[:, plan].tobytes())

    def test_takes_no_history_and_no_incident(self):
        monitor = etlc.Monitor(text=SPEC, history=4, recorder=(2, 1, 1))
        verdicts = monitor.step(**at(samples(1), 0))
        why = monitor.explain("visits")
        monitor.ahead(samples(20))
        self.assertEqual(verdicts.visits.why, why)
        self.assertEqual(monitor.incidents, ())

    def test_after_the_end(self):
        monitor = etlc.Monitor(text=SPEC)
        monitor.finish()
        with self.assertRaises(etlc.ClosedError):
            monitor.ahead(samples(3))


class Copies(unittest.TestCase):
    def test_go_on_alone(self):
        monitor = etlc.Monitor(text=SPEC, history=100, lets=True, recorder=(2, 1, 3))
        arrays = samples(20)
        for step in range(10):
            monitor.step(**at(arrays, step))
        for copied in (copy.copy(monitor), copy.deepcopy({"a": monitor})["a"]):
            self.assertEqual(copied.steps, 10)
            self.assertEqual(copied.explain("visits"), monitor.explain("visits"))
            np.testing.assert_equal(copied.let("docked"), monitor.let("docked"))
            other = copy.copy(monitor)
            for step in range(10, 20):
                self.assertEqual(copied.step(**at(arrays, step)), other.step(**at(arrays, step)))
            copied.close_incidents()
            other.close_incidents()
            self.assertEqual(copied.incidents, other.incidents)
            copied.close()
        self.assertEqual(monitor.steps, 10)

    def test_pickles_go_on(self):
        monitor = etlc.Monitor(text=SPEC, history=100)
        arrays = samples(20)
        for step in range(10):
            monitor.step(**at(arrays, step))
        loaded = pickle.loads(pickle.dumps(monitor))
        self.assertEqual(loaded.steps, 10)
        self.assertEqual(loaded.explain("visits"), monitor.explain("visits"))
        for step in range(10, 20):
            self.assertEqual(loaded.step(**at(arrays, step)), monitor.step(**at(arrays, step)))
        self.assertEqual(loaded.explain("returns"), monitor.explain("returns"))
        batch = monitor.batch(N)
        batch.step(**samples(N))
        again = pickle.loads(pickle.dumps(batch))
        self.assertEqual(again.step(**samples(N, seed=2)), batch.step(**samples(N, seed=2)))
        self.assertEqual(copy.deepcopy(batch).steps.tolist(), [2] * N)

    def test_pickles_of_results_are_plain(self):
        monitor = etlc.Monitor(text=SPEC, history=9)
        verdicts = monitor.step(**at(samples(1), 0))
        episode = monitor.run(samples(5))
        for one in (verdicts, verdicts.calm, episode, episode.visits,
                    monitor.measure("at_bay"), monitor.batch(N).step(**samples(N))):  # fmt: skip
            raw_bytes = pickle.dumps(one)
            self.assertNotIn(b"spec dock", raw_bytes)
            self.assertEqual(repr(pickle.loads(raw_bytes)), repr(one))
            self.assertEqual(repr(copy.deepcopy(one)), repr(one))
        self.assertEqual(pickle.loads(pickle.dumps(verdicts)), verdicts)
        with self.assertRaisesRegex(etlc.NotKeptError, "a copy without its monitor"):
            pickle.loads(pickle.dumps(verdicts.calm)).why

    def test_states_of_others_are_refused(self):
        monitor = etlc.Monitor(text=SPEC)
        monitor.step(**at(samples(1), 0))
        state = monitor._saved()
        before = raw(copy.copy(monitor).finish())
        for other, words in (
            (etlc.Monitor(text=SPEC.replace("0.25", "0.5")), "with another spec"),
            (etlc.Monitor(text=SPEC, values="boolean"), "with other options"),
            (etlc.Monitor(text=SPEC, history=3), "a history of 0 steps, here it is 3"),
            (monitor.batch(2), "that of one monitor, expected that of a batch of 2"),
        ):
            with self.assertRaisesRegex(etlc.InputError, words):
                other._load(state)
        changed = bytearray(state)
        changed[20] ^= 1  # the version of etlc
        for wrong, words in (
            (b"", "not the bytes of"), (b"{}" * 99, "not the bytes of"),
            (state[:50], "cut off"), (state[:-1], "cut off or damaged"),
            (state + b"\0", "cut off or damaged"), (bytes(changed), "damaged"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                monitor._load(wrong)
        for place in range(0, len(state), 7):
            wrong = bytearray(state)
            wrong[place] ^= 0x41
            with self.assertRaises(etlc.Error):
                monitor._load(bytes(wrong))
        self.assertEqual(raw(copy.copy(monitor).finish()), before)
        with self.assertRaisesRegex(etlc.NotKeptError, "with a recorder"):
            pickle.dumps(etlc.Monitor(text=SPEC, recorder=(2, 1, 1)))

    def test_a_pickle_reads_the_spec_again(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "dock.etl"
            path.write_text(SPEC)
            kept = pickle.dumps(etlc.Monitor(path))
            self.assertEqual(pickle.loads(kept).name, "dock")
            path.write_text(SPEC.replace("0.25", "0.5"))
            with self.assertRaisesRegex(etlc.InputError, "another spec than 'dock'"):
                pickle.loads(kept)
            path.unlink()
            with self.assertRaises(etlc.SpecError):
                pickle.loads(kept)


class Tensor:
    """Stands for a tensor in the memory of this process."""

    def __init__(self, array):
        self._array = array

    def __array__(self, dtype=None):
        return self._array if dtype is None else self._array.astype(dtype)


class OnDevice:
    """Stands for a tensor of a GPU."""

    device = "cuda:0"

    def __array__(self, *_, **__):
        raise TypeError("can't convert cuda:0 device type tensor to numpy")


class Refusing(unittest.TestCase):
    def setUp(self):
        self.batch = etlc.Monitor(text=SPEC).batch(4)

    def test_samples_of_the_wrong_shape(self):
        for given, words in (
            ({"z": np.zeros((5, 3), "f4")}, r"shape \(5, 3\), expected 4 environments: a batch "),
            ({"z": np.zeros((3, 3), "f4")}, "expected 4 environments"),
            ({"z": np.zeros(3, "f4")}, r"expected the shape \(4, 3\)"),
            ({"z": np.zeros((4, 2, 3), "f4")}, r"expected the shape \(4, 3\)"),
            ({"z": np.zeros((4, 2), "f4")}, r"expected the shape \(4, 3\)"),
            ({"z": np.zeros((4, 3), "i4")}, "expected float32"),
            ({"charge": 1.0}, r"expected the shape \(4,\)"),
            ({"charge": np.zeros((4, 1), "f4")}, r"expected the shape \(4,\)"),
            ({"stop": np.array([0, 1, 2, 0])}, "expected bool"),
            ({"z": [[1, 2, 3], None, [1, 2, 3], None]}, "no array|expected float32"),
            ({"zz": np.zeros((4, 3), "f4")}, "did you mean 'z'"),
            ({"z": OnDevice()}, r"on the device cuda:0, .* pass x.detach\(\).cpu\(\).numpy\(\)"),
            ({}, "no input is given"),
        ):
            with self.assertRaisesRegex(etlc.InputError, words):
                self.batch.step(**given)
        for given, words in (
            ({"z": np.zeros((4, 3), "f4")}, r"expected the shape \(4, T, 3\)"),
            ({"z": np.zeros((4, 2, 3), "f4"), "charge": np.zeros((4, 3), "f4")},
             "'charge' has 3 steps of 4 rows, others have 2 steps of 4 rows"),
            ({"z": np.zeros((5, 2, 3), "f4")}, "expected 4 environments"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                self.batch.run(given)
        with self.assertRaisesRegex(etlc.InputError, r"\(4, T, 3\) or \(4, K, T, 3\)"):
            self.batch.ahead(z=np.zeros((4, 3), "f4"))
        with self.assertRaisesRegex(etlc.InputError, r"\(N, 3\) or \(K, N, 3\)"):
            etlc.Monitor(text=SPEC).ahead(z=np.zeros(3, "f4"))
        self.assertEqual(self.batch.steps.tolist(), [0] * 4)

    def test_numbers_of_environments(self):
        monitor = etlc.Monitor(text=SPEC)
        for n in (0, -1, 1.5, "4", None, 1 << 40):
            with self.assertRaisesRegex(etlc.InputError, "n is .*, expected a whole number"):
                monitor.batch(n)
        with self.assertRaisesRegex(etlc.InputError, "threads is 0"):
            etlc.Monitor(text=SPEC, threads=0)
        with self.assertRaisesRegex(etlc.InputError, "threads is 9999, expected at most 1024"):
            etlc.Monitor(text=SPEC, threads=9999).batch(4).step(**samples(4))

    def chosen(self, which, environments=4):
        """Returns the environments that `reset` takes `which` for; restart and finish take them
        too."""
        given = which if callable(which) else lambda: which
        batch = etlc.Monitor(text=SPEC).batch(environments)
        batch.step(**samples(environments))
        batch.restart("visits", given())
        found = np.flatnonzero(copy.copy(batch).finish(given()).visits.decided).tolist()
        batch.reset(given())
        self.assertEqual(np.flatnonzero(batch.steps == 0).tolist(), found)
        return found

    def test_which_environments(self):
        mask = np.array([False, True, False, True])
        for which, found in (
            (mask, [1, 3]), (mask.tolist(), [1, 3]), (list(mask), [1, 3]), (Tensor(mask), [1, 3]),
            (np.repeat(mask, 2)[::2], [1, 3]), ([1, 3], [1, 3]), ((3, 1), [1, 3]), ({1, 3}, [1, 3]),
            (range(1, 3), [1, 2]), (lambda: iter([1, 3]), [1, 3]),
            (Tensor(np.array([3, 1])), [1, 3]),
            (np.array([1, 3], "u1"), [1, 3]), (np.array([1, 3], ">i8"), [1, 3]),
            (np.flatnonzero(mask), [1, 3]), (np.argwhere(mask), [1, 3]),
            (np.nonzero(mask), [1, 3]), (Tensor(np.argwhere(mask)), [1, 3]),
            (np.arange(4), [0, 1, 2, 3]), ([2, 3, 0, 1], [0, 1, 2, 3]), (None, [0, 1, 2, 3]),
            ([], []), (np.array([], int), []), (Tensor(np.array([], "f4")), []), (2, [2]),
            (np.int64(2), [2]), (np.array(2), [2]),
        ):  # fmt: skip
            self.assertEqual(self.chosen(which), found, which)
        for which in ([1], [0], np.array([True, False]), 1, None):  # two environments
            self.chosen(which, 2)
        self.assertEqual(self.chosen(0, 1), [0])
        self.assertEqual(self.chosen(np.array([False]), 1), [])

    def test_what_may_be_a_mask_or_numbers(self):
        for mask in np.ndindex(2, 2, 2, 2):
            for which in (np.array(mask), np.array(mask, "u1"), list(mask), Tensor(np.array(mask)),
                          np.array(mask)[:, np.newaxis]):  # fmt: skip
                with self.assertRaisesRegex(etlc.InputError, r"more than once: .* pass a mask as "):
                    self.chosen(which)
        for environments, which in (
            (2, [0, 1]), (2, np.array([1, 0])), (1, [0]), (1, np.array([0], "u1")),
            (2, Tensor(np.array([0, 1]))), (2, np.array([[0], [1]])),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, "may be the numbers of all .* or a mask"):
                self.chosen(which, environments)
        for which in ([0, 0], [1, 1]):
            with self.assertRaisesRegex(etlc.InputError, "more than once"):
                self.chosen(which, 2)

    def test_environments_that_are_none(self):
        mask = np.array([True, False, True, False])
        for which, words in (
            ([True, False], r"shape \(2,\), expected a bool for each .*: the shape \(4,\)"),
            (mask[:, np.newaxis], r"shape \(4, 1\), expected a bool for each"),
            (np.array([], bool), "expected a bool for each"), (True, "which is True, expected a b"),
            ([4], "no environment 4, only 0 to 3"), ([-1], "no environment -1"), (4, "only 0 to 3"),
            (np.array([0, 255], "u1"), "no environment 255"), (np.array([2**63], "u8"), "only 0"),
            ([True, 2], "or the numbers of some"), ([0.5], "float64 .* or the numbers of some"),
            (mask.astype("f4"), "float32 .* or the numbers of some"), (1.0, "which is 1.0, exp"),
            ("01", "which is of str"), (b"\0\1", "which is of bytes"), ({0: True}, "is of dict"),
            (np.ma.array(mask, mask=mask), "which is of MaskedArray"), ([None, 1], "of object"),
            (mask.astype("O"), "of object"), ([2**70], "of object"), (object(), "which is <object"),
            (np.nonzero(mask[:, np.newaxis]), r"shape \(2, 2\)"), ([[1], [2]], r"shape \(2, 1\)"),
            ((np.array([1]), np.array([0])), r"shape \(2, 1\)"), ([[1, 2]], r"shape \(1, 2\)"),
            (OnDevice(), r"which is on the device cuda:0, .* pass x.detach\(\).cpu\(\).numpy\(\)"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                self.batch.reset(which)
            with self.assertRaisesRegex(etlc.InputError, words):
                self.batch.restart("visits", which)
            with self.assertRaisesRegex(etlc.InputError, words):
                self.batch.finish(which)
        self.batch.step(**samples(4))
        self.assertEqual(self.batch.steps.tolist(), [1] * 4)
        with self.assertRaisesRegex(etlc.InputError, "monitor 'calm' does not restart"):
            self.batch.restart("calm")
        for one, words in ((4, "no environment 4"), (True, "is True"), ([1], r"is \[1\]"),
                           (1.0, "is 1.0"), (-1, "no environment -1")):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                self.batch.monitor(one)

    def test_no_steps(self):
        self.assertEqual(self.batch.run(samples(4, 0)).table.shape, (4, 0, 3))
        self.assertEqual(self.batch.ahead(samples(4, 0)).returns.first_alarm.tolist(), [-1] * 4)
        self.assertEqual(len(etlc.Monitor(text=SPEC).ahead(samples(0, 3))), 0)

    def test_after_close(self):
        self.batch.close()
        self.batch.close()
        for call in (self.batch.reset, lambda: self.batch.step(**samples(4)), self.batch.finish,
                     lambda: self.batch.steps, lambda: self.batch.measure("at_bay"),
                     lambda: self.batch.monitor(0), lambda: copy.copy(self.batch),
                     lambda: pickle.dumps(self.batch)):  # fmt: skip
            with self.assertRaisesRegex(etlc.ClosedError, "the monitor is closed"):
                call()

    def test_a_text_as_a_path(self):
        with self.assertRaisesRegex(etlc.InputError, "did you mean text="):
            etlc.Monitor(SPEC)

    def test_another_thread(self):
        batch = etlc.Monitor(text=SPEC).batch(2000)
        arrays = samples(2000, 20)
        failures = []

        def runs():
            while not failures:
                try:
                    batch.run(arrays)
                except etlc.BusyError as error:
                    failures.append(error)

        others = [threading.Thread(target=runs) for _ in range(2)]
        for other in others:
            other.start()
        for other in others:
            other.join()
        self.assertIn("another thread", str(failures[0]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
