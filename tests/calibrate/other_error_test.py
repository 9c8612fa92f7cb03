#!/usr/bin/env python3
"""other_error_test.py ETLC: the report of `etlc calibrate` counts the other error of every
demonstration with the thresholds that a call on the other demonstrations gives. The counts here are
plain loops from the definitions, and the intervals are drawn as docs/calibration.md says. On broken
variants it counts what `etlc evaluate --variants` does."""
import json
import os
import pathlib
import tempfile

import numpy as np

from other_errors import (both, episodes, eventually, holds, judged, lateness_line, left_out,
                          lines_of, monitor_lines, negated, pairs_of, predicate_line, run,
                          variant_line, within, write)

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
sliding monitor free = G[0, 2] !b;
repeating monitor calm = G[0, 4] !b;
monitor none    = F d;
"""
COMPARISON = {"a": "<=", "b": ">", "c": "<", "d": ">=", "e": "<=", "h": ">=", "f": "<"}


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
    kinds = dict.fromkeys(("keeps", "mixed / G !b", "free", "calm"), "alarm")
    for name, pairs in said.items():
        expected = monitor_lines(pairs, kinds.get(name, "success"))
        if name in kinds:
            expected.append(lateness_line(pairs))
        assert found[name][:len(expected)] == expected, (name, found[name], expected)
    for name in ("arrives", "keeps", "slow", "ready", "soon", "again", "free", "calm"):
        kind = kinds.get(name, "success")
        expected = monitor_lines([pairs_of(of, name) for of in evaluated], kind)
        expected.append(variant_line(evaluated, name, kind))
        assert judged_alike(found[name]) == expected, (name, found[name], expected)
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


def judged_alike(lines):
    """Returns the lines whose figures etlc evaluate has too."""
    return [line for line in lines if not line.startswith(("satisfied a median", "never"))]


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
    demos = episodes(EPISODES, 2, missing=["x", "y", "s"])
    write("demos", demos)
    report, _ = run("calibrate", "t.etl", "--data", "demos", "-o", "all.json")
    found = lines_of(report)
    files = left_out("t.etl", demos)
    evaluated = [judged("t.etl", n, file) for n, file in enumerate(files)]
    kinds = {"arrives": "alarm", "keeps": "success", "soon": "success"}
    for name, kind in kinds.items():
        expected = monitor_lines([pairs_of(of, name) for of in evaluated], kind)
        expected.append(variant_line(evaluated, name, kind))
        assert judged_alike(found[name]) == expected, (name, found[name], expected)
    pairs = []
    for demo, file in zip(demos, files):
        shift = np.float32(json.loads(pathlib.Path(file).read_text())["monitors"]["arrives"][
            "epsilon"])
        values = [None if x != x else np.float32(1.25) - x - shift for x in demo["x"]]
        says = eventually([None if value is None else bool(value >= 0) for value in values])
        is_ = eventually([holds("<", s, 1) for s in demo["s"]])
        pairs.append(list(zip(says, is_)))
    expected = monitor_lines(pairs, "alarm")
    expected.append(lateness_line(pairs))
    assert found["arrives"][:3] == expected, (found["arrives"], expected)


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
                   "on 14 broken variants (reversed 14): none is truly satisfied; satisfied on 0 "
                   "of 14 truly violated"]}
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
    for count, words in ((64, ""), (65, "; demonstrations left out in 64 parts")):
        write(str(count), episodes(count, 6, steps=12))
        report = run("calibrate", "t.etl", "--data", count)[0]
        assert lines_of(report)["p"][0].endswith("]" + words), report


for test in (test_thresholds, test_shifts, test_dividing, test_warnings, test_groups):
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        test()
        os.chdir("/")
print("the other error is that of plain loops")
