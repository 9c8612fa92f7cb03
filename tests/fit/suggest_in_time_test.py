#!/usr/bin/env python3
"""suggest_in_time_test.py ETLC: `etlc fit --suggest` proposes the formula over time that helps. F1
by frames is that of plain loops; pasted, every suggestion gives the figures beside it in `etlc
crossvalidate`, or in `etlc evaluate` where nothing is trained."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

VARIANTS = "cut,phases_reversed,reversed,frozen"

# Frames flicker: without debouncing everybody holds the thing twice.
TWICE = """spec twice;
rate 30 Hz;
input z : f32[2];
target held = [[1, 0]];
predicate hold = l2(z, held) <= calibrated(f1);
monitor again = F (hold && F (!hold && F hold));
"""
# After placing, the hand looks as it did before picking.
PLACE = """spec place;
input z : f32[2];
target held = [[1, 0]];
target empty = [[0, 0]];
predicate hold = l2(z, held) <= THRESHOLD;
predicate placed = l2(z, empty) <= THRESHOLD;
monitor done = F (hold && F placed);
sliding monitor now = placed;
"""


def flickering(folder, random):
    for number in range(24):
        frames = 90 + int(random.integers(30))
        hold = np.zeros(frames, bool)
        begin = int(random.integers(5, 15))
        hold[begin : begin + 25] = True
        if number % 2:
            hold[begin + 40 : begin + 60] = True
        x = hold + random.normal(size=frames) * 0.1
        for at in random.choice(frames - 1, 5, replace=False):
            x[at] = 1 - x[at]
        write(folder, number, x, random, hold=hold)


def placing(folder, random):
    for number in range(20):
        frames = 80 + int(random.integers(30))
        begin = int(random.integers(15, 25))
        end = begin + int(random.integers(22, 30))
        hold = np.zeros(frames, bool)
        hold[begin:end] = True
        placed = np.arange(frames) >= end
        x = hold + random.normal(size=frames) * 0.2
        write(folder, number, x, random, hold=hold, placed=placed)


def write(folder, number, x, random, **truths):
    z = np.stack([x, random.normal(size=len(x)) * 0.1], 1).astype(np.float32)
    arrays = {f"truth.{name}": truth for name, truth in truths.items()}
    np.savez(folder / f"{number:02}.npz", z=z, **arrays)


def held(p, steps):
    return np.array([t >= steps and p[t - steps : t + 1].all() for t in range(len(p))])


def once(p, steps=None):
    low = [0 if steps is None else max(0, t - steps) for t in range(len(p))]
    return np.array([p[a : t + 1].any() for t, a in enumerate(low)])


def since(p, q):
    def at(t):
        return any(q[j] and p[j + 1 : t + 1].all() for j in range(t + 1))

    return np.array([at(t) for t in range(len(p))])


def by_definition(formula, said):
    """The formula's truth at every frame, by docs/language.md."""
    if formula in said:
        return said[formula]
    if m := re.fullmatch(r"held\[(\d+) steps\] (\w+)", formula):
        return held(said[m[2]], int(m[1]))
    if m := re.fullmatch(r"O\[0, (\d+) steps\] (\w+)", formula):
        return once(said[m[2]], int(m[1]))
    if m := re.fullmatch(r"(!?)(\w+) && O held\[(\d+) steps\] (\w+)", formula):
        return (said[m[2]] != bool(m[1])) & once(held(said[m[4]], int(m[3])))
    m = re.fullmatch(r"(\w+) S (\w+)", formula)
    return since(said[m[1]], said[m[2]])


def f1_by_loops(folder, formula, name, threshold):
    hits = errors = 0
    for path in sorted(folder.iterdir()):
        episode = np.load(path)
        z = episode["z"].astype(float)
        said = {
            predicate: np.hypot(z[:, 0] - at, z[:, 1]) <= threshold
            for predicate, at in [("hold", 1), ("placed", 0)]
        }
        says = by_definition(formula, said)
        hits += 2 * (says & episode[f"truth.{name}"]).sum()
        errors += (says != episode[f"truth.{name}"]).sum()
    return hits / (hits + errors)


def decided(counts):
    """Of what is true and of what is false, the share that is called so; the mean of both."""
    shares = [("true_positives", "positives"), ("true_negatives", "negatives")]
    found = [counts[right] / counts[of] for right, of in shares if counts[of] > 0]
    return sum(found) / len(found)


# Chains of phases, whose failures are late or never done; one predicate is noisy.
PHASES = """spec phases;
rate 10 Hz;
input grip, height, bin : f32;
predicate grasped = grip < 0.5;
predicate lifted = height > 0.2;
predicate placed = bin < 0.1;
monitor done = F (grasped && F (lifted && F placed));
monitor calm = G (lifted -> F[0, 18] placed);
"""


def phases(folder, random):
    """Returns per file the steps of the phases."""
    times = {}
    for outcome, count in (("success", 40), ("failure", 15)):
        (folder / outcome).mkdir(parents=True)
        for number in range(count):
            steps = np.cumsum([10, 4, 10] + random.integers(0, [10, 8, 15]))
            if outcome == "failure":
                steps[number % 3 :] += 25
            t = np.arange(90)
            path = folder / outcome / f"{number}.npz"
            times[str(path.relative_to(folder.parent))] = steps
            noise = random.random((3, 90)) / 100
            np.savez(path, grip=(t < steps[0]) + noise[0], height=0.3 * (t >= steps[1]) + noise[1],
                     bin=((t < steps[2]) | (random.random(90) < 0.03)) + noise[2])
    return times


def check_outcomes(run, folder):
    """Deadlines are those of the conformal rule, figures those of crossvalidate on the lines, and
    nested ones those of choosing in plain loops."""
    times = phases(folder / "phases", np.random.default_rng(2))
    labels = ["--label-by", "folder", "--data", "phases/*/*.npz"]
    (folder / "p.etl").write_text(PHASES)
    found = json.loads(run("fit", "p.etl", "--suggest", "--json", *labels))["in_time"]
    assert {one["by"] for one in found["of"]} == {"outcome"}, found
    deadlines = next(one for one in found["of"] if one.get("deadlines") == "done")
    lines = [line for one in deadlines["ranked"] for line in one["lines"]]
    (folder / "q.etl").write_text(PHASES + "\n".join(lines))
    judged = json.loads(run("crossvalidate", "q.etl", "--folds", "5", "--by-episode", "--json", "-",
                            *labels))
    for phase, one in enumerate(deadlines["ranked"]):
        name = one["lines"][-1].split()[1]
        outcomes = judged["monitors"][name]["outcomes"]
        assert close(one["score"], outcomes["balanced_accuracy"]), (one, outcomes)
        assert close(one["false_alarms"], outcomes["false_alarm_rate"]), one
        assert close(one["detected"], outcomes["detection_rate"]) and one["detected"] > 0.2, one
        taken = []
        for fold in {row["fold"] for row in judged["by_episode"]}:
            others = sorted(np.diff(times[row["episode"]], prepend=0)[phase]
                            for row in judged["by_episode"]
                            if row["fold"] != fold and row["outcome"] == "success")
            taken.append(others[int(np.ceil(0.9 * (len(others) + 1))) - 1])
        said = [int(word) for word in re.findall(r"\d+", one["formula"].split("[0, ")[1].split(
            " steps")[0])]
        assert [min(said), max(said)] == [min(taken), max(taken)], (one, taken)
    ranking = next(one for one in found["of"] if one.get("monitor") == "calm")
    verdicts = []
    for one in ranking["ranked"]:
        spec = PHASES if not one["lines"] else re.sub("monitor calm.*\n", "", PHASES)
        (folder / "q.etl").write_text(spec + "\n".join(one["lines"]))
        judged = json.loads(run("evaluate", "q.etl", "--by-episode", "--json", "-", *labels))
        outcomes = judged["monitors"]["calm"]["outcomes"]
        assert close(one["score"], outcomes["balanced_accuracy"]), (one, outcomes)
        verdicts.append({row["episode"]: "calm" in row["alarms"] for row in judged["by_episode"]})
    paths = sorted(times)
    nested = []
    for worst in (False, True):  # a tie may go to either
        counts = np.zeros((2, 2))
        for fold in range(5):
            own = {path for place, path in enumerate(paths) if place % 5 == fold}
            scores = [balanced(said, set(paths) - own) for said in verdicts]
            best = [said for said, score in zip(verdicts, scores) if close(score, max(scores))]
            right = [sum(said[path] == path.startswith("phases/failure") for path in own)
                     for said in best]
            said = best[int(np.argmin(right) if worst else np.argmax(right))]
            for path in own:
                counts[int(path.startswith("phases/failure")), int(said[path])] += 1
        nested.append((counts[0, 0] / counts[0].sum() + counts[1, 1] / counts[1].sum()) / 2)
    assert nested[1] - 1e-12 <= ranking["nested"] <= nested[0] + 1e-12, (ranking["nested"], nested)
    assert ranking["nested"] < ranking["ranked"][0]["score"], ranking["nested"]
    # Without outcomes only deadlines are tried, and no failure is known.
    found = json.loads(run("fit", "p.etl", "--suggest", "--json", "--data", "phases/success"))
    found = found["in_time"]["of"]
    assert [one["deadlines"] for one in found] == ["done"], found
    assert all(one["detected"] is None for one in found[0]["ranked"])


def balanced(said, paths):
    rates = [np.mean([said[path] == fails for path in paths
                      if path.startswith("phases/failure") == fails]) for fails in (False, True)]
    return sum(rates) / 2


def close(a, b):
    return abs(a - b) < 1e-12


def main(etlc):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def run(*call):
            found = subprocess.run([etlc, *call], cwd=folder, capture_output=True, text=True)
            assert found.returncode == 0, found.stderr
            return found.stdout

        def suggested(spec, data):
            (folder / "a.etl").write_text(spec)
            printed = run("fit", "a.etl", "--suggest", "--json", "--data", data)
            found = json.loads(printed)["in_time"]
            assert found["why_not"] is None, found
            text = run("fit", "a.etl", "--suggest", "--data", data, "-j", "1")
            found["of"] = [one for one in found["of"] if "deadlines" not in one]
            for ranking in found["of"]:
                best = ranking["ranked"][0]
                own = next(one for one in ranking["ranked"] if not one["lines"])
                lines = "\nBest:\n" + "".join(f"  {line}\n" for line in best["lines"])
                assert own["ties"] or lines in text, lines
            return {one.get("predicate", one.get("monitor")): one for one in found["of"]}

        def pasted(spec, one, data, trained):
            """The JSON of the spec with these lines in place of the declaration of that name."""
            for line in one["lines"]:
                monitor = re.fullmatch(r"(?:sliding )?monitor (\w+) = .*", line)
                if monitor:
                    spec = re.sub(rf"(sliding )?monitor {monitor[1]} = .*\n", "", spec)
            (folder / "b.etl").write_text(spec + "\n".join(one["lines"]) + "\n")
            command = ["crossvalidate", "--folds", "5"] if trained else ["evaluate"]
            options = ["b.etl", "--data", data, "--variants", VARIANTS, "--json", "-"]
            return json.loads(run(*command, *options))

        def check_pasted(spec, rankings, data, trained):
            for name, ranking in rankings.items():
                for one in ranking["ranked"][:3] + ranking["ranked"][-1:]:
                    found = pasted(spec, one, data, trained)
                    if "monitor" in ranking:
                        monitor = found["monitors"][name]
                        if ranking["by"] == "decided":
                            assert close(one["steps"], decided(monitor["steps"])), one
                            assert close(one["variants"], decided(monitor["variants"]["all"])), one
                            continue
                        assert one["episodes"] == monitor["episode_agreement"], one
                        assert one["variants"] == monitor["variants"]["all"]["agreement"], one
                        assert abs(2 * one["score"] - one["episodes"] - one["variants"]) < 1e-12
                        continue
                    let = one["lines"][0].split()[1] if one["lines"] else name
                    frames = found["predicates"][let]
                    if ranking["by"] == "decided":
                        assert close(one["score"], decided(frames)), (one, frames)
                        assert ranking["clock"] is None, ranking
                        continue
                    assert one["score"] == frames["f1"], (one, frames)
                    assert [one["low"], one["high"]] == frames["f1_interval"], (one, frames)
                    assert ranking["clock"] == found["predicates"][name]["duration"]["f1"]

        check_outcomes(run, folder)
        (folder / "twice").mkdir()
        flickering(folder / "twice", np.random.default_rng(3))
        found = suggested(TWICE, "twice")
        own = next(one for one in found["again"]["ranked"] if not one["lines"])
        best = found["again"]["ranked"][0]
        assert re.fullmatch(r"hold: held\[\d+ steps\] hold", best["formula"])
        assert not own["ties"] and best["score"] > own["score"] + 0.2, (best, own)
        check_pasted(TWICE, found, "twice", True)

        # Against both errors a formula is better where more is decided and right.
        both = TWICE.replace("calibrated(f1)", "calibrated(conformal, alpha = 0.1, against = both)")
        found = suggested(both, "twice")
        assert all(one["by"] == "decided" for one in found.values()), found
        check_pasted(both, found, "twice", True)

        (folder / "place").mkdir()
        placing(folder / "place", np.random.default_rng(4))
        spec = PLACE.replace("THRESHOLD", "calibrated(f1)")
        found = suggested(spec, "place")
        best = found["placed"]["ranked"][0]
        assert best["formula"].endswith("O held[10 steps] hold"), best
        assert best["score"] > 0.9 and not found["placed"]["ranked"][-1]["ties"]
        assert set(found) == {"hold", "placed", "done", "now"}
        check_pasted(spec, found, "place", True)

        spec = PLACE.replace("THRESHOLD", "0.5")
        found = suggested(spec, "place")
        for name in ("hold", "placed"):
            assert len(found[name]["ranked"]) == 1 + 10 + 5
            for one in found[name]["ranked"]:
                expected = f1_by_loops(folder / "place", one["formula"], name, 0.5)
                assert abs(one["score"] - expected) < 1e-12, (one, expected)
        check_pasted(spec, found, "place", False)

        # Two episodes are too few to train on others.
        for path in sorted((folder / "place").iterdir())[2:]:
            path.unlink()
        spec = PLACE.replace("THRESHOLD", "calibrated(conformal, alpha = 0.1)")
        (folder / "a.etl").write_text(spec)
        text = run("fit", "a.etl", "--suggest", "--data", "place")
        assert "Nothing was tried in time: alpha = 0.1 needs at least 9" in text, text


main(sys.argv[1])
