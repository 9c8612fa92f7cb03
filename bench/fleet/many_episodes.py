#!/usr/bin/env python3
"""many_episodes.py ETLC FOLDER [STEPS]: the cost of calibrate and evaluate for 1000, 10 000 and
100 000 synthetic episodes of STEPS (20) steps: microseconds per episode, and peak memory.

Missing episodes are made in FOLDER: two sets of 100 000 small tables.
Prints a line for each command and number: seconds, microseconds per episode, the peak resident
memory of the process, and bytes per episode beyond those of 1000."""
import os
import pathlib
import random
import subprocess
import sys
import time

ETLC, FOLDER = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
STEPS = int(sys.argv[3]) if len(sys.argv) > 3 else 20
NUMBERS = (1000, 10_000, 100_000)
SPEC = """spec fleet;
input z : f32[2];
input x : f32;
target goal = [[0, 0], [1, 0]];
predicate near = min l2(z, goal) <= calibrated(conformal, alpha = 0.1);
predicate close = min l2(z, goal) <= calibrated(f1);
truth near = x < 1;
truth close = x < 0.5;
monitor arrives = F near;
monitor keeps = G (close -> near);
"""


def make_episodes(folder, seed):
    """Folders of 1000, so a number of episodes is a number of folders."""
    numbers = random.Random(seed)
    for thousand in range(NUMBERS[-1] // 1000):
        place = folder / f"{thousand:03}"
        if place.exists():
            continue
        half = folder / f"{thousand:03}.half"
        half.mkdir(parents=True, exist_ok=True)
        for episode in range(1000):
            x, rows = numbers.uniform(0, 3), ["z[0],z[1],x"]
            for _ in range(STEPS):
                x += numbers.gauss(-0.05, 0.2)
                rows.append(f"{x + numbers.gauss(0, 0.3):.7g},{numbers.gauss(0, 0.3):.7g},{x:.7g}")
            (half / f"{episode:03}.csv").write_text("\n".join(rows) + "\n")
        half.rename(place)


def measured(*words):
    """Returns wall-clock seconds, seconds of all cores, and the peak resident bytes."""
    begin = time.perf_counter()
    process = subprocess.Popen([ETLC, *words], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, words
    return time.perf_counter() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def main():
    for name, seed in (("one", 1), ("two", 2)):
        make_episodes(FOLDER / name, seed)
    os.chdir(FOLDER)
    pathlib.Path("fleet.etl").write_text(SPEC)
    print("command      episodes   seconds  cpu us/episode  peak MB  bytes/episode more")
    calls = {"calibrate": ["one", "-o", "thresholds.json"],
             "evaluate": ["two", "--thresholds", "thresholds.json"]}
    least = {}
    for number in NUMBERS:  # evaluate uses thresholds from the same number of episodes
        for command, (data, *words) in calls.items():
            folders = [f"{data}/{thousand:03}" for thousand in range(number // 1000)]
            seconds, cpu, peak = measured(command, "fleet.etl", "--data", *folders, *words)
            first = least.setdefault(command, peak)
            more = "" if number == NUMBERS[0] else f"{(peak - first) / (number - NUMBERS[0]):8.0f}"
            print(f"{command:10} {number:10} {seconds:9.2f} {1e6 * cpu / number:15.0f} "
                  f"{peak / 1e6:8.0f} {more}", flush=True)


main()
