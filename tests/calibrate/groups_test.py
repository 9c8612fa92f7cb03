#!/usr/bin/env python3
"""groups_test.py ETLC: the episodes of a group count once, with the worst of their scores, in every
guarantee and for every method; the thresholds file, the header and the reports say so; intervals
resample groups; and no group is on both sides of a fit, a calibration and an evaluation."""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ETLC = sys.argv[1]
STEPS = 12
FIRST, END = 2, 9  # the labelled steps
SPEC = """spec s; input z : f32[1]; target t = [[0]];
predicate a = l2(z, t) <= calibrated({method}, alpha = {alpha}{more});
monitor m = F a;
"""
WHOLE = """spec w; input z : f32[1]; target t = [[0]];
predicate a = l2(z, t) <= 0.5;
monitor m = F a calibrated(conformal, alpha = {alpha}, against = missed_success);
"""


def run(*words, fails=False):
    done = subprocess.run([ETLC, *map(str, words)], capture_output=True, text=True)
    assert (done.returncode != 0) == fails, (words, done.returncode, done.stdout, done.stderr)
    return done.stdout, done.stderr


class Sessions:
    """Episodes of sessions, in which all distances are off by the same amount."""

    def __init__(self, seed):
        self.random = np.random.default_rng(seed)

    def offset(self):
        return self.random.normal(0, 0.3)

    def episode(self, offset):
        z = np.abs(0.5 + offset + self.random.normal(0, 0.05, STEPS))
        return z.astype(np.float32)

    def sessions(self, count, episodes):
        return [[self.episode(offset) for _ in range(episodes)]
                for offset in (self.offset() for _ in range(count))]


def write(folder, sessions, alone=(), name="session"):
    """Writes the episodes of sessions in turn, and those without a group."""
    folder = pathlib.Path(folder)
    folder.mkdir()
    rows = ["episode,predicate,start,end,group"]
    all_ = [(e, s, z) for s, session in enumerate(sessions) for e, z in enumerate(session)]
    for e, s, z in sorted(all_, key=lambda one: one[:2]):
        np.savez(folder / f"{e}_{s}.npz", z=z[:, None])
        rows.append(f"{e}_{s},a,{FIRST},{END},{name} {s}")
    for i, z in enumerate(alone):
        np.savez(folder / f"alone{i}.npz", z=z[:, None])
        rows.append(f"alone{i},a,{FIRST},{END},")
    (folder / "labels.csv").write_text("\n".join(rows) + "\n")


def worst(session):
    return max(z[FIRST:END].max() for z in session)


def beyond(scores, alpha):
    """Returns k and the k-th smallest score."""
    k = math.ceil((1 - alpha) * (len(scores) + 1) - 1e-9)
    return k, sorted(scores)[k - 1]


def test_one_score_a_group():
    drawn = Sessions(1)
    sessions = drawn.sessions(5, 4)
    alone = [drawn.episode(drawn.offset()) for _ in range(3)]
    write("d", sessions, alone)
    k, score = beyond([worst(one) for one in sessions] + [z[FIRST:END].max() for z in alone], 0.25)
    more = {"conformal": "", "adaptive": ", gamma = 0.01, lo = 0, hi = 9"}
    for method, arguments in more.items():
        pathlib.Path("s.etl").write_text(SPEC.format(method=method, alpha=0.25, more=arguments))
        report, _ = run("calibrate", "s.etl", "--data", "d")
        file = json.loads(pathlib.Path("s.thresholds.json").read_text())
        entry = file["predicates"]["a"]
        assert (entry["n"], entry["k"], len(file["episodes"])) == (8, k, 23), entry
        assert 0 < entry["epsilon"] - score < 1e-4, (entry, score)
        assert sorted(set(file["groups"].values())) == [f"session {i}" for i in range(5)]
        assert "23 demonstrations in 8 groups, 276 frames" in report, report
        assert f"the {k}th smallest of 8 scores, one per group" in report, report
        header, _ = run("s.etl", "-o", "-")
        assert f"score {k} of 8 groups" in " ".join(header.replace("//", "").split()), header
        whole = pathlib.Path("s.thresholds.json").read_bytes()
        for shard in "12":
            run("calibrate", "s.etl", "--data", "d", "--shard", f"{shard}/2", "--part", shard)
        merged, _ = run("merge", "1", "2")
        assert merged == report and pathlib.Path("s.thresholds.json").read_bytes() == whole
    assert "P(some verdict" not in report, report  # of the adaptive threshold
    plain = SPEC.format(method="conformal", alpha=0.25, more="")
    for part, words in ((plain, "success"), (plain.replace("F a", "G !a"), "alarm")):
        pathlib.Path("s.etl").write_text(part)
        report, _ = run("calibrate", "s.etl", "--data", "d")
        claim = f"P(some verdict of an episode of a new group misses a{'n' * (words[0] == 'a')} " \
                f"{words}) <= 0.25, from 8 groups"
        assert claim in report and "the groups of demonstrations and the new group" in report
        header = " ".join(run("s.etl", "-o", "-")[0].replace("//", "").split())
        assert claim in header and "a group counts once, with the worst" in header, header
    pathlib.Path("w.etl").write_text(WHOLE.format(alpha=0.25))
    report, _ = run("calibrate", "w.etl", "--data", "d")
    entry = json.loads(pathlib.Path("w.thresholds.json").read_text())["monitors"]["m"]
    assert (entry["n"], entry["k"]) == (8, k), entry
    assert "23 episodes in 8 groups" in report and ", from 8 groups" in report, report
    # At the step where `F a` is first truly satisfied, rho is the greatest so far; the score of
    # an episode is its least over those steps, and that of a group the least of its episodes.
    rho = [min(0.5 - z[:FIRST + 1].min() for z in one)
           for one in sessions + [[z] for z in alone]]
    assert np.allclose(sorted(entry["scores"]), sorted(rho), atol=1e-5), (entry["scores"], rho)
    header = " ".join(run("w.etl", "-o", "-")[0].replace("//", "").split())
    assert f"score {k} of 8 groups" in header, header
    # Pooled frames and F1 have no guarantee that groups could void.
    for method in ("calibrated(class_conditional, alpha = 0.25)", "calibrated(f1)"):
        pathlib.Path("s.etl").write_text(
            SPEC.format(method="conformal", alpha=0.25, more="").replace(
                "calibrated(conformal, alpha = 0.25)", method))
        report, _ = run("calibrate", "s.etl", "--data", "d")
        assert "no guarantee" in report and "23 demonstrations in 8 groups" in report, report


def test_too_few_groups():
    write("d", Sessions(2).sessions(4, 10))
    pathlib.Path("s.etl").write_text(SPEC.format(method="conformal", alpha=0.1, more=""))
    _, said = run("calibrate", "s.etl", "--data", "d", fails=True)
    assert "needs at least 9 groups in which 'a' is true at some frame; there are 4" in said, said
    assert "40 demonstrations are in 4 groups" in said, said
    pathlib.Path("w.etl").write_text(WHOLE.format(alpha=0.1))
    _, said = run("calibrate", "w.etl", "--data", "d", fails=True)
    assert "needs at least 9 groups in which" in said, said


def test_coverage():
    """In new sessions no more is missed than alpha allows, on the average over calibrations."""
    drawn = Sessions(3)
    pathlib.Path("s.etl").write_text(SPEC.format(method="conformal", alpha=0.25, more=""))
    missed = []
    for i in range(40):
        write(f"d{i}", drawn.sessions(3, 6))
        run("calibrate", "s.etl", "--data", f"d{i}", "-j", "1")
        epsilon = json.loads(pathlib.Path("s.thresholds.json").read_text())["predicates"]["a"][
            "epsilon"]
        new = drawn.sessions(60, 6)
        missed.append(np.mean([worst(one) > epsilon for one in new]))
    spread = np.std(missed) / math.sqrt(len(missed))
    assert abs(np.mean(missed) - 0.25) < 3 * spread, (np.mean(missed), spread)


def test_intervals():
    drawn = Sessions(4)
    write("d", drawn.sessions(6, 8))
    write("e", drawn.sessions(6, 8), name="other")
    pathlib.Path("s.etl").write_text(SPEC.format(method="conformal", alpha=0.25, more=""))
    run("calibrate", "s.etl", "--data", "d")
    table, _ = run("evaluate", "s.etl", "--data", "e")
    assert "48 episodes in 6 groups, 576 frames; " in table and "resamples of the groups" in table
    figures = json.loads(run("evaluate", "s.etl", "--data", "e", "--json", "-")[0])
    assert figures["groups"] == 6
    labels = pathlib.Path("e/labels.csv")
    text = labels.read_text()
    labels.write_text("\n".join(line.rsplit(",", 1)[0] for line in text.splitlines()) + "\n")
    alone = json.loads(run("evaluate", "s.etl", "--data", "e", "--json", "-")[0])
    labels.write_text(text)
    assert "groups" not in alone

    def width(of):
        low, high = of["predicates"]["a"]["f1_interval"]
        return high - low

    assert width(figures) > 1.5 * width(alone), (width(figures), width(alone))
    assert figures["predicates"]["a"]["f1"] == alone["predicates"]["a"]["f1"]


def test_one_side():
    """A group is on one side only, unless a reason is given."""
    drawn = Sessions(5)
    sessions = drawn.sessions(6, 8)
    write("d", [one[:4] for one in sessions])
    write("e", [one[4:] for one in sessions])
    write("f", drawn.sessions(6, 4), name="other")
    pathlib.Path("s.etl").write_text(SPEC.format(method="conformal", alpha=0.25, more=""))
    run("calibrate", "s.etl", "--data", "d")
    run("evaluate", "s.etl", "--data", "f")
    _, said = run("evaluate", "s.etl", "--data", "e", fails=True)
    assert "is of the group 'session 0', as is an episode that the thresholds" in said, said
    assert "[E0670]" in said and "--allow-overlap" in said, said
    run("evaluate", "s.etl", "--data", "e", "--allow-overlap", "the same operators")
    whole = SPEC.format(method="conformal", alpha=0.25, more="").replace(
        "monitor m = F a", "monitor m = F a calibrated(conformal, alpha = 0.25, "
        "against = missed_success)")
    pathlib.Path("s.etl").write_text(whole)
    run("calibrate", "s.etl", "--data", "d", "-o", "p.json")
    _, said = run("calibrate", "s.etl", "--data", "e", "--thresholds", "p.json", fails=True)
    assert "[E0666]" in said and "is of the group" in said, said
    run("calibrate", "s.etl", "--data", "f", "--thresholds", "p.json")
    pathlib.Path("s.etl").write_text(
        SPEC.format(method="conformal", alpha=0.25, more="").replace(
            "target t = [[0]]", "target t = fitted(mean, of = z, where = a)"))
    run("fit", "s.etl", "--data", "d")
    _, said = run("calibrate", "s.etl", "--data", "e", fails=True)
    assert "[E0675]" in said and "is of the group" in said, said
    run("calibrate", "s.etl", "--data", "f")
    run("crossvalidate", "s.etl", "--data", "d", "f", "--folds", "3")


def test_files():
    """A file whose scores are more than its groups contradicts itself; one of earlier versions, or
    of episodes without groups, names none."""
    drawn = Sessions(6)
    write("d", drawn.sessions(5, 3))
    pathlib.Path("s.etl").write_text(SPEC.format(method="conformal", alpha=0.25, more=""))
    run("calibrate", "s.etl", "--data", "d")
    path = pathlib.Path("s.thresholds.json")
    file = json.loads(path.read_text())
    file["groups"] = {one: group.replace("session 4", "session 0")
                      for one, group in file["groups"].items()}
    path.write_text(json.dumps(file))
    _, said = run("s.etl", "--check", fails=True)
    assert "'predicates.a.n' is 5, expected at most 4, the number of groups that" in said, said
    for wrong, words in (({"x": "y"}, "is no content hash"), ({"0" * 16: ""}, "is empty"),
                         ([], "an object of texts")):
        path.write_text(json.dumps({**file, "groups": wrong}))
        assert words in run("s.etl", "--check", fails=True)[1]
    del file["groups"]
    path.write_text(json.dumps(file))
    run("s.etl", "--check")
    assert "group" not in run("s.etl", "-o", "-")[0]


for test in (test_one_score_a_group, test_too_few_groups, test_coverage, test_intervals,
             test_one_side, test_files):
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        test()
        os.chdir("/")
print("a group counts once")
