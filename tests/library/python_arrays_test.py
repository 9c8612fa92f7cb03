#!/usr/bin/python3
"""Arrays of the Python package: every layout is read correctly, or refused."""

import tempfile
import unittest

import numpy as np

import etlc

SPEC = """spec all_types;
input z    : f32[3];
input x    : f32 in [-100, 100];
input stop : bool;
input half : f16[2];
input byte : i8[2] scale 0.5;
target at = [[1, 0, 0]];
target o  = [[0, 0]];
monitor far   = G l2(z, at) > 0.125;
predicate is_high = x >= 50;
monitor high  = F is_high;
monitor goes  = G !stop;
monitor small = G l1(half, o) <= 8;
monitor bytes = G l1(byte, o) <= 99;
sliding monitor late = F[0, 3] x >= 20;
"""


def episode(steps=30):
    random = np.random.default_rng(7)
    return {
        "z": random.normal(size=(steps, 3)).astype("f4"),
        "x": random.integers(-100, 100, steps).astype("f4"),
        "stop": random.random(steps) < 0.1,
        "half": random.normal(size=(steps, 2)).astype("f2"),
        "byte": random.integers(-128, 128, (steps, 2)).astype("i1"),
    }  # fmt: skip


def misaligned(array):
    """Copies to an odd address."""
    room = np.zeros(array.nbytes + 17, "u1")
    begin = 1 - room.ctypes.data % 2 + 2 * (array.itemsize == 1)
    view = room[begin : begin + array.nbytes].view(array.dtype).reshape(array.shape)
    view[...] = array
    return view


def read_only(array):
    copy = array.copy()
    copy.flags.writeable = False
    return copy


def spread(array):
    """Takes every other element of a larger array, in all dimensions."""
    if array.ndim == 0:
        return array
    wide = np.ones([2 * n + 1 for n in array.shape], array.dtype)
    view = wide[tuple(slice(1, None, 2) for _ in array.shape)]
    view[...] = array
    return view


def in_record(array):
    """Takes a field after a byte: rows at odd distances."""
    if array.ndim == 0:
        return array
    record = np.zeros(len(array), [("pad", "u1"), ("it", array.dtype, array.shape[1:])])
    record["it"] = array
    return record["it"]


def in_file(array):
    with tempfile.NamedTemporaryFile() as file:
        mapped = np.memmap(file.name, array.dtype, "w+", shape=array.shape or (1,))
    mapped[...] = array
    return mapped if array.shape else mapped[0]


class Owner:
    """An object that returns its array, like a tensor."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array if dtype is None else self.array.astype(dtype)


STORAGES = {
    "as it is": lambda array: array,
    "copied": lambda array: array.copy(),
    "Fortran": lambda array: array.copy(order="F"),
    "backwards": lambda array: array[::-1].copy()[::-1] if array.ndim else array,
    "mirrored": lambda array: array[..., ::-1].copy()[..., ::-1] if array.ndim else array,
    "transposed": lambda array: array.T.copy().T,
    "spread": spread,
    "misaligned": misaligned,
    "misaligned and swapped": lambda array: misaligned(array.astype(array.dtype.newbyteorder())),
    "misaligned and spread": lambda array: spread(misaligned(array)),
    "big-endian": lambda array: array.astype(array.dtype.newbyteorder(">")),
    "little-endian": lambda array: array.astype(array.dtype.newbyteorder("<")),
    "big-endian and spread": lambda array: spread(array.astype(array.dtype.newbyteorder(">"))),
    "read-only": read_only,
    "in a record": in_record,
    "in a file": in_file,
    "subclass": lambda array: array.view(type("Own", (np.ndarray,), {})),
    "owner": Owner,
    "list": lambda array: array.tolist(),
    "wider": lambda array: array.astype({"f": "f8", "i": "i8", "b": "u2"}[array.dtype.kind]),
    "widest": lambda array: array.astype(
        {"f": np.longdouble, "i": ">i8", "b": ">i4"}[array.dtype.kind]
    ),
}


class Storing(unittest.TestCase):
    """Every input in every storage has the same verdicts, bit for bit."""

    def test_an_episode(self):
        arrays = episode()
        expected = etlc.Monitor(text=SPEC).run(arrays).table.tobytes()
        for name, array in arrays.items():
            for storage, stored in STORAGES.items():
                given = {**arrays, name: stored(array)}
                found = etlc.Monitor(text=SPEC).run(given).table.tobytes()
                self.assertEqual(found, expected, f"{name}, {storage}")

    def test_steps(self):
        arrays = episode()
        expected = etlc.Monitor(text=SPEC).run(arrays).table.tobytes()
        for name, array in arrays.items():
            for storage, stored in STORAGES.items():
                monitor = etlc.Monitor(text=SPEC)
                said = b""
                for n in range(len(array)):
                    given = {other: rows[n] for other, rows in arrays.items()}
                    given[name] = stored(np.asarray(array[n]))
                    said += monitor.step(**given)._raw
                self.assertEqual(said, expected, f"{name}, {storage}")

    def test_a_row_for_all_steps(self):
        arrays = episode()
        for name, array in arrays.items():
            row = np.broadcast_to(array[3], array.shape)
            expected = etlc.Monitor(text=SPEC).run({**arrays, name: row.copy()}).table
            found = etlc.Monitor(text=SPEC).run({**arrays, name: row}).table
            self.assertEqual(found.tobytes(), expected.tobytes(), name)

    def test_a_number_is_rounded_once(self):
        text = "spec t; input x : f32; sliding monitor m = x >= 0;"
        between = np.longdouble(1) + np.longdouble(2) ** -24 + np.longdouble(2) ** -60
        for number, rounded in (
            (between, 1 + 2.0**-23), (2**54 + 2**30 + 1, 2.0**54 + 2.0**31),
            (np.int64(2**54 + 2**30 + 1), 2.0**54 + 2.0**31), (10**30, np.float32(1e30)),
            (2**100 + 2**76 + 1, 2.0**100 + 2.0**77),
            (0.1, np.float32(0.1)), (np.float64(0.1), np.float32(0.1)),
        ):  # fmt: skip
            found = etlc.Monitor(text=text).step(x=number).m.robustness
            self.assertEqual(found, rounded, number)
        for huge in (10**400, -(10**5000), 2**128):
            self.assertTrue(etlc.Monitor(text=text).step(x=huge).m.unknown)


class Refusing(unittest.TestCase):
    def test_arrays_that_mean_nothing(self):
        masked = np.ma.masked_array
        ragged = [[1.0], [1.0, 2.0]]

        class Tensor:  # on a device
            def __array__(self, *_, **__):
                raise RuntimeError("not here")

        of_step = {
            "z": [1.0, None, "1 0 0", {}, b"abc", ragged, [None] * 3, ["1", "0", "0"], Tensor(),
                  np.zeros(3, "c8"), np.zeros(3, "O"), np.zeros(3, "i8"), np.zeros(3, "?"),
                  np.zeros(3, "M8[s]"), np.zeros(3, "S1"), np.zeros(2, "f4"), np.zeros((3, 1)),
                  np.zeros(()), np.zeros(0), np.zeros(3, "f4,f4"), masked([1.0, 2, 3]),
                  np.ma.masked, [np.ma.masked, 1.0, 2.0]],
            "x": ["1", True, np.bool_(True), 1j, [1.0], np.zeros(1), np.zeros((1, 1)), [], {},
                  np.ma.masked, masked(1.0), masked(1.0, True), np.datetime64("2020"), ragged,
                  np.zeros((), "f4,f4"), Tensor()],
            "stop": [1.0, float("nan"), np.float32(0), 2, -1, 2**70, "no", "", [], [True],
                     np.array([True]), np.ma.masked, masked(True, True), ragged, Tensor()],
            "half": [np.zeros(2, "i2"), np.zeros(2, "u2"), np.zeros(2, "?"), np.zeros(3, "f2")],
            "byte": [np.zeros(2, "f4"), np.array([0, 128]), np.array([-129, 0]), [0, 2**40],
                     [0, 2**70], np.zeros(2, "?"), [0.5, 1], np.array([0, 2**63], "u8")],
        }  # fmt: skip
        for name, wrongs in of_step.items():
            monitor = etlc.Monitor(text=SPEC)
            for wrong in wrongs:
                if wrong is None:
                    continue
                with self.assertRaisesRegex(etlc.InputError, f"input '{name}' ", msg=wrong):
                    monitor.step(**{name: wrong})
            self.assertEqual(monitor.steps, 0)
        arrays = episode(3)
        of_run = {
            "z": [arrays["z"][0], arrays["z"][None], 1.0, "z", ragged, [],
                  [masked([1.0, 2, 3], [1, 0, 0])] * 3, arrays["z"].astype("c8"), Tensor()],
            "x": [1.0, arrays["z"], arrays["x"].astype("i8"), arrays["x"].astype("?"),
                  [True, False, True], np.array(["1", "2", "3"]), [1.0, None, 2.0],
                  [1.0, np.ma.masked, 2.0]],
            "stop": [arrays["x"], [0, 1, 2], [True, None, False], [1.0, 0.0, float("nan")]],
        }  # fmt: skip
        for name, wrongs in of_run.items():
            monitor = etlc.Monitor(text=SPEC)
            for wrong in wrongs:
                with self.assertRaisesRegex(etlc.InputError, f"input '{name}' ", msg=wrong):
                    monitor.run({**arrays, name: wrong})
            self.assertEqual(monitor.steps, 0)
        for wrong in (np.zeros((3, 2)), [1, 2], "z"):
            with self.assertRaisesRegex(etlc.InputError, "expected a dict"):
                etlc.Monitor(text=SPEC).run(wrong)

    def test_masked_steps_without_any(self):
        none = {name: np.ma.masked_array(array[:0]) for name, array in episode().items()}
        self.assertEqual(len(etlc.Monitor(text=SPEC).run(none)), 0)


if __name__ == "__main__":
    unittest.main()
