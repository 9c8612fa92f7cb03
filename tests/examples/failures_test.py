"""failures_test.py FOLDER: the scripts of examples/failures, on made-up data laid out like the real
data sets: what they leave out, and what is found in episodes that fail on purpose."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

random = np.random.default_rng(1)


def swinging(actions, fails):
    """Successes keep a direction; failures turn at each step."""
    actions[:, 0] = 3 * (-1.0) ** (np.arange(len(actions)) * fails)
    return actions


def pick_place(source):
    """36 successes that close the gripper and go on, 18 failures that swing, a piece of a task."""
    for n in range(55):
        fails = n % 3 == 2
        steps = 40 if fails else random.integers(14, 20)
        state = random.normal(0, 0.02, (steps + 1, 9)).astype("f4")
        state[:, :3] = np.cumsum(random.uniform(0.01, 0.02, (steps + 1, 3)), 0)
        state[:, 3] = np.arange(steps + 1) >= 5 + n % 4
        state[:, 6] = np.arange(steps + 1) >= 9 + n % 4
        if fails:
            state[10:, :3] = state[10:11, :3] + (np.arange(steps - 9) % 2)[:, None] / 10
            state[:, [3, 6]] = 0
        picture = np.zeros((steps + 1, 128, 128, 3), "u1")
        picture[:, 24:80:4, 44:84:4] = random.integers(0, 255, (steps + 1, 14, 10, 3))
        folder = source / f"data/raw/mj_pick_place_v5/episode_{n:03}"
        folder.mkdir(parents=True)
        facts = {"success": not fails, **({"seed": 1, "episode": n} if n < 54 else {})}
        (folder / "meta.json").write_text(json.dumps(facts))
        np.savez(folder / "trajectory.npz", obs_rgb=picture, obs_state=state,
                 actions=swinging(random.normal(0, 1, (steps, 4)).astype("f4"), fails))


def crashes(source):
    """An obstacle comes: it is passed, or it stays ahead until the robot stops."""
    for kind, trials in {"E2": 18, "E3": 18, "N4": 9, "N5": 9}.items():
        for n in range(trials):
            frames = []
            for t in range(16):
                away = 0.05 * t if kind[0] == "E" else 0
                frames.append({
                    "timestamp": 100 * n + t / 10 + {"E2": 0, "E3": 30, "N4": 60, "N5": 90}[kind],
                    "lin_vel": [1 + random.normal() / 20 if t < 12 or kind[0] == "E" else 0, 0],
                    "lin_acc": random.normal(0, 0.1, 2).tolist(), "ang_vel": random.normal(),
                    "obj_pos": [3 - 0.2 * t, away + random.uniform(0, 0.1)],
                    "scan": [[i / 64, random.uniform() / (1 + away)] for i in range(128)]})
            names = [n + 1] + [n + 1 + trials] * (kind == "N5")  # the latter is a mirror image
            for name in names:
                file = source / kind / f"{name:03}" / f"{kind}_{name:03}.json"
                file.parent.mkdir(parents=True)
                file.write_text(json.dumps({"frames": frames}))
                for frame in frames:
                    frame["obj_pos"][1] *= -1


def forces(source):
    """Windows of noise are normal; failures jump. The second file repeats the first."""
    source.mkdir()
    text = ""
    for n in range(54):
        window = random.integers(-99, 100, (15, 6)) + (n % 3 == 2) * np.eye(15, 6, -8) * 2000
        rows = "".join("".join(f"\t{x:.0f}" for x in row) + "\n" for row in window)
        text += ("collision" if n % 3 == 2 else "normal") + "\n" + rows + "\n\n"
    (source / "lp1.data").write_text(text)
    (source / "lp5.data").write_text(text)


FOUND = {pick_place: ["idle", "closes_in_time", "lifts_in_time", "never_stuck", "clock",
                      "to_and_fro", "never_to_and_fro"],
         crashes: ["off_course", "never_on_course_long"], forces: ["plain", "logpzo", "jerk"]}

STEPS = {pick_place: 40, crashes: 12, forces: 15}  # of failures; the robot stops at step 12


def check(scripts, make, folder):
    source = folder / make.__name__
    make(source)
    call = [sys.executable, "-B", scripts / f"{make.__name__}.py", source, folder / "work"]
    out = subprocess.run(call, capture_output=True, text=True, check=False)
    assert out.returncode == 0, out.stdout + out.stderr
    assert out.stdout.startswith("36 successes, 18 failures\n"), out.stdout
    rows = [[cell.strip(" `") for cell in line.split("|")] for line in out.stdout.splitlines()]
    table = {row[1]: row[2:-1] for row in rows if len(row) == 8}
    for monitor in FOUND[make]:
        false, hit = (float(cell.split()[0]) for cell in table[monitor][:2])
        assert false <= 0.3 and hit == 1, out.stdout
    assert len(table) >= 10, out.stdout
    for file in (folder / "work/failure").glob("*.npz"):
        with np.load(file) as episode:
            assert len(episode["failed"]) == STEPS[make], file


def main():
    assert "ETLC" in os.environ
    for make in FOUND:
        with tempfile.TemporaryDirectory() as folder:
            check(pathlib.Path(sys.argv[1]), make, pathlib.Path(folder))


main()
