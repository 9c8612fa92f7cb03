#!/usr/bin/env python3
"""same_recording_test.py ETLC: every way from a recording to another episode, in every storage.
`etlc calibrate`, `evaluate`, and calibration on the episodes of a fit refuse it; other recordings
pass in the same way."""
import contextlib
import ctypes
import ctypes.util
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

from demonstrations import CONFORMAL, D, EPISODES, STEPS, World


def csv(path, z, label, write=repr):
    with open(path.with_suffix(".csv"), "w", encoding="ascii") as file:
        print(*(f"z[{i}]" for i in range(z.shape[1])), "truth.a", sep=",", file=file)
        for row, holds in zip(z, label):
            print(*(write(float(x)) for x in row), int(holds), sep=",", file=file)


def npz(kind):
    def store(path, z, label):
        np.savez(path.with_suffix(".npz"), z=z.astype(kind), **{"truth.a": label})
    return store


def fortran(path, z, label):
    np.savez_compressed(path.with_suffix(".npz"), z=np.asfortranarray(z), **{"truth.a": label})


def h5(path, z, label):
    """Writes the arrays of a group with the C library."""
    lib = ctypes.CDLL(ctypes.util.find_library("hdf5_serial") or ctypes.util.find_library("hdf5"))
    for name in ("H5Fcreate", "H5Screate_simple", "H5Dcreate2"):
        getattr(lib, name).restype = ctypes.c_int64
    lib.H5open()
    handle = ctypes.c_int64
    file = handle(lib.H5Fcreate(str(path.with_suffix(".h5")).encode(), 2, handle(0), handle(0)))
    for name, array in (("z", z.astype(np.float64)), ("truth.a", label.astype(np.float64))):
        array = np.ascontiguousarray(array)
        shape = (ctypes.c_uint64 * array.ndim)(*array.shape)
        space = handle(lib.H5Screate_simple(array.ndim, shape, None))
        double = handle.in_dll(lib, "H5T_NATIVE_DOUBLE_g")
        data = handle(lib.H5Dcreate2(file, name.encode(), double, space, handle(0), handle(0),
                                     handle(0)))
        lib.H5Dwrite(data, double, handle(0), handle(0), handle(0),
                     array.ctypes.data_as(ctypes.c_void_p))
        lib.H5Dclose(data)
    lib.H5Fclose(file)


def relu(z):
    return np.where(z > 0, z, np.float32(0))


def negative_zeros(z):
    z = relu(z)
    z[::2][z[::2] == 0] = -0.0
    return z


def gaps(value):
    """Missing frames, marked by one number or by all."""
    def edit(z):
        z = z.copy()
        z[2::5] = value
        z[3::5, 1] = value
        return z
    return edit


def frozen(z):
    z = z.copy()
    z[3:8] = z[3]
    return z


def without_stale(z):
    """The effect of `stale after 2` on frozen frames."""
    z = frozen(z)
    z[5:8] = np.nan
    return z


def first(n):
    return lambda z: z[:n]


def few(n):
    """Keeps this many frames; the rest is missing."""
    def edit(z):
        z = z.copy()
        z[n:] = np.nan
        return z
    return edit


def blank(x):
    return "" if np.isnan(x) else repr(x)


def blanks(path, z, label):
    csv(path, z, label, blank)


def same(z):
    return z


# input, original storage of all, storage of the copy
EPISODE_ROADS = [
    ("f32", same, npz("f4"), same, npz("f4"), "E0664"),
    ("f32", same, npz("f4"), same, npz("f8"), "E0664"),
    ("f32", same, npz("f4"), same, fortran, "E0664"),
    ("f32", same, npz("f4"), same, csv, "E0664"),
    ("f32", same, npz("f4"), same, h5, "E0664"),
    ("f32", same, csv, same, h5, "E0664"),
    ("f16", same, npz("f4"), same, npz("f2"), "E0664"),
    ("f16", same, npz("f2"), same, csv, "E0664"),
    ("f16", same, npz("f8"), same, npz("f2"), "E0664"),
    ("f16", same, h5, first(9), npz("f2"), "E0667"),
    ("f32", relu, npz("f4"), negative_zeros, npz("f4"), "E0664"),
    ("f32", relu, csv, negative_zeros, csv, "E0664"),
    ("f32", gaps(np.nan), npz("f4"), gaps(np.inf), npz("f4"), "E0664"),
    ("f32", gaps(-np.inf), npz("f4"), gaps(np.nan), blanks, "E0664"),
    ("f16", gaps(np.nan), blanks, gaps(np.inf), npz("f2"), "E0664"),
    ("f16", gaps(np.nan), npz("f4"), gaps(1e6), npz("f4"), "E0664"),  # beyond float16
    ("f32", same, npz("f4"), first(STEPS - 1), csv, "E0667"),
    ("f32", same, npz("f4"), lambda z: z[3:], npz("f8"), "E0667"),
    ("f32", few(5), npz("f4"), few(5), blanks, "E0664"),
    ("f32", few(5), npz("f4"), few(4), npz("f4"), "E0667"),
    ("f32", few(7), npz("f4"), lambda z: few(7)(z)[1:], npz("f4"), "E0667"),
    ("f32", first(5), npz("f4"), first(4), csv, "E0667"),
    ("f32", first(3), npz("f4"), first(2), npz("f4"), "E0667"),
    ("f16", first(6), npz("f4"), first(5), npz("f2"), "E0667"),
    ("f32 hold 3", gaps(np.nan), npz("f4"), lambda z: held(gaps(np.nan)(z)), npz("f4"), "E0664"),
    ("f32 , stale after 2", frozen, npz("f4"), without_stale, csv, "E0664"),
    ("f16 , stale after 2", without_stale, npz("f2"), frozen, npz("f8"), "E0664"),
]


def held(z):
    """The effect of `hold`."""
    for t in range(1, len(z)):
        if np.isnan(z[t]).any():
            z[t] = z[t - 1]
    return z


def episode_spec(kind):
    name, _, rest = kind.partition(" ")
    return (f"spec t; input z : {name}[{D}] {rest};\n"
            f"target g = [[{', '.join(['0.5'] * D)}]];\n"
            f"predicate a = l2(z, g) {CONFORMAL};\nmonitor m = F a;\n")


def fit_spec(kind):
    fitted = ("projection E = fitted(pca, r = 2, of = z, where = true);\n"
              "target c = fitted(mean, of = E(z), where = a);\n")
    return episode_spec(kind).replace("predicate", fitted + "predicate").replace(
        "l2(z, g)", "l2(E(z), c)")


def stored(world, part, number, store, z):
    path = world.folder / part
    path.mkdir(exist_ok=True)
    store(path / f"{number:02}", z, np.arange(len(z)) % 3 == 0)


def clear(world, *parts):
    for part in parts:
        for path in (world.folder / part).glob("*"):
            path.unlink()


def test_episodes(world):
    for kind, edit, store, other_edit, other_store, expected in EPISODE_ROADS:
        world.spec(episode_spec(kind))
        for repeats in (True, False):
            clear(world, "demos", "new")
            for number, (z, _) in enumerate(world.demos):
                stored(world, "demos", number, store, edit(z))
            z = (world.demos if repeats else world.others)[4][0]
            stored(world, "new", 99, other_store, other_edit(z))
            road = (kind, edit, store, other_edit, other_store, expected, repeats)
            says = world.run("calibrate", "--data", "demos", "new", "-o", "t.thresholds.json")
            assert says == ({expected} if repeats else set()), (road, says)
            says = world.run("calibrate", "--data", "demos", "-o", "t.thresholds.json")
            assert says == set(), (road, says)
            says = world.run("evaluate", "--data", "new")
            assert ("E0670" in says) == repeats, (road, says)
            world.spec(fit_spec(kind))
            says = world.run("fit", "--data", "demos", "-o", "t.fitted.npz")
            assert not any(code[0] == "E" for code in says), (road, says)
            says = world.run("calibrate", "--data", "new", "-o", "t.json")
            assert ("E0675" in says) == repeats, (road, says)
            world.spec(episode_spec(kind))


def test_scalars(world):
    """A scalar out of range is missing, like an empty cell, and so is one that `hold` ends."""
    world.spec("spec t; input s : f32 in [-1, 1] hold 1;\n"
               f"predicate a = s {CONFORMAL};\nmonitor m = F a;\n")
    clear(world, "demos", "new")
    signals = world.random.uniform(-1, 1, (EPISODES + 1, 40)).astype(np.float32)

    def store(part, number, cells):
        lines = [f"{cell},{int(t % 3 == 0)}" for t, cell in enumerate(cells)]
        (world.folder / part / f"{number:02}.csv").write_text("\n".join(["s,truth.a", *lines]))

    def cells(signal, missing, held, zero):
        all_ = [repr(float(x)) for x in signal]
        all_[5] = all_[20] = all_[21] = missing
        all_[30] = zero
        return all_[:11] + [all_[10] if held else missing] + all_[12:]

    for number, signal in enumerate(signals[:EPISODES]):
        store("demos", number, cells(signal, "7", False, "0"))
    for missing, held in itertools.product(("", "nan", "-inf", "1.5"), (False, True)):
        for signal, expected in ((signals[3], {"E0664"}), (signals[EPISODES], set())):
            store("new", 99, cells(signal, missing, held, "-0.0"))
            says = world.run("calibrate", "--data", "demos", "new", "-o", "t.json")
            assert says == expected, (missing, held, expected, says)


def store_beside(world, part, number, z, charge):
    path = world.folder / part
    path.mkdir(exist_ok=True)
    np.savez(path / f"{number:02}.npz", z=z, charge=charge.astype(np.float32),
             **{"truth.a": np.arange(len(z)) % 3 == 0})


def test_beside_scalars(world):
    """An embedding is the same recording whatever scalar was recorded with it, for calibration,
    evaluation and after a fit; and others are not, whatever clock they share."""
    spec = episode_spec("f32").replace("l2(z, g)", "l2(z, g) + 0.1 * charge").replace(
        "target", "input charge : f32; target", 1)
    fitted = fit_spec("f32").replace("l2(E(z), c)", "l2(E(z), c) + 0.1 * charge").replace(
        "projection", "input charge : f32; projection", 1)
    steps = 40

    def still(different):
        """Stands at a few samples, one after the other."""
        samples = world.random.normal(size=(different, D)).astype(np.float32)
        return samples[np.arange(steps) * different // steps]

    moving = [world.episode(steps)[0] for _ in range(EPISODES + 1)]
    standing = [still(5 + i % 8) for i in range(EPISODES + 1)]
    for kind, drives in (("moving", moving), ("standing", standing)):
        for beside in ("noise", "clock"):
            def charge():
                return (world.random.random(steps) if beside == "noise"
                        else 0.1 * np.arange(steps))
            clear(world, "demos", "new")
            for number, z in enumerate(drives[:EPISODES]):
                store_beside(world, "demos", number, z, charge())
            world.spec(spec)
            road = (kind, beside)
            found = world.run("calibrate", "--data", "demos", "-o", "t.thresholds.json")
            assert found == set(), road
            world.spec(fitted)
            assert world.run("fit", "--data", "demos", "-o", "t.fitted.npz") == set(), road
            for number, repeats in ((3, True), (EPISODES, False)):
                store_beside(world, "new", 99, drives[number], world.random.random(steps))
                world.spec(spec)
                says = world.run("calibrate", "--data", "demos", "new", "-o", "t.json")
                assert says == ({"E0664"} if repeats else set()), (road, number, says)
                says = world.run("evaluate", "--data", "new")
                assert ("E0670" in says) == repeats, (road, number, says)
                world.spec(fitted)
                says = world.run("calibrate", "--data", "new", "-o", "t.json")
                assert ("E0675" in says) == repeats, (road, number, says)


def has_nameless_file(process, folder):
    """Returns whether a process writes a file that has no name yet in the folder."""
    with contextlib.suppress(OSError):  # of descriptors that are closed meanwhile
        for link in pathlib.Path(f"/proc/{process}/fd").iterdir():
            of = os.readlink(link)
            if of.startswith(f"{folder}/") and of.endswith(" (deleted)"):
                return True
    return False


def test_another_call(world):
    """The thresholds to which those of monitors are added are not replaced where another call has
    changed them meanwhile. A pipe that is full holds etlc before the file takes its name."""
    (world.folder / "w.etl").write_text(
        "spec w; input x : f32; predicate a = x <= calibrated(conformal, alpha = 0.25);\n"
        "monitor m = F a calibrated(conformal, alpha = 0.25, against = missed_alarm);\n")
    for half in ("first", "second"):
        (world.folder / half).mkdir()
        for number in range(8):
            x = np.linspace(3, 0, 20) + world.random.normal(0, 0.1, 20)
            np.savez(world.folder / half / f"{number}.npz", **{"x": x, "truth.a": x < 1})

    def call(*words, **options):
        return subprocess.Popen([world.etlc, "calibrate", "w.etl", "--data", *words],
                                cwd=world.folder, stderr=subprocess.PIPE, text=True, **options)

    assert call("first", stdout=subprocess.DEVNULL).wait() == 0
    file = world.folder / "w.thresholds.json"
    for changes in (True, False):
        readable, writable = os.pipe()
        os.set_blocking(writable, False)
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(writable, b" " * 512)
        os.set_blocking(writable, True)
        adding = call("second", "--thresholds", file.name, stdout=writable)
        os.close(writable)
        while not has_nameless_file(adding.pid, world.folder.resolve()):
            assert adding.poll() is None, adding.stderr.read()
            time.sleep(0.01)
        before = file.read_text() + ("\n" if changes else "")
        file.write_text(before)
        with open(readable, encoding="utf-8") as pipe:
            pipe.read()
        said = adding.stderr.read()
        if changes:
            assert adding.wait() == 1 and "[E0901]" in said and "since it was read" in said, said
            assert file.read_text() == before
        else:
            assert adding.wait() == 0 and "m" in json.loads(file.read_text())["monitors"], said


def main(etlc):
    with tempfile.TemporaryDirectory() as name:
        world = World(etlc, pathlib.Path(name), 1)
        test_episodes(world)
        test_scalars(world)
        test_beside_scalars(world)
        test_another_call(world)


if __name__ == "__main__":
    main(sys.argv[1])
