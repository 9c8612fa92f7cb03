#!/usr/bin/env python3
"""subtasks_test.py ETLC: labels by the subtasks of LeRobot data sets are exact to the frame, from
each place and in each type in which LeRobot and others keep them; what is ambiguous is refused."""
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

import numpy as np

from encoders import SMALL_CHECKSUMS
import lerobot
import parquet_writer as parquet

ETLC = os.path.abspath(sys.argv[1])
LENGTHS = (23, 31, 17)
STORED = {camera: [b"no image"] * sum(LENGTHS) for camera in lerobot.CAMERAS}
NAMES = ("reach", "grasp", "lift")  # "lift" is no predicate
SPEC = """spec task;
input r, g : f32;
predicate reach = r > 0.5;
predicate grasp = g > 0.5;
predicate free = r < 2;
monitor done = F (reach && F grasp) && G free;
"""
LEARN = """spec learn;
input r : f32;
predicate reach = r >= calibrated(f1);
truth reach = subtask == "bring it [1]";
monitor done = F reach;
"""
MAPPED = ["--map", "r=next.reward", "g=is.grasp"]


def call(*words, status=0):
    done = subprocess.run([ETLC, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def write(shown, more=None, of_episodes=None, release="v3.0", **how):
    """Writes a set whose columns are 1 where the rows show the subtask; one is a reward."""
    shutil.rmtree("set", ignore_errors=True)
    columns = {column: (parquet.FLOAT, [float(x == name) for rows in shown for x in rows])
               for name, column in (("reach", "next.reward"), ("grasp", "is.grasp"))}
    lerobot.write("set", release, LENGTHS, STORED, columns | (more or {}), of_episodes,
                  codec=parquet.NONE, **how)


def judged(*data, spec="task.etl", by=("--label-by", "subtask")):
    done = subprocess.run([ETLC, "evaluate", spec, *by, "--data", *(data or ["set"]), *MAPPED,
                           "--json", "-"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["predicates"], done.stderr


def expect_exact(shown, *data, names=("reach", "grasp"), **how):
    """The predicates hold exactly where their labels do, in all rows but the unknown ones."""
    found, said = judged(*data, **how)
    rows = [x for episode in shown for x in episode]
    known = [x for x in rows if x is not None]
    for name in names:
        wanted = {"true_positives": known.count(name), "false_positives": 0, "false_negatives": 0,
                  "true_negatives": len(known) - known.count(name),
                  "unlabelled": len(rows) - len(known)}
        assert {key: found[name][key] for key in wanted} == wanted, (name, found[name], wanted)
    return said


def refusal(*words):
    return call("evaluate", "task.etl", "--label-by", "subtask", "--data", "set", *MAPPED, *words,
                status=1)


# ---- language_persistent

def seconds(row):
    return float(np.float32(row / lerobot.FPS))


def entry(start, content, style="subtask"):
    return {"role": "assistant", "content": content, "style": style, "timestamp": start,
            "camera": None, "tool_calls": None}


def random_entries(length):
    """Other styles are among them; the order of the list does not matter."""
    starts = sorted(random.sample(range(length + 3), random.randint(1, 6)))
    made = [entry(seconds(row), random.choice([*NAMES, "none", None])) for row in starts]
    made += [entry(seconds(random.randrange(length)), "reach", style)
             for style in ("plan", "memory", None)]
    random.shuffle(made)
    return made


def active(entries, length):
    """LeRobot's active_at: of the style, the one with the greatest time up to that of the row."""
    shown = []
    for row in range(length):
        before = [one for one in entries
                  if one["style"] == "subtask" and one["timestamp"] <= seconds(row)]
        shown.append(max(before, key=lambda one: one["timestamp"])["content"] or "none"
                     if before else "none")
    return shown


def language(entries, fields=None, element="element", time=parquet.FLOAT):
    """A column with the list of an episode in each of its rows."""
    known = {"role": parquet.TEXT, "content": parquet.TEXT, "style": parquet.TEXT,
             "timestamp": time, "camera": parquet.NULL, "tool_calls": parquet.NULL}
    rows = [one for one, length in zip(entries, LENGTHS) for _ in range(length)]
    return {"language_persistent": (parquet.Structs(fields or known, element), rows)}


def language_is_read():
    safe = {"role": parquet.TEXT, "content": parquet.TEXT, "style": parquet.TEXT,
            "timestamp": parquet.FLOAT, "camera": parquet.TEXT, "tool_calls": parquet.TEXTS}
    few = {"style": parquet.TEXT, "content": parquet.TEXT, "timestamp": parquet.DOUBLE}
    more = {"extra": parquet.INT64, **few}
    for fields, element, time, release, how in (
            (None, "element", parquet.DOUBLE, "v3.0", {"page_rows": 5}),
            (None, "item", parquet.FLOAT, "v3.0", {"dictionary": True}),
            (safe, "element", None, "v3.0", {"page_rows": 4, "dictionary": True}),
            (few, "item", None, "v2.1", {}), (more, "element", None, "v3.0", {"version": 2})):
        entries = [random_entries(length) for length in LENGTHS]
        entries[0].append(entry(seconds(LENGTHS[0] - 1), "grasp", "subtask"))
        entries[0] = list({(one["timestamp"], one["style"]): one for one in entries[0]}.values())
        entries[1] = [entry(seconds(0), "reach"), entry(seconds(7), "grasp"),
                      entry(seconds(8), "lift"), entry(seconds(9), "reach")]
        for one in entries[0] + entries[1] + entries[2]:
            one["extra"] = None
        shown = [active(one, length) for one, length in zip(entries, LENGTHS)]
        write(shown, language(entries, fields, element, time), release=release, **how)
        said = expect_exact(shown)
        assert "no predicate is named after the subtasks" in said and "'lift'" in said, said
        assert "no subtask is named after the predicates 'free'" in said, said
    # Times that another writer did not round to float32 are those of the rows, as in LeRobot.
    entries = [[entry(row / lerobot.FPS, NAMES[row % 3]) for row in range(0, length, 2)]
               for length in LENGTHS]
    shown = [[NAMES[row // 2 * 2 % 3] for row in range(length)] for length in LENGTHS]
    write(shown, language(entries, time=parquet.DOUBLE))
    expect_exact(shown)
    # A list that is empty everywhere has elements of no type.
    write(shown, {"language_persistent": (parquet.FLOAT, [[] for rows in shown for _ in rows])})
    assert "no episode has subtasks: expected a LeRobot data set with" in refusal()
    # An episode without any is unlabelled.
    entries[1] = []
    write(shown, language(entries))
    assert "[E0810]" in refusal(), refusal()
    expect_exact([shown[0]], "set:0")


def ambiguous_language_is_refused():
    shown = [["reach"] * length for length in LENGTHS]
    for first, why in (
            ([entry(0.5, "reach"), entry(0.5, "grasp")], "two subtasks of language_persistent "
             "begin at 0.5 s, and which of them counts is not defined"),
            ([entry(0.0, "reach"), entry(None, "grasp")],
             "entry 1 of language_persistent is a subtask without content and timestamp")):
        write(shown, language([first] * 3))
        said = refusal()
        assert f"set:000000: error: data/chunk-000/file-000.parquet: {why} [E0850]" in said, said
    column = language([[entry(0.0, "reach")]] * 3)
    column["language_persistent"][1][4] = [entry(0.0, "reach"), entry(0.4, "grasp")]
    write(shown, column)
    assert "row 4 of the episode has another list language_persistent than its first row" in \
        refusal(), refusal()
    fields = {"style": parquet.TEXT, "content": parquet.INT64, "timestamp": parquet.DOUBLE}
    write(shown, language([[entry(0.0, 7)]] * 3, fields))
    assert "column 'language_persistent.content' does not hold text" in refusal(), refusal()


# ---- subtask_index

def indexed(shown, table, name="subtask", indices=None):
    """Writes a set whose rows have indices, and meta/subtasks.parquet."""
    column = [-1 if x is None else table.index(x) for rows in shown for x in rows]
    write(shown, {"subtask_index": (parquet.INT64, column)})
    parquet.write("set/meta/subtasks.parquet",
                  {"subtask_index": (parquet.INT64, indices or list(range(len(table)))),
                   name: (parquet.TEXT, list(table))})


def indices_are_read():
    table = ("grasp", "none", "reach", "lift")
    for name, some in (("subtask", table), ("__index_level_0__", (*table, None))):
        shown = [[random.choice(some) for _ in range(length)] for length in LENGTHS]
        indexed(shown, table, name)
        said = expect_exact(shown)
        unknown = sum(rows.count(None) for rows in shown)
        words = f"a negative subtask_index, or none, leaves {unknown} rows without label"
        assert (words in said) == (unknown > 0), said
    indexed(shown, table, indices=[0, 1, 3, 2])
    assert "meta/subtasks.parquet: row 2 has the subtask_index 3: some releases" in refusal()
    indexed(shown, table, "word")
    assert "meta/subtasks.parquet: has no name in row 0, expected a column 'subtask'" in refusal()
    indexed([[name or "lift" for name in rows] for rows in shown], table)
    parquet.write("set/meta/subtasks.parquet", {"subtask_index": (parquet.INT64, [0, 1]),
                                                "subtask": (parquet.TEXT, ["grasp", "reach"])})
    assert "and meta/subtasks.parquet lists 2 subtasks [E0850]" in refusal(), refusal()
    os.remove("set/meta/subtasks.parquet")
    assert "meta/subtasks.parquet: no such file" in refusal(), refusal()


# ---- SARM

def ranges(kind, made, number=parquet.INT64):
    """Columns of meta/episodes: of each episode (name, first, last) or None."""
    return {f"{kind}_names": (parquet.TEXT, [x and [name for name, _, _ in x] for x in made]),
            f"{kind}_start_frames": (number, [x and [number == parquet.DOUBLE and float(a) or a
                                                     for _, a, _ in x] for x in made]),
            f"{kind}_end_frames": (number, [x and [number == parquet.DOUBLE and float(b) or b
                                                   for _, _, b in x] for x in made])}


def first_match(made, length):
    """Both ends are inclusive; the first that has the frame counts."""
    return [next((name for name, first, last in made if first <= row <= last), "none")
            for row in range(length)]


def random_ranges(length):
    made = []
    for _ in range(random.randint(1, 5)):
        first = random.randrange(length)
        made.append((random.choice(NAMES), first, first + random.randrange(12)))
    return made


def ranges_are_read():
    for kind, number in (("sparse_subtask", parquet.INT64), ("dense_subtask", parquet.INT32),
                         ("subtask", parquet.DOUBLE)):
        made = [random_ranges(length) for length in LENGTHS]
        made[0] += [("reach", 2, 2), ("grasp", 2, 9)]
        shown = [first_match(one, length) for one, length in zip(made, LENGTHS)]
        write(shown, of_episodes=ranges(kind, made, number))
        expect_exact(shown)
        for episode, rows in enumerate(shown):
            if names := {"reach", "grasp"} & {name for name, _, _ in made[episode]}:
                expect_exact([rows], f"set:{episode}", names=names)
        made[1] = None  # not annotated
        write(shown, of_episodes=ranges(kind, made, number))
        assert "[E0810]" in refusal(), refusal()
    both = ranges("sparse_subtask", made[:1] * 3) | ranges("subtask", made[2:] * 3)
    shown = [first_match(made[0], length) for length in LENGTHS]
    write(shown, of_episodes=both)
    expect_exact(shown)
    for wrong, why in (([("reach", 4, 3)], "has 'reach' from frame 4 to 3, expected a name"),
                       ([("reach", -1, 3)], "has 'reach' from frame -1 to 3"),
                       ([("", 0, 3)], "has '' from frame 0 to 3")):
        write(shown, of_episodes=ranges("dense_subtask", [wrong] * 3))
        said = refusal()
        assert f"meta/episodes/chunk-000/file-000.parquet: dense_subtask of episode 0 " \
            f"{why}" in said, said
    short = ranges("sparse_subtask", [[("reach", 0, 3)]] * 3)
    short["sparse_subtask_end_frames"] = (parquet.INT64, [[1, 2]] * 3)
    write(shown, of_episodes=short)
    assert "has 1 name, 1 first and 2 last frames, expected as many" in refusal()


# ---- several sources; truths of the spec

def several_sources_are_refused():
    """A truth says which of them counts."""
    made = [random_ranges(length) for length in LENGTHS]
    entries = [random_entries(length) for length in LENGTHS]
    fine = [first_match(one, length) for one, length in zip(made, LENGTHS)]
    rough = [[("reach", 0, 5)], [("grasp", 3, 8)], [("reach", 1, 2)]]
    coarse = [first_match(one, length) for one, length in zip(rough, LENGTHS)]
    by_word = {"language_persistent": [active(*one) for one in zip(entries, LENGTHS)],
               "sparse_subtask": coarse, "dense_subtask": fine}
    columns = ranges("sparse_subtask", rough) | ranges("dense_subtask", made)
    for word, shown in by_word.items():
        write(shown, language(entries), columns)
        said = refusal()
        assert "set:000000: error: has subtasks in language_persistent and in sparse_subtask: " \
            "say in the spec which of them counts" in said and "[E0862]" in said, said
        pathlib.Path("said.etl").write_text(
            SPEC + f'truth reach = {word} == "reach";\n'
            f'truth grasp = !({word} != "grasp" || {word} == "reach");\n')
        expect_exact(shown, spec="said.etl", by=())
    write(coarse, language(entries))
    said = call("evaluate", "said.etl", "--data", "set", *MAPPED, status=1)
    assert "has no 'dense_subtask'; dense_subtask == \"reach\" compares it with" in said, said


def truths_name_subtasks():
    """Any text, in a formula; unknown rows leave it unknown."""
    table = ("pick up the cup", "bring it", "bring it [1]")
    shown = [[random.choice((*table, None)) for _ in range(length)] for length in LENGTHS]
    is_first = [[x and {table[0]: "reach", table[2]: "grasp"}.get(x, "none") for x in rows]
                for rows in shown]
    column = [-1 if x is None else table.index(x) for rows in shown for x in rows]
    write(is_first, {"subtask_index": (parquet.INT64, column)})
    parquet.write("set/meta/subtasks.parquet", {"subtask_index": (parquet.INT64, [0, 1, 2]),
                                                "subtask": (parquet.TEXT, list(table))})
    spec = SPEC + f'truth reach = subtask == "{table[0]}";\n' \
        f'truth grasp = subtask == "{table[2]}";\n'
    pathlib.Path("said.etl").write_text(spec)
    expect_exact(is_first, spec="said.etl", by=())
    pathlib.Path("said.etl").write_text(spec.replace("up the cup", "up teh cup"))
    said = judged(spec="said.etl", by=())[1]
    assert 'subtask == "pick up teh cup": warning: no episode shows this subtask; did you mean ' \
        "'pick up the cup'? [W0860]" in said, said
    pathlib.Path("said.etl").write_text(spec)
    header = call("said.etl", "-o", "-")
    assert "pick up" not in header, "the class knows no subtask"
    pathlib.Path("again.etl").write_text(
        spec.replace('subtask == "bring', 'once subtask != "bring') + "// again\n")
    printed = call("again.etl", "--emit", "ast")
    assert f'truth grasp = O !subtask == "{table[2]}";' in printed, printed
    pathlib.Path("again.etl").write_text(printed)
    assert call("again.etl", "--emit", "ast") == printed
    call("calibrate", "learn.etl", "--data", "set", "--map", "r=is.grasp")
    call("learn.etl", "-o", "-")
    other = pathlib.Path("learn.etl").read_text().replace("bring it [1]", "bring it")
    pathlib.Path("learn.etl").write_text(other)
    said = call("learn.etl", "-o", "-", status=1)
    assert 'subtask == "bring it"' in said and "[E0652]" in said, said


def embedded_episodes_keep_subtasks():
    """`etlc embed` stores what the truth asks for with the embeddings."""
    table = ("none", "grasp it")
    shown = [[random.choice((*table, None)) for _ in range(length)] for length in LENGTHS]
    column = [-1 if x is None else table.index(x) for rows in shown for x in rows]
    shutil.rmtree("set")
    lerobot.write("set", "v3.0", LENGTHS, more={"subtask_index": (parquet.INT64, column)})
    parquet.write("set/meta/subtasks.parquet", {"subtask_index": (parquet.INT64, [0, 1]),
                                                "subtask": (parquet.TEXT, list(table))})
    pathlib.Path("see.py").write_text(SMALL_CHECKSUMS)
    pathlib.Path("seen.etl").write_text(
        'spec seen; encoder see = load("see.py"); input z : f32[2] by see;\n'
        "predicate grasp = l2(z, origin) <= 1; target origin = [[0, 0]];\n"
        'truth grasp = subtask == "grasp it";\n'
        "monitor done = F grasp;\n")
    call("embed", "seen.etl", "--data", "set", "--camera", lerobot.CAMERAS[0], "--encoder-cmd",
         f"{sys.executable} see.py", "-o", "made")
    for number, rows in enumerate(shown):
        found = np.load(f"made/set-{number:06}.npz")['subtask == "grasp it"']
        wanted = [np.nan if x is None else x == "grasp it" for x in rows]
        assert np.array_equal(found, wanted, equal_nan=True), (found, wanted)
    said = json.loads(call("evaluate", "seen.etl", "--data", "made", "--json", "-"))
    rows = [x for episode in shown for x in episode]
    found = said["predicates"]["grasp"]
    assert (found["positives"], found["unlabelled"]) == (rows.count("grasp it"),
                                                         rows.count(None)), found


def main():
    pathlib.Path("task.etl").write_text(SPEC)
    pathlib.Path("learn.etl").write_text(LEARN)
    language_is_read()
    ambiguous_language_is_refused()
    indices_are_read()
    ranges_are_read()
    several_sources_are_refused()
    truths_name_subtasks()
    embedded_episodes_keep_subtasks()


random.seed(7)
with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
    os.chdir("/")
print("subtasks of data sets are labels, exact to the frame")
