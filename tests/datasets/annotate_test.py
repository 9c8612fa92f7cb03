#!/usr/bin/env python3
"""annotate_test.py ETLC: what `etlc annotate` writes into data sets equals what the definitions of
the spec give by brute force, and the bytes that were there stay."""
import filecmp
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

import lerobot
from parquet_reader import read

ETLC = os.path.abspath(sys.argv[1])
READER = os.path.join(os.path.dirname(ETLC), "etlc-read-parquet")
LENGTHS = (20, 15, 12, 25, 18, 9)
FROZEN, BLIND = 4, 5
NAMES = ("near", "closed", "lifted")
SPEC = """spec pick;
rate 10 Hz;
input x : f32;
input y : f32;
input z : f32;
predicate near = x <= 0.2;
predicate closed = y >= 0.1;
predicate lifted = z >= 0.5;
let holding = near && closed;
let soon = F[0,2] near;
monitor placed = F (near && F (closed && F lifted));
monitor calm = G (x <= 1.8);
sliding monitor again = F[0,3] near;
"""
MAP = ["--map", "x=observation.state[0]", "y=observation.state[1]", "z=observation.state[2]"]


def annotate(*words, status=0, names=MAP):
    done = subprocess.run([ETLC, "annotate", "pick.etl", *words, *names], capture_output=True,
                          text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def made_states():
    random = np.random.default_rng(11)
    states = [random.normal(size=(length, lerobot.STATE)).astype(np.float32)
              for length in LENGTHS]
    states[FROZEN][:] = np.float32([0.1, -0.5, -0.5, 0])
    states[BLIND][:, 2] = np.nan
    return states


def holds(state):
    return np.array([state[:, 0] <= np.float32(0.2), state[:, 1] >= np.float32(0.1),
                     state[:, 2] >= np.float32(0.5)])


def reached(state):
    """Returns the first row of each phase, as far as they are reached."""
    rows, begin = [], 0
    for phase in holds(state):
        later = [row for row in range(begin, len(state)) if phase[row]]
        if not later:
            break
        begin = later[0]
        rows.append(begin)
    return rows


def files_of(folder):
    return sorted(os.path.relpath(os.path.join(at, name), folder)
                  for at, _, names in os.walk(folder) for name in names)


def footer_begins(path):
    with open(path, "rb") as file:
        raw = file.read()
    return raw, len(raw) - 8 - int.from_bytes(raw[-8:-4], "little")


def check_files(old, new, changed, added):
    assert files_of(new) == sorted(files_of(old) + added), files_of(new)
    for name in files_of(old):
        if name not in changed:
            assert filecmp.cmp(f"{old}/{name}", f"{new}/{name}", shallow=False), name
        if name.startswith("videos/"):
            assert os.path.samefile(f"{old}/{name}", f"{new}/{name}"), name
        if name.endswith(".parquet") and name in changed:
            raw, end = footer_begins(f"{old}/{name}")
            longer, new_end = footer_begins(f"{new}/{name}")
            assert longer[:end] == raw[:end] and new_end > end, name


def rows_of_set(folder, names):
    """Returns the columns of all files of rows, in their order."""
    columns = [[] for _ in names]
    for name in files_of(folder):
        if name.startswith("data/"):
            for column, cells in zip(columns, read(READER, f"{folder}/{name}", names)):
                column += cells
    return columns


def check_success(release, states, **how):
    folder, out = f"s{release[1]}", f"s{release[1]}.out"
    lerobot.write(folder, release, LENGTHS, without=("next.success",), states=states, **how)
    said = annotate("--data", folder, "-o", out, "--success", "placed", status=1)
    assert "'placed' does not decide 1 episode: '5'" in said, said
    assert not os.path.exists(out) and no_part_is_left()
    said = annotate("--data", folder, "-o", out, "--success", "placed", "--undecided", "false")
    assert ", 1 undecided, listed in meta/etlc_annotations.json" in said, said
    data = [name for name in files_of(folder) if name.startswith("data/")]
    check_files(folder, out, data + ["meta/info.json"], ["meta/etlc_annotations.json"])
    with open(f"{out}/meta/info.json", encoding="utf-8") as file:
        info = json.load(file)
    assert info["features"].pop("next.success") == {"dtype": "bool", "shape": [1], "names": None}
    with open(f"{folder}/meta/info.json", encoding="utf-8") as file:
        assert info == json.load(file)
    with open(f"{out}/meta/etlc_annotations.json", encoding="utf-8") as file:
        assert json.load(file)["next.success"]["undecided"] == [BLIND]

    said, state, index = rows_of_set(out, ["next.success", "observation.state", "episode_index"])
    old = rows_of_set(folder, ["observation.state", "episode_index"])
    assert repr([state, index]) == repr(old)
    expected = []
    for own in states:
        rows = reached(own)
        first = max(rows[-1] - 1, 0) if len(rows) == 3 else len(own)
        expected += [[float(row >= first)] for row in range(len(own))]
    assert said == expected, (said, expected)
    assert any(value == [1.0] for value in said)
    again = annotate("--data", out, "-o", "again", "--success", "calm", status=1)
    assert "has the feature 'next.success' already" in again, again

    # A monitor that is never satisfied for good counts at the end.
    annotate("--data", folder, "-o", f"{out}.calm", "--success", "calm")
    said, = rows_of_set(f"{out}.calm", ["next.success"])
    expected = []
    for own in states:
        calm = bool((own[:, 0] <= np.float32(1.8)).all())
        expected += [[0.0]] * (len(own) - 1) + [[float(calm)]]
    assert said == expected


def check_progress(states):
    said = annotate("--data", "s3", "-o", "p3", "--progress", "placed")
    assert "progress 1.000 at phase 3: lifted" in said, said
    check_files("s3", "p3", [], ["meta/etlc_annotations.json", "sarm_progress.parquet"])
    index, episode, frame, progress = read(
        READER, "p3/sarm_progress.parquet",
        ["index", "episode_index", "frame_index", "progress_sparse"])
    assert index == [[float(i)] for i in range(sum(LENGTHS))]
    whole = [rows for rows in map(reached, states) if len(rows) == 3 and rows[2] > 0]
    shares = np.mean([np.diff([0, *rows]) / rows[2] for rows in whole], axis=0)
    steps = [0, *np.cumsum(shares)]
    begin = 0
    for number, own in enumerate(states):
        mine = [cell[0] for cell in progress[begin:begin + len(own)]]
        assert episode[begin:begin + len(own)] == [[float(number)]] * len(own)
        assert frame[begin:begin + len(own)] == [[float(row)] for row in range(len(own))]
        begin += len(own)
        assert all(0 <= x <= y <= 1 for x, y in zip(mine, mine[1:])), (number, mine)
        rows = reached(own)
        for row, value in enumerate(mine):
            phase = sum(at <= row for at in rows)
            assert steps[phase] - 1e-6 <= value, (number, row)
            assert value <= (steps[phase + 1] if phase < 3 else 1) + 1e-6, (number, row)
        if len(rows) == 3:
            assert mine[-1] == 1
    frozen = progress[sum(LENGTHS[:FROZEN]):sum(LENGTHS[:FROZEN + 1])]
    assert len({cell[0] for cell in frozen}) == 1, frozen


def check_list(states):
    annotate("--data", "s3", "--list", "bad.csv")
    said = annotate("--data", "s3", "--list", "-")
    with open("bad.csv", encoding="utf-8") as file:
        lines = file.read().splitlines()
    assert lines[0] == "episode,monitor,verdict,robustness,why" and len(lines) == 7
    assert all(line in said for line in lines)
    bad = [i for i, own in enumerate(states)
           if not (own[:, 0] <= np.float32(1.8)).all() or
           (i != BLIND and len(reached(own)) < 3) or
           not all(holds(own)[0][i:i + 4].any() for i in range(len(own) - 3))]
    worst = [int(line.split(",")[0]) for line in lines[1:1 + len(bad)]]
    assert sorted(worst) == bad, (worst, bad, said)
    listed = ", ".join(map(str, worst))
    assert f'delete_episodes --operation.episode_indices "[{listed}]"\n' in said, said


def check_round_trip(states):
    """Subtasks that were written label the predicate that they came from, to the row."""
    annotate("--data", "s3", "-o", "back", "--subtasks", "near")
    with open("back.etl", "w", encoding="utf-8") as file:
        file.write("spec back;\nrate 10 Hz;\ninput x : f32;\npredicate near = x <= 0.2;\n"
                   "monitor m = F near;\n")
    done = subprocess.run([ETLC, "evaluate", "back.etl", "--data", "back", "--label-by", "subtask",
                           *MAP[:2], "--json", "-"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "no predicate is named after the subtasks 'none'" in done.stderr, done.stderr
    found = json.loads(done.stdout)["predicates"]["near"]
    near = sum(int(holds(own)[0].sum()) for own in states)
    assert 0 < near < sum(LENGTHS)
    wanted = {"true_positives": near, "true_negatives": sum(LENGTHS) - near, "false_positives": 0,
              "false_negatives": 0, "unlabelled": 0}
    assert {key: found[key] for key in wanted} == wanted, found


def check_made(states):
    """Samples from the episodes that were made of the set give what those of its rows give."""
    os.mkdir("made")
    for number, own in enumerate(states):
        np.savez(f"made/s3-{number:06}.npz", **dict(zip("xyz", own.T)))
    annotate("--data", "s3", "-o", "m3", "--made", "made", "--success", "placed", "--undecided",
             "false", names=())
    assert rows_of_set("m3", ["next.success"]) == rows_of_set("s3.out", ["next.success"])
    np.savez("made/s3-000002.npz", **dict(zip("xyz", states[2][1:].T)))
    said = annotate("--data", "s3", "-o", "none", "--made", "made", "--success", "calm", names=(),
                    status=1)
    assert f"has {LENGTHS[2] - 1} steps, the episode has {LENGTHS[2]} rows" in said, said
    os.remove("made/s3-000002.npz")
    said = annotate("--data", "s3", "-o", "none", "--made", "made", "--success", "calm", names=(),
                    status=1)
    assert "made/s3-000002.npz" in said and not os.path.exists("none"), said


def check_mixed(states):
    """Rows of two episodes that take turns are refused: their subtasks have no place."""
    columns, _ = lerobot.rows_of(LENGTHS, None, states)
    order = sorted(range(sum(LENGTHS)), key=lambda row: (
        columns["frame_index"][1][row] if columns["episode_index"][1][row] < 2 else 1000 + row))
    mixed = {name: (kind, [values[row] for row in order])
             for name, (kind, values) in columns.items()}
    lerobot.write("mixed", "v3.0", LENGTHS, states=states, more=mixed)
    said = annotate("--data", "mixed", "-o", "none", "--subtasks", "near", status=1)
    assert "rows of episode 0" in said and not os.path.exists("none"), said


def check_in_place(states):
    lerobot.write("place", "v3.0", LENGTHS, without=("next.success",), states=states)
    before = {name: os.stat(f"place/{name}").st_ino for name in files_of("place")}
    annotate("--data", "place", "--in-place", "--success", "calm", "--progress", "placed")
    for name, inode in before.items():
        kept = os.stat(f"place/{name}").st_ino == inode
        assert kept != (name.startswith("data/") or name == "meta/info.json"), name
    assert rows_of_set("place", ["next.success"]) == rows_of_set("s3.out.calm", ["next.success"])
    assert no_part_is_left()


def no_part_is_left():
    return not [name for name in os.listdir() if ".etlc-part" in name]


def check_interruptions():
    """A full disk leaves nothing; a call that is killed leaves a part, which the next one clears;
    the set stays as it is."""
    before = {name: footer_begins(f"s3/{name}")[0] for name in files_of("s3")
              if name.endswith(".parquet")}
    words = [ETLC, "annotate", "pick.etl", "--data", "s3", "-o", "late", "--success", "calm", *MAP]

    def full_disk():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))

    done = subprocess.run(words, capture_output=True, text=True, preexec_fn=full_disk)
    assert done.returncode == 1, done.stdout
    assert "cannot be written: larger than a file may be" in done.stderr, done.stderr
    assert not os.path.exists("late") and no_part_is_left()

    with open("sleeps", "w", encoding="utf-8") as file:  # before it reads what is to be extended
        file.write('#!/bin/sh\n[ -e .late.etlc-part/meta ] && exec sleep 20\n'
                   f'exec {READER} "$@"\n')
    os.chmod("sleeps", 0o755)
    killed = subprocess.Popen(words, env={**os.environ, "ETLC_PARQUET_READER": "./sleeps"})
    limit = time.monotonic() + 60
    while not os.path.exists(".late.etlc-part/meta") and time.monotonic() < limit:
        time.sleep(0.01)
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 1 and "late: error: is being written by another call" in done.stderr
    killed.kill()
    killed.wait()
    assert os.path.exists(".late.etlc-part") and not os.path.exists("late")
    assert subprocess.run(words, capture_output=True).returncode == 0
    assert os.path.exists("late") and no_part_is_left()
    assert before == {name: footer_begins(f"s3/{name}")[0] for name in before}


def check_file_systems():
    """Videos are copied where another file system cannot have links to them."""
    shared = "/dev/shm"
    if not os.path.isdir(shared) or os.stat(shared).st_dev == os.stat(".").st_dev:
        return
    with tempfile.TemporaryDirectory(dir=shared) as folder:
        annotate("--data", "s3", "-o", f"{folder}/out", "--success", "calm")
        for name in files_of("s3"):
            if name.startswith("videos/"):
                assert filecmp.cmp(f"s3/{name}", f"{folder}/out/{name}", shallow=False), name


def check_refusals():
    for words, why in (
            (["--success", "place"], "the spec has no monitor 'place'; did you mean 'placed'?"),
            (["--success", "again"], "'again' judges again and again"),
            (["--progress", "calm"], "'calm' is no sequence of phases"),
            (["--subtasks", "soon"], "'soon' looks ahead"),
            (["--subtasks", "nea"], "no predicate or let 'nea'; did you mean 'near'?")):
        said = annotate("--data", "s3", "-o", "none", *words, status=1)
        assert why in said, said
    said = annotate("--data", "s2", "-o", "none", "--subtasks", "near", status=1)
    assert "is of the version 2, in which LeRobot reads no language_persistent" in said, said
    said = annotate("--data", "s3", "-o", "s2", "--success", "calm", status=1)
    assert "s2: error: exists: the new data set needs a new folder" in said, said
    said = annotate("--data", "s3", "-o", "s3/x", "--success", "calm", status=1)
    assert "lies in the data set of which it is a copy" in said, said
    os.symlink("s3/meta", "inside")
    said = annotate("--data", "s3", "-o", "inside/x", "--success", "calm", status=1)
    assert "lies in the data set of which it is a copy" in said, said
    os.mkdir("kept")
    os.symlink("kept", ".none.etlc-part")
    with open("kept/mine", "w", encoding="utf-8"):
        pass
    said = annotate("--data", "s3", "-o", "none", "--success", "calm", status=1)
    assert ".none.etlc-part' cannot be written" in said and os.path.exists("kept/mine"), said
    os.remove(".none.etlc-part")
    said = annotate("--data", "p3", "-o", "none", "--progress", "placed", status=1)
    assert "has the file sarm_progress.parquet already" in said, said
    annotate("--data", "s3", "-o", "none", status=2)
    annotate("--data", "s3", "--success", "calm", status=2)
    assert not os.path.exists("none")
    assert no_part_is_left()


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with open("pick.etl", "w", encoding="utf-8") as file:
        file.write(SPEC)
    own = made_states()
    check_success("v2.1", own)
    check_success("v3.0", own)
    check_progress(own)
    check_list(own)
    check_round_trip(own)
    check_made(own)
    check_mixed(own)
    check_in_place(own)
    check_interruptions()
    check_file_systems()
    check_refusals()
