#!/usr/bin/env python3
"""leaks_test.py ETLC [EVERY]: every way from a frame of a demonstration to a row of a target. `etlc
calibrate` refuses it and `evaluate` warns; rows of another recording pass in the same way. With
EVERY = 5 only every fifth combination is tried, for slow builds."""
import itertools
import pathlib
import sys
import tempfile

import numpy as np

from demonstrations import CONFORMAL, D, EPISODES, PREDICATES, WHOLE, World

# How rows are made from frames, where they are declared, and which point measures them.

def as_recorded(world, z):
    return z


def by_float64(*maps):
    def rows(world, z):
        z = z.astype(np.float64)
        for name in maps:
            z = z @ getattr(world, name).astype(np.float64).T
        return z
    return rows


def by_float32(*maps):
    def rows(world, z):
        for name in maps:  # term by term, from the last
            matrix = getattr(world, name)
            sums = np.zeros((len(z), len(matrix)), np.float32)
            for j in reversed(range(matrix.shape[1])):
                sums = (sums + z[:, j:j + 1] * matrix[:, j]).astype(np.float32)
            z = sums
        return z
    return rows


def with_offset(world, z):
    return z.astype(np.float64) @ world.q.T.astype(np.float64) - world.q.astype(
        np.float64) @ world.m.astype(np.float64)


def multiple(of, factor):
    return lambda world, z: factor * of(world, z).astype(np.float64)


def put_together(first, second):
    """Rows of which both parts are frames, though not of one episode."""
    return lambda world, z: np.hstack([first(world, z), second(world, z[::-1])])


def beside_the_map(world, z):
    """Frames that only Q makes equal."""
    null = np.linalg.svd(world.q.astype(np.float64))[2][len(world.q):]
    return z + world.random.normal(size=(len(z), len(null))) @ null


def of_small_weight(world, z):
    """Frames that differ only where the weights are almost zero."""
    z = z.copy()
    z[:, 5:] += 1
    return z


PLAIN = {"l2", "l1", "linf", "l2sq"}
#     point, space of the rows, metrics, rows
TARGETS = [
    ("z", "", PLAIN | {"mahalanobis([1, 2, 3, 4, 5, 6, 7, 8])"}, as_recorded),
    ("z", "", {"cosine", "angular"}, multiple(as_recorded, 3)),
    ("z", "", {"mahalanobis([1, 2, 3, 4, 5, 1e-20, 1e-20, 1e-20])"}, of_small_weight),
    ("Q(z)", "", {"l2"}, as_recorded),
    ("Q(z)", "", PLAIN | {"cosine"}, beside_the_map),
    ("Q(z)", " of Q(z)", PLAIN | {"mahalanobis([1, 2, 3, 4])"}, by_float64("q")),
    ("Q(z)", " of Q(z)", PLAIN, by_float32("q")),
    ("Q(z)", " of Q(z)", {"cosine", "angular"}, multiple(by_float64("q"), 0.3)),
    ("C(z)", " of C(z)", {"l2", "linf"}, with_offset),
    ("P(Q(z))", " of Q(z)", PLAIN, by_float32("q")),
    ("P(Q(z))", " of P(Q(z))", PLAIN, by_float64("q", "p")),
    ("P(Q(z))", " of P(Q(z))", {"l2"}, by_float32("q", "p")),
    ("P(Q(z))", " of P(Q(z))", {"cosine", "angular"}, multiple(by_float32("q", "p"), 7)),
    ("L(z)", " of L(z)", {"l2"}, by_float64("line")),
    ("L(z)", " of L(z)", {"l1"}, by_float32("line")),
    ("Q(z@1)", "", {"l2"}, as_recorded),
    ("P(Q(z@1)@2)", " of Q(z)", {"l1"}, by_float32("q")),
    ("[z, z@2]", "", {"l2", f"mahalanobis([{', '.join('12345678' * 2)}])"},
     put_together(as_recorded, as_recorded)),
    ("[z, z@2]@1", "", {"cosine"}, multiple(put_together(as_recorded, beside_the_map), 3)),
    ("[Q(z@1), z]", "", {"linf"}, put_together(by_float32("q"), beside_the_map)),
    ("B([z, z@1])", "", {"l2"}, put_together(beside_the_map, as_recorded)),
]
STORED = ["<f8", "<f4", "<f2", "fortran", "npz", "literal"]


def target(world, rows, stored):
    if stored == "literal":
        return "[" + ", ".join("[" + ", ".join(f"{x:.9g}" for x in r) + "]" for r in rows) + "]"
    if stored == "npz":
        np.savez(world.folder / "g.npz", other=rows, rows=rows.astype(np.float32))
        return 'load("g.npz", "rows")'
    array = np.asfortranarray(rows) if stored == "fortran" else rows.astype(stored)
    np.save(world.folder / "g.npy", array)
    return 'load("g.npy")'


def target_spec(kind, space, point, metrics, rows, monitor):
    """One predicate a metric. `monitor`: calibrated as a whole, with a literal threshold."""
    threshold = "<= 0.5" if monitor else CONFORMAL
    names = PREDICATES[:len(metrics)]
    predicates = "".join(f"predicate {name} = min {metric}({point}, g) {threshold};\n"
                         for name, metric in zip(names, metrics))
    return (f"spec t; input z : {kind};\n"
            'projection Q = load("q.npy"); projection P = load("p.npy");\n'
            'projection L = load("l.npy"); projection C = load("q.npy") offset load("m.npy");\n'
            'projection B = load("w.npy");\n'
            f"target g = {rows}{space};\n"
            f"{predicates}monitor m = F ({' && '.join(names)}){WHOLE if monitor else ''};\n")


def told_of_targets(world, spec):
    """Returns the messages of calibrate and evaluate."""
    world.spec(spec)
    calibrated = world.run("calibrate", "--data", "demos", "-o", "t.json")
    literal = spec.replace(CONFORMAL, "<= 0.5").replace(WHOLE, "")
    world.spec(literal)
    return calibrated, world.run("evaluate", "--data", "demos")


def test_targets(world, every):
    world.write("demos", world.demos)
    roads = 0
    for (point, space, metrics, rows), stored in list(itertools.product(TARGETS, STORED))[::every]:
        def told(part, metrics, monitor):
            frames = np.stack([z[3] for z, _ in getattr(world, part)])
            made = target(world, rows(world, frames), stored)
            return told_of_targets(
                world, target_spec(f"f32[{D}]", space, point, metrics, made, monitor))

        for metric in sorted(metrics):
            for monitor in (False, True) if metric in ("l2", "cosine") else (False,):
                says = told("demos", [metric], monitor)
                assert says == ({"E0665"}, {"W0670"}), (point, space, metric, rows, stored, says)
                roads += 1
        # No metric finds anything in other recordings: one spec shows it for all.
        for monitor in (False, True):
            says = told("others", sorted(metrics), monitor)
            assert "E0665" not in says[0], (point, space, rows, stored, says)
            assert "W0670" not in says[1], (point, space, rows, stored, says)
    return roads


def test_frames_and_single_rows(world):
    """`frames(...)` of a demonstration, one row among others, and inputs that round."""
    for kind, grain in ((f"f32[{D}]", 0), (f"f16[{D}]", 0), (f"i8[{D}] scale 0.03125", 32)):
        def integers(episodes):
            return [(np.clip(np.round(z * grain), -128, 127) if grain else z, label)
                    for z, label in episodes]
        written = integers(world.demos)
        world.write("demos", written)
        world.write("aside", integers(world.others))
        for point, leaks in itertools.product(("z", "Q(z)", "P(Q(z))"), (True, False)):
            rows = f'frames("{"demos" if leaks else "aside"}/04.npz", "z", [3])'
            says = told_of_targets(world, target_spec(kind, "", point, ["l2"], rows, False))
            assert ("E0665" in says[0]) == leaks, (kind, point, says)
        # Behind both maps int8 rounds too much to tell.
        spaces = {" of Q(z)": "q", " of P(Q(z))": "p"} if kind[0] == "f" else {" of Q(z)": "q"}
        for space, name in spaces.items():
            frames = np.stack([z[3] for z, _ in written[:5]]) / (grain or 1)
            for leaks in (True, False):
                z = frames if leaks else np.stack([z[3] for z, _ in world.others[:5]])
                made = by_float64("q", "p")(world, z) if name == "p" else by_float64("q")(world, z)
                far = np.full_like(made[:1], 9)
                rows = target(world, np.concatenate([far, made]), "<f4")
                point = space[4:]
                says = told_of_targets(world, target_spec(kind, space, point, ["l2"], rows, False))
                assert ("E0665" in says[0]) == leaks, (kind, space, leaks, says)


def test_honest_lines(world):
    """On a line frames come near rows by chance: many frames, many rows, many times."""
    refused = 0
    for seed in range(6):
        random = np.random.default_rng(1000 + seed)
        world.write("demos", [(random.normal(size=(2000, D)).astype(np.float32),
                               np.arange(2000) % 3 == 0) for _ in range(EPISODES)])
        rows = by_float32("line")(world, random.normal(size=(400, D)).astype(np.float32))
        for stored in ("<f4", "<f2"):
            made = target(world, rows, stored)
            world.spec(target_spec(f"f32[{D}]", " of L(z)", "L(z)", ["l2"], made, False))
            refused += "E0665" in world.run("calibrate", "--data", "demos", "-o", "t.json")
    assert refused == 0, refused


def main(etlc, every=1):
    with tempfile.TemporaryDirectory() as name:
        world = World(etlc, pathlib.Path(name), 1)
        print(test_targets(world, int(every)), "roads to a target")
        test_frames_and_single_rows(world)
        test_honest_lines(world)


if __name__ == "__main__":
    main(*sys.argv[1:])
