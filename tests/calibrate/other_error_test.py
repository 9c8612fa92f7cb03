#!/usr/bin/env python3
"""other_error_test.py ETLC: the report of `etlc calibrate` counts the other error of every
demonstration with the thresholds that a call on the other demonstrations gives. The counts here are
plain loops from the definitions, and the intervals are drawn as docs/evaluation.md says."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ETLC = os.path.abspath(sys.argv[1])
EPISODES = 14
ALPHA = "calibrated(conformal, alpha = 0.2)"
PREDICATES = f"""
input x, y, s, speed : f32;
input armed : bool;
predicate a = x <= {ALPHA};
predicate b = y > {ALPHA};
predicate c = x < calibrated(class_conditional, alpha = 0.2);
predicate d = y >= calibrated(f1);
predicate e = x <= calibrated(adaptive, alpha = 0.2, gamma = 0.01, lo = -50, hi = 50);
predicate h = y >= calibrated(class_conditional, alpha = 0.3);
predicate f = x < calibrated(f1);
truth a = s < 1;
truth b = s > 3;
truth c = s < 1;
truth d = s > 3;
truth e = s < 1;
truth h = s > 3;
truth f = s < 1;
"""
MONITORS = """
monitor arrives = F a;
monitor keeps   = G !b;
monitor slow    = F (a && speed <= 2);
monitor ready   = F (b && armed);
monitor mixed   = (F a) && (G !b);
sliding monitor soon = F[0, 3] a;
repeating monitor again = F[0, 4] a;
monitor none    = F d;
"""
COMPARISON = {"a": "<=", "b": ">", "c": "<", "d": ">=", "e": "<=", "h": ">=", "f": "<"}


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
        part = re.match(r" +of its part (.*): (P\(|no )", line)
        if part:
            name = name.split(" / ")[0] + " / " + part[1]
        elif head:
            name = head[1] or head[2]
        if "the other error" in line or line.strip().startswith("in all ") or \
                "broken variant" in line:
            if name:
                found.setdefault(name, []).append(line.strip())
        if line == "guarantees":
            name = None
    return found


def judged(spec, number, thresholds, folder="demos"):
    """Returns what etlc evaluate says of one demonstration and of its variants."""
    out, _ = run("evaluate", spec, "--data", f"{folder}/{number:03}.csv", "--thresholds", thresholds,
                 "--variants", ",".join(VARIANTS), "--json", "-")
    return json.loads(out)


VARIANTS = ("cut", "swapped", "reversed", "frozen")


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
                           verdicts["unsaid_negatives"]))
        else:
            errors = verdicts["false_negatives"]
            counts.append((errors, errors + verdicts["true_positives"] +
                           verdicts["unsaid_positives"]))
    errors, cases, share = shown(counts)
    words = ("satisfied", "violated") if kind == "success" else ("violated", "satisfied")
    kinds = ", ".join(f"{variant} {number}" for variant, number in made.items() if number > 0)
    return (f"on {sum(made.values())} broken variants ({kinds}): {words[0]} on {errors} of {cases} "
            f"truly {words[1]}, {share}")


def pairs_of(evaluated, name):
    """Returns the steps as counted by etlc evaluate, as pairs of verdict and truth."""
    steps = evaluated["monitors"][name]["steps"]
    return ([(True, True)] * steps["true_positives"] + [(True, False)] * steps["false_positives"] +
            [(False, True)] * steps["false_negatives"] +
            [(False, False)] * steps["true_negatives"] +
            [(None, True)] * steps["unsaid_positives"] +
            [(None, False)] * steps["unsaid_negatives"])


def test_thresholds():
    pathlib.Path("t.etl").write_text("spec t;" + PREDICATES + MONITORS)
    demos = episodes(EPISODES, 1)
    write("demos", demos)
    report, _ = run("calibrate", "t.etl", "--data", "demos", "-o", "all.json")
    found = lines_of(report)
    files = left_out("t.etl", demos)
    thresholds = [{name: np.float32(one["epsilon"]) for name, one in
                   json.loads(pathlib.Path(file).read_text())["predicates"].items()}
                  for file in files]
    # `etlc` starts an adaptive threshold on its grid.
    grid = 2.0 ** -20
    for one in thresholds:
        one["e"] = np.float32(np.ceil(one["e"] / grid) * grid)
    truth = {name: (lambda s: holds(">", s, 3)) if name in "bdh" else
             (lambda s: holds("<", s, 1)) for name in COMPARISON}
    for name, comparison in COMPARISON.items():
        counts = []
        for demo, of in zip(demos, thresholds):
            errors = cases = 0
            for value, s in zip(demo["y" if name in "bdh" else "x"], demo["s"]):
                if truth[name](s) is not False or value != value:
                    continue
                cases += 1
                errors += holds(comparison, value, of[name])
            counts.append((errors, cases))
        assert found[name] == [predicate_line(counts)], (name, found[name], predicate_line(counts))
    evaluated = [judged("t.etl", n, file) for n, file in enumerate(files)]
    said = {name: [] for name in ("arrives", "keeps", "slow", "ready", "mixed / F a",
                                  "mixed / G !b", "soon")}
    for demo, of in zip(demos, thresholds):
        for is_truth in (False, True):
            a = [truth["a"](s) if is_truth else holds("<=", x, of["a"])
                 for x, s in zip(demo["x"], demo["s"])]
            b = [truth["b"](s) if is_truth else holds(">", y, of["b"])
                 for y, s in zip(demo["y"], demo["s"])]
            slow = [holds("<=", speed, 2) for speed in demo["speed"]]
            armed = [holds(">", flag, 0) for flag in demo["armed"]]
            verdicts = {"arrives": eventually(a), "keeps": negated(eventually(b)),
                        "slow": eventually(both(a, slow)), "ready": eventually(both(b, armed)),
                        "mixed / F a": eventually(a), "mixed / G !b": negated(eventually(b)),
                        "soon": within(a, 3)}
            for name, values in verdicts.items():
                if is_truth:
                    said[name][-1] = list(zip(said[name][-1], values))
                else:
                    said[name].append(values)
    kinds = {"keeps": "alarm", "mixed / G !b": "alarm"}
    for name, pairs in said.items():
        expected = monitor_lines(pairs, kinds.get(name, "success"))
        assert found[name][:2] == expected, (name, found[name], expected)
    for name in ("arrives", "keeps", "slow", "ready", "soon", "again"):
        kind = kinds.get(name, "success")
        expected = monitor_lines([pairs_of(of, name) for of in evaluated], kind)
        expected.append(variant_line(evaluated, name, kind))
        assert found[name] == expected, (name, found[name], expected)
    assert found["mixed / F a"] == found["arrives"]
    assert found["mixed / G !b"] == found["keeps"]
    assert "none" not in found and "mixed" not in found
    for jobs in (1, 3):
        assert run("calibrate", "t.etl", "--data", "demos", "-j", jobs, "-o", "all.json")[0] == \
            report
    # A call without `speed` and `armed` in one demonstration works as if nothing read them.
    del demos[3]["speed"], demos[5]["armed"]
    write("lacking", demos)
    before = pathlib.Path("all.json").read_text()
    lacking = lines_of(run("calibrate", "t.etl", "--data", "lacking", "-o", "all.json")[0])
    assert pathlib.Path("all.json").read_text() == before
    for name, lines in found.items():
        if name in ("slow", "ready"):
            lines = ["the other error: not counted: some demonstrations lack an input that the "
                     "monitor reads"]
        assert lacking[name] == lines, name


def test_shifts():
    pathlib.Path("t.etl").write_text("""spec t;
input x, y, s : f32;
predicate near = x <= 1.25;
predicate far  = y > 3.25;
truth near = s < 1;
truth far  = s > 3;
monitor arrives = F near calibrated(conformal, alpha = 0.2, against = missed_alarm);
monitor keeps   = G !far calibrated(conformal, alpha = 0.2, against = missed_success);
sliding monitor soon = F[0, 3] near calibrated(conformal, alpha = 0.2, against = missed_success);
""")
    demos = episodes(EPISODES, 2, missing=["s"])  # others make the score infinite
    write("demos", demos)
    report, _ = run("calibrate", "t.etl", "--data", "demos", "-o", "all.json")
    found = lines_of(report)
    files = left_out("t.etl", demos)
    evaluated = [judged("t.etl", n, file) for n, file in enumerate(files)]
    kinds = {"arrives": "alarm", "keeps": "success", "soon": "success"}
    for name, kind in kinds.items():
        expected = monitor_lines([pairs_of(of, name) for of in evaluated], kind)
        expected.append(variant_line(evaluated, name, kind))
        assert found[name] == expected, (name, found[name], expected)
    pairs = []
    for demo, file in zip(demos, files):
        shift = np.float32(json.loads(pathlib.Path(file).read_text())["monitors"]["arrives"][
            "epsilon"])
        values = [None if x != x else np.float32(1.25) - x - shift for x in demo["x"]]
        says = eventually([None if value is None else bool(value >= 0) for value in values])
        is_ = eventually([holds("<", s, 1) for s in demo["s"]])
        pairs.append(list(zip(says, is_)))
    expected = monitor_lines(pairs, "alarm")
    assert found["arrives"][:2] == expected, (found["arrives"], expected)


DIVIDED = f"""spec t;
input x, y, s, u : f32;
predicate a = x <= {ALPHA};
predicate unused = y > {ALPHA};
predicate q = x <= 1;
truth a = s < 1;
truth unused = s > 3;
truth q = u < 1;
monitor arrives = F a;
"""


def test_dividing():
    """Labels of predicates that no guarantee reads divide episodes into phases too, and whatever
    would give other variants than etlc evaluate has is not judged."""
    pathlib.Path("t.etl").write_text(DIVIDED)
    demos = episodes(EPISODES, 7, missing=["x", "s"])
    for number, demo in enumerate(demos):
        steps = np.arange(len(demo["x"]))
        demo["u"] = (steps + number) % 7 / 4
        demo["truth.other"] = (steps + number) % 5 > 2
    write("demos", demos)
    files = left_out("t.etl", demos)
    lines = {}
    for name, spec in (("truth", DIVIDED), ("array", DIVIDED + "predicate other = y <= 2;"),
                       ("fewer", DIVIDED.replace("truth q = u < 1;", ""))):
        pathlib.Path("t.etl").write_text(spec)
        lines[name] = lines_of(run("calibrate", "t.etl", "--data", "demos", "-o", "all.json")[0])
        evaluated = [judged("t.etl", n, file) for n, file in enumerate(files)]
        expected = variant_line(evaluated, "arrives", "success")
        assert lines[name]["arrives"][2] == expected, (lines[name]["arrives"], expected)
    assert len({one["arrives"][2] for one in lines.values()}) == 3
    for one in lines.values():  # nothing else depends on them
        assert one["arrives"][:2] == lines["truth"]["arrives"][:2]

    def check_refusal(spec, why, folder="demos"):
        pathlib.Path("t.etl").write_text(spec)
        found = lines_of(run("calibrate", "t.etl", "--data", folder, "-o", "all.json")[0])
        assert found["arrives"][2:] == ["broken variants not judged: " + why], found["arrives"]

    whole = "input x, y, s, u : f32;"
    for declared, why in ((" hold 2", "hold"), (", stale after 3", "stale after")):
        check_refusal(DIVIDED.replace(whole, f"input x, y, s : f32; input u : f32{declared};"),
                      f"'u' has {why}, so its samples depend on the order")
    check_refusal(DIVIDED.replace("truth unused = s > 3;", "truth unused = O (s > 3);"),
                  "the truth of 'unused' looks back, so its labels depend on the order")
    del demos[3]["u"]
    write("lacking", demos)
    check_refusal(DIVIDED, "some demonstrations lack labels that tell where to cut them", "lacking")
    write("whole", [{"x": x, "s": s} for x, s in [(demo["x"], demo["s"]) for demo in demos]])
    pathlib.Path("t.etl").write_text(f"""spec t;
input x, s : f32;
input unread : f32 hold 3;
predicate a = x <= {ALPHA};
truth a = s < 1;
monitor arrives = F a;
""")  # what nothing reads may hold
    found = lines_of(run("calibrate", "t.etl", "--data", "whole", "-o", "all.json")[0])
    assert found["arrives"][2].startswith("on "), found["arrives"]


def test_warnings():
    """The warning is there for a monitor that always says the same, and for no other."""
    spec = f"""spec t;
input x, y, s : f32;
predicate p = x <= {ALPHA};
truth p = s < 1;
monitor arrives = F p;
monitor leaves  = G !p;
"""
    pathlib.Path("t.etl").write_text(spec)
    for name, noise, count, failing, empty in (
            ("good", 0.05, EPISODES, EPISODES, None), ("bad", 50, EPISODES, EPISODES, "is empty"),
            ("few", 50, 6, 4, "says little"), ("fewer", 50, 6, 2, None)):
        demos = episodes(count, 3, noise=noise, missing=())
        for demo in demos:  # every drive begins away from the goal, and reaches it
            demo["s"][:-4] += 2
            demo["s"][-4:] = 0.5
            if noise < 1:
                demo["x"] = (demo["s"] + 0.01).astype(np.float32)
        for demo in demos[failing:]:  # too few in which the truth is violated at some step
            demo["s"][:] = 0.25
        write(name, demos)
        report, said = run("calibrate", "t.etl", "--data", name)
        assert said.count("[W0678]") == (2 if empty else 0), (name, report, said)
        for monitor in ("'arrives' is satisfied", "'leaves' is violated"):
            head = {None: "", "is empty": f"{monitor} at 100 % of the steps",
                    "says little": f"{monitor} on 100 % of the broken variants"}[empty]
            assert f"the guarantee holds, and {empty}: {head}" in said or not empty, said
        assert said.count("note: of ") == (2 if empty else 0), said
    demos = episodes(EPISODES, 4, missing=())
    for demo in demos:
        demo["s"][:] = 0.5
    write("true", demos)
    report, said = run("calibrate", "t.etl", "--data", "true")
    assert "W0678" not in said
    assert lines_of(report) == {
        "p": ["the other error: nothing to judge it on: no measured frame is negative"],
        "arrives": ["the other error: nothing to judge it on: no step is truly violated",
                    "on 14 broken variants (reversed 14): none is truly violated"],
        "leaves": ["the other error: nothing to judge it on: no step is truly satisfied",
                   "on 14 broken variants (reversed 14): none is truly satisfied"]}
    # Four demonstrations are enough for alpha = 0.2; three are not.
    demos = episodes(4, 5, missing=())
    for demo in demos:
        demo["s"][-4:] = 0.5
    write("least", demos)
    why = "the other error: not counted: without one demonstration too few are left for alpha = 0.2"
    assert lines_of(run("calibrate", "t.etl", "--data", "least")[0]) == {
        "p": [why], "arrives": [why + ", for 'p'"], "leaves": [why + ", for 'p'"]}


def test_groups():
    pathlib.Path("t.etl").write_text("""spec t;
input x, s : f32;
predicate p = x <= calibrated(f1);
truth p = s < 1;
monitor arrives = F p;
""")
    for count, words in ((64, ""), (65, "; demonstrations left out in 64 groups")):
        write(str(count), episodes(count, 6, steps=12))
        report = run("calibrate", "t.etl", "--data", count)[0]
        assert lines_of(report)["p"][0].endswith("]" + words), report


for test in (test_thresholds, test_shifts, test_dividing, test_warnings, test_groups):
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        test()
        os.chdir("/")
print("the other error is that of plain loops")
