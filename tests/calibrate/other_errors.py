"""Demonstrations for other_error_test.py, calls of etlc, and plain counts of the other error with
the lines that report them."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ETLC = os.path.abspath(sys.argv[1])


def run(*words, status=0):
    done = subprocess.run([ETLC, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout, done.stderr


def episodes(count, seed, steps=24, noise=0.5,
             missing=("x", "y", "s", "speed", "armed")):
    """Returns demonstrations with missing samples and, where s is missing, unknown labels."""
    numbers = np.random.default_rng(seed)
    result = []
    for _ in range(count):
        s = np.abs(numbers.normal(0, 0.4, steps).cumsum() + 2.0)
        x = (s + numbers.normal(0, noise, steps)).astype(np.float32)
        y = (s + numbers.normal(0, noise, steps)).astype(np.float32)
        speed = numbers.uniform(0, 3, steps).astype(np.float32)
        armed = (numbers.random(steps) < 0.7).astype(np.float32)
        demo = {"x": x, "y": y, "s": s, "speed": speed, "armed": armed}
        for name in missing:
            demo[name][numbers.random(steps) < 0.05] = np.nan
        result.append(demo)
    return result


def write(folder, demonstrations):
    pathlib.Path(folder).mkdir()
    for number, arrays in enumerate(demonstrations):
        with open(f"{folder}/{number:03}.csv", "w", encoding="ascii") as file:
            print(*arrays, sep=",", file=file)
            for row in zip(*arrays.values()):
                print(*("" if value != value else int(value) if name == "armed" else
                        repr(float(value)) for name, value in zip(arrays, row)),
                      sep=",", file=file)


def holds(comparison, left, right):
    """True, False or None: unknown."""
    if left != left:
        return None
    return bool({"<=": left <= right, "<": left < right, ">=": left >= right,
                 ">": left > right}[comparison])


def left_out(spec, demonstrations, *words):
    """Returns for each demonstration the thresholds file of a call on the others."""
    files = []
    for number in range(len(demonstrations)):
        with tempfile.TemporaryDirectory(dir=".") as folder:
            write(f"{folder}/others",
                  demonstrations[:number] + demonstrations[number + 1:])
            run("calibrate", spec, "--data", f"{folder}/others", "-o", f"{number}.json", *words)
        files.append(f"{number}.json")
    return files


def splitmix(state):
    while True:
        state = (state + 0x9e3779b97f4a7c15) % 2**64
        x = state
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9 % 2**64
        x = (x ^ (x >> 27)) * 0x94d049bb133111eb % 2**64
        yield x ^ (x >> 31)


def interval(counts):
    """Returns the ends in percent of the 95 % interval of errors / cases; `counts`: (errors, cases)
    per demonstration."""
    some = [(errors, cases) for errors, cases in counts if cases > 0]
    bound = 0.025 ** (1 / len(some))
    if all(errors == 0 for errors, _ in some):
        return 0, 100 * (1 - bound)
    if all(errors == cases for errors, cases in some):
        return 100 * bound, 100
    if len(some) < 5:
        return None
    draws, shares = splitmix(2026), []
    for _ in range(1000):
        drawn = [counts[next(draws) % len(counts)] for _ in counts]
        cases = sum(cases for _, cases in drawn)
        if cases > 0:
            shares.append(sum(errors for errors, _ in drawn) / cases)
    shares.sort()
    return tuple(100 * shares[int(q * (len(shares) - 1) + 0.5)] for q in (0.025, 0.975))


def shown(counts):
    errors, cases = (sum(column) for column in zip(*counts))
    ends = interval(counts)
    text = f"{100 * errors / cases:.1f} %"
    return errors, cases, text + (f" [{ends[0]:.1f}, {ends[1]:.1f}]" if ends else "")


def predicate_line(counts):
    errors, cases, share = shown(counts)
    return f"the other error: true at {errors} of {cases} negative frames, {share}"


def monitor_lines(said, kind):
    """`said`: per demonstration a list of pairs (verdict, truth) of True, False or None."""
    wrong = kind == "success"  # the verdict of the other error
    counts, total, in_all, truly = [], 0, 0, 0
    for pairs in said:
        known = [(says, is_) for says, is_ in pairs if is_ is not None]
        cases = [says for says, is_ in known if is_ != wrong]
        counts.append((sum(says is wrong for says in cases), len(cases)))
        total += len(known)
        in_all += sum(says is wrong for says, _ in known)
        truly += sum(is_ == wrong for _, is_ in known)
    errors, cases, share = shown(counts)
    words = ("satisfied", "violated") if wrong else ("violated", "satisfied")
    return [f"the other error: {words[0]} at {errors} of {cases} truly {words[1]} steps, {share}; "
            f"in {sum(e > 0 for e, _ in counts)} of {sum(c > 0 for _, c in counts)} episodes",
            f"in all {words[0]} at {in_all} of {total} steps, truly at {truly}"]


def eventually(values):
    """F over each prefix, in Kleene's logic."""
    result = []
    for end in range(1, len(values) + 1):
        result.append(True if True in values[:end] else None if None in values[:end] else False)
    return result


def negated(values):
    return [None if value is None else not value for value in values]


def both(*lists):
    return [False if False in row else None if None in row else True for row in zip(*lists)]


def within(values, high):
    """Sliding F[0, high]; positions behind the end do not count."""
    return [eventually(values[at:at + high + 1])[-1] for at in range(len(values))]


def lines_of(report):
    """Returns the lines of each predicate and guarantee, by name and part."""
    found, name = {}, None
    for line in report.splitlines():
        head = re.match(r"(\w+): |    (\w+) +(P\(|no guarantee)", line)
        part = re.match(r" +part (.*): (P\(|no )", line)
        if part:
            name = name.split(" / ")[0] + " / " + part[1]
        elif head:
            name = head[1] or head[2]
        if "the other error" in line or line.strip().startswith("in all ") or \
                "broken variant" in line or "satisfied a median" in line or \
                "never satisfied in" in line:
            if name:
                found.setdefault(name, []).append(line.strip())
        if line == "guarantees":
            name = None
    return found


def judged(spec, number, thresholds, folder="demos"):
    """Returns what etlc evaluate says of one demonstration and of its variants."""
    out, _ = run("evaluate", spec, "--data", f"{folder}/{number:03}.csv", "--thresholds",
                 thresholds, "--variants", ",".join(VARIANTS), "--json", "-")
    return json.loads(out)


VARIANTS = ("cut", "phases_reversed", "reversed", "frozen")


def variant_line(evaluated, name, kind):
    """`evaluated`: per demonstration what etlc evaluate says of it."""
    made = {variant: sum(one["variants"][variant]["made"] for one in evaluated)
            for variant in VARIANTS}
    counts = []
    for one in evaluated:
        verdicts = one["monitors"][name]["variants"]["all"]
        if kind == "success":
            errors = verdicts["false_positives"]
            counts.append((errors, errors + verdicts["true_negatives"] +
                           verdicts["unknown_negatives"]))
        else:
            errors = verdicts["false_negatives"]
            counts.append((errors, errors + verdicts["true_positives"] +
                           verdicts["unknown_positives"]))
    errors, cases, share = shown(counts)
    words = ("satisfied", "violated") if kind == "success" else ("violated", "satisfied")
    kinds = ", ".join(f"{variant} {number}" for variant, number in made.items() if number > 0)
    line = (f"on {sum(made.values())} broken variants ({kinds}): {words[0]} on {errors} of {cases} "
            f"truly {words[1]}, {share}")
    if kind == "alarm":
        missed = [one["monitors"][name]["variants"]["all"] for one in evaluated]
        errors = sum(one["false_positives"] for one in missed)
        cases = errors + sum(one["true_negatives"] + one["unknown_negatives"] for one in missed)
        line += f"; satisfied on {errors} of {cases} truly violated" if cases > 0 else ""
    return line


def lateness_line(pairs):
    """`pairs`: per demonstration its steps as pairs of verdict and truth."""
    late, never = [], 0
    for steps in pairs:
        true = [step for step, (_, is_) in enumerate(steps) if is_]
        said = [step for step, (says, _) in enumerate(steps) if says]
        if true and said:
            late.append(max(said[0] - true[0], 0))
        never += bool(true and not said)
    middle = sorted(late)[(len(late) - 1) // 2]
    plural = lambda count, word: f"{count} {word}{'' if count == 1 else 's'}"
    line = f"satisfied a median of {plural(middle, 'step')} after it truly is, in " + \
        plural(len(late), "episode")
    return line + (f"; never satisfied in {plural(never, 'episode')} in which it truly is"
                   if never else "")


def pairs_of(evaluated, name):
    """Returns the steps as counted by etlc evaluate, as pairs of verdict and truth."""
    steps = evaluated["monitors"][name]["steps"]
    return ([(True, True)] * steps["true_positives"] + [(True, False)] * steps["false_positives"] +
            [(False, True)] * steps["false_negatives"] +
            [(False, False)] * steps["true_negatives"] +
            [(None, True)] * steps["unknown_positives"] +
            [(None, False)] * steps["unknown_negatives"])
