#!/usr/bin/python3
"""The verdicts of etlc.Monitor have the bits of generated classes.

same_bits_test.py FOLDER: FOLDER has the specs, traces and verdicts of same_bits.
"""

import sys
from pathlib import Path

import numpy as np

import etlc

MOST = 64 << 20


def restarts_before(step, monitor):
    """Computes the restarts of tests/monitor/driver/restarts_before.hpp."""
    return (7 * step + 3 * monitor) % 23 in (5, 12)


def read(spec, ending):
    return spec.with_suffix(ending).read_text().split()


def samples_of(monitor, spec):
    """Returns all steps of each input, masked where it is missing."""
    samples = {}
    for name, one in monitor.inputs.items():
        array = np.fromfile(spec.with_suffix(f".{name}"), one.dtype).reshape(-1, *one.shape)
        present = np.fromfile(spec.with_suffix(f".{name}.present"), "u1") != 0
        absent = ~present.reshape(-1, *(1 for _ in one.shape))
        samples[name] = np.ma.array(array, mask=np.broadcast_to(absent, array.shape))
    return samples


def stepped(monitor, episode, restarts):
    """Steps one by one, because a run cannot restart monitors."""
    monitor.reset()
    missing = {name: np.ma.getmaskarray(rows).reshape(len(rows), -1)[:, 0].tolist()
               for name, rows in episode.items()}  # fmt: skip
    rows = {name: one.data for name, one in episode.items()}
    said = []
    for step in range(len(next(iter(rows.values())))):
        for name, number in restarts:
            if restarts_before(step, number):
                monitor.restart(name)
        given = {name: None if missing[name][step] else one[step] for name, one in rows.items()}
        said.append(monitor.step(**given)._raw)
    return b"".join(said)


def compare(spec):
    """Returns how many steps agree."""
    monitor = etlc.Monitor(spec, max_state=MOST, max_code=MOST, max_work=MOST)
    samples = samples_of(monitor, spec)
    expected = spec.with_suffix(".verdicts").read_bytes()
    words = read(spec, ".restarts")
    restarts = [(name, int(number)) for name, number in zip(words[::2], words[1::2])]
    width = 16 * len(monitor.monitors)
    first = 0
    for steps in map(int, read(spec, ".episodes")):
        last = first + steps
        episode = {name: array[first:last] for name, array in samples.items()}
        found = (
            stepped(monitor, episode, restarts) if restarts
            else monitor.run(episode).table.tobytes()
        )  # fmt: skip
        if found != expected[width * first : width * last]:
            sys.exit(f"{spec}: other verdicts in steps {first} to {last}")
        first = last
    if width * first != len(expected):
        sys.exit(f"{spec}: {first} steps, {len(expected) // width} of them have verdicts")
    return first


steps = [compare(spec) for spec in sorted(Path(sys.argv[1]).glob("[0-9]*.etl"))]
print(f"{sum(steps)} steps of {len(steps)} specs agree")
sys.exit(sum(steps) < 1_000_000)
