#!/usr/bin/python3
"""Compares a step from Python with the plan's own work.

step.py SPEC.etl...: microseconds per step of `Monitor.step` with a look at an alarm, and of
`Monitor.run`, which takes the same steps in one call; and of `Guard.step` the 99th percentile.
PYTHONPATH and ETLC_LIBRARY lead to the package.
"""

import statistics
import sys
import time

import numpy as np

import etlc

STEPS, ROUNDS = 20_000, 7


def microseconds(work):
    """Uses this process's own time, which a busy machine does not increase."""
    times = []
    for _ in range(ROUNDS):
        begin = time.process_time()
        work()
        times.append((time.process_time() - begin) / STEPS * 1e6)
    return statistics.median(times)


def percentile_of_guard(monitor, rows):
    """Returns the 99th percentile of the microseconds of a step of the guard."""
    monitor.reset()
    guard = etlc.Guard(monitor)
    times = []
    for row in rows:
        begin = time.process_time()
        guard.step(row)
        times.append(time.process_time() - begin)
    return float(np.percentile(times, 99)) * 1e6


def main():
    print(f"{'us a step':40} {'run':>8} {'step':>8} {'more':>8} {'guard, 99 %':>12}")
    for path in sys.argv[1:]:
        monitor = etlc.Monitor(path)
        random = np.random.default_rng(1)
        arrays = {
            name: random.random((STEPS, *one.shape)).astype(one.dtype)
            for name, one in monitor.inputs.items()
        }
        rows = [dict(zip(arrays, row)) for row in zip(*arrays.values())]
        first = monitor.monitors[0]

        def steps():
            monitor.reset()
            for row in rows:
                monitor.step(**row)[first].alarm

        own, through = microseconds(lambda: monitor.run(arrays)), microseconds(steps)
        guarded = percentile_of_guard(monitor, rows)
        print(f"{path:40} {own:8.2f} {through:8.2f} {through - own:8.2f} {guarded:12.2f}")


main()
