#!/usr/bin/env python3
"""labels_test.py ETLC: labels in tables, and by names of folders, give the files of thresholds,
figures, fits and reports that arrays give, byte for byte, for episodes of every format; groups stay
in one fold; labels that changed are noticed between shards."""
import ctypes
import ctypes.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

from encoders import SMALL_CHECKSUMS
import lerobot

ETLC = os.path.abspath(sys.argv[1])
STEPS, EPISODES = 24, 12
SPEC = """spec dock;
input z : f32[2];
target bay = [[0, 0]];
predicate at_bay = min l2(z, bay) <= calibrated(conformal, alpha = 0.25);
predicate close = min l2(z, bay) <= calibrated(f1);
monitor arrives = F at_bay;
monitor stays = G (at_bay || close);
"""
FITTED = """spec fits;
input z : f32[2];
target bay = fitted(medoids, k = 2, of = z, where = at_bay);
predicate at_bay = min l2(z, bay) <= calibrated(f1);
predicate close = min l2(z, bay) <= calibrated(f1);
monitor arrives = F at_bay && F close;
"""


def call(*words, status=0):
    done = subprocess.run([ETLC, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout if status == 0 else done.stderr


def intervals(values):
    """Returns the longest runs of equal values, as (start, end, value)."""
    runs = []
    for step, value in enumerate(values):
        if not runs or runs[-1][2] != value:
            runs.append([step, step, value])
        runs[-1][1] = step + 1
    return runs


def rows(episode, name, values):
    """Returns rows of a table for 0, 1 and NaN, which is an unknown label."""
    result = []
    for start, end, value in intervals([None if np.isnan(v) else v for v in values]):
        if value is None:
            result.append([episode, "?" + name, start, end])
        elif value:
            result.append([episode, name, start, end])
    return result or [[episode, "!" + name, "", ""]]


def write_table(path, lines, columns="episode,predicate,start,end"):
    text = "".join(",".join(map(str, line)) + "\n" for line in lines)
    pathlib.Path(path).write_text(columns + "\n" + text)


def truths(z, random):
    """Returns labels of both predicates, with unknown ones; some episodes have no positive."""
    near = np.sqrt((z.astype(float) ** 2).sum(1)) + random.normal(0, 0.05, len(z))
    found = {"at_bay": (near < 0.6).astype(float), "close": (near < 0.3).astype(float)}
    found["close"][random.random(len(z)) < 0.1] = np.nan
    return found


def episodes():
    random = np.random.default_rng(4)
    made = []
    for number in range(EPISODES):
        path = np.linspace(1.5, 0.5 if number % 4 == 3 else 0, STEPS + number)[:, None]
        z = (path + random.normal(0, 0.1, (STEPS + number, 2))).astype(np.float32)
        made.append((z, truths(z, random)))
    return made


def csv(path, arrays):
    z = arrays["z"]
    others = [name for name in arrays if name != "z"]
    with open(f"{path}.csv", "w", encoding="ascii") as file:
        print("z[0],z[1]", *others, sep=",", file=file)
        for step, row in enumerate(z):
            cells = [arrays[name][step] for name in others]
            print(*(repr(float(x)) for x in row), *("" if np.isnan(x) else int(x) for x in cells),
                  sep=",", file=file)


def npz(path, arrays):
    np.savez(f"{path}.npz", **arrays)


def h5(path, arrays, groups=(), success=None):
    """Writes the arrays with the C library, some into groups; `success`: an attribute."""
    lib = ctypes.CDLL(ctypes.util.find_library("hdf5_serial") or ctypes.util.find_library("hdf5"))
    for name in ("H5Fcreate", "H5Screate_simple", "H5Dcreate2", "H5Gcreate2", "H5Acreate2"):
        getattr(lib, name).restype = ctypes.c_int64
    lib.H5open()
    handle = ctypes.c_int64
    file = handle(lib.H5Fcreate(f"{path}.h5".encode(), 2, handle(0), handle(0)))
    for group in groups:
        lib.H5Gclose(handle(lib.H5Gcreate2(file, group.encode(), handle(0), handle(0), handle(0))))
    double = handle.in_dll(lib, "H5T_NATIVE_DOUBLE_g")
    for name, array in arrays.items():
        array = np.ascontiguousarray(array.astype(np.float64))
        shape = (ctypes.c_uint64 * array.ndim)(*array.shape)
        space = handle(lib.H5Screate_simple(array.ndim, shape, None))
        data = handle(lib.H5Dcreate2(file, name.encode(), double, space, handle(0), handle(0),
                                     handle(0)))
        lib.H5Dwrite(data, double, handle(0), handle(0), handle(0),
                     array.ctypes.data_as(ctypes.c_void_p))
        lib.H5Dclose(data)
    if success is not None:
        one = (ctypes.c_uint64 * 1)(1)
        space = handle(lib.H5Screate_simple(1, one, None))
        attribute = handle(lib.H5Acreate2(file, b"success", double, space, handle(0), handle(0)))
        lib.H5Awrite(attribute, double, ctypes.byref(ctypes.c_double(success)))
        lib.H5Aclose(attribute)
    lib.H5Fclose(file)


def results(spec, half, other, *words):
    """Returns all results of calibrating on one half of the episodes and judging the other."""
    name = pathlib.Path(spec).stem
    written = {"report": call("calibrate", spec, "--data", *half, *words, "--folds", 3)}
    written["thresholds"] = pathlib.Path(f"{name}.thresholds.json").read_bytes()
    call("evaluate", spec, "--data", *other, *words, "--json", "out.json", "--by-episode")
    written["figures"] = pathlib.Path("out.json").read_bytes()
    written["tables"] = call("crossvalidate", spec, "--data", *half, *other, *words)
    call("report", spec, "--data", *other, *words, "-o", "out.html")
    written["page"] = pathlib.Path("out.html").read_bytes()
    assert "[E0670]" in call("evaluate", spec, "--data", *half, *words, status=1)
    return written


def expect_same(found, expected, place):
    for kind, value in expected.items():
        assert found[kind] == value, (place, kind, found[kind][:3000], value[:3000])


def formats_agree(made):
    for store in (csv, npz, h5):
        ending = store.__name__
        shutil.rmtree("runs", ignore_errors=True)
        os.mkdir("runs")
        for number, (z, labels) in enumerate(made):
            store(f"runs/ep{number:02}", {"z": z, **{f"truth.{n}": v for n, v in labels.items()}})
        halves = [[f"runs/ep0*.{ending}"], [f"runs/ep1*.{ending}"]]
        expected = results("dock.etl", *halves)
        lines = []
        for number, (z, labels) in enumerate(made):
            store(f"runs/ep{number:02}", {"z": z})
            named = (f"ep{number:02}", f"ep{number:02}.{ending}", f"runs/ep{number:02}")[number % 3]
            for name, values in labels.items():
                lines += rows(named, name, values)
        write_table("runs/labels.csv", lines)
        expect_same(results("dock.etl", *halves), expected, ending)
        # At another place, in another order, split into two.
        os.remove("runs/labels.csv")
        write_table("first.csv", lines[::2][::-1])
        write_table("second.csv", lines[1::2])
        expect_same(results("dock.etl", *halves, "--labels", "first.csv", "second.csv"), expected,
                    ending)


def seconds_are_steps(made):
    """Takes the tables of formats_agree; a decimal time is a step, whatever its binary form."""
    lines = [line for table in ("first.csv", "second.csv")
             for line in pathlib.Path(table).read_text().splitlines()[1:]]
    timed = []
    for line in lines:
        episode, name, start, end = line.split(",")
        timed.append([episode, name, start and f"{int(start) / 30:.3f}",
                      end and f"{int(end) / 30:.3f}"])
    write_table("seconds.csv", timed, "episode,predicate,start_s,end_s")
    halves = ["runs/ep0*"], ["runs/ep1*"]
    by_steps = results("timed.etl", *halves, "--labels", "first.csv", "second.csv")
    expect_same(results("timed.etl", *halves, "--labels", "seconds.csv"), by_steps, "seconds")
    # As spreadsheets write it.
    text = pathlib.Path("seconds.csv").read_text().replace("\n", "\r\n")
    semicolons = re.sub(r"(\d)\.(\d)", r"\1,\2", text.replace(",", ";"))
    for bytes_ in ((semicolons + ";;;\r\n").encode("utf-8-sig"),
                   ("sep=;\r\n" + semicolons).encode(),
                   (text.replace(",", "\t") + "\t\t\t\r\n").encode("utf-16")):
        pathlib.Path("seconds.csv").write_bytes(bytes_)
        report = call("calibrate", "timed.etl", "--data", *halves[0], "--labels", "seconds.csv",
                      "--folds", 3)
        assert report == by_steps["report"], report
    assert "[E0822]" in call("calibrate", "dock.etl", "--data", "runs", "--labels", "seconds.csv",
                             status=1)


def fits_agree(made):
    shutil.rmtree("runs")
    os.mkdir("runs")
    written = []
    for with_arrays in (True, False):
        lines = []
        for number, (z, labels) in enumerate(made):
            known = {n: np.nan_to_num(v) for n, v in labels.items()}
            arrays = {f"truth.{n}": v for n, v in known.items()} if with_arrays else {}
            npz(f"runs/{number}", {"z": z, **arrays})
            for name, values in known.items():
                lines += rows(f"{number}", name, values)
        if not with_arrays:
            write_table("runs/labels.csv", lines)
        report = call("fit", "fits.etl", "--data", "runs")
        suggested = call("fit", "fits.etl", "--data", "runs", "--suggest")
        written.append((report, suggested, pathlib.Path("fits.fitted.npz").read_bytes()))
    assert written[0] == written[1], written


def folders_agree(made):
    """A folder labels the episodes in folders below it, too; one above all episodes labels none."""
    halves = []
    for half, numbers in (("a", range(6)), ("b", range(6, EPISODES))):
        for folder in ("at_bay/monday", "elsewhere"):
            os.makedirs(f"close/{half}/{folder}")
        halves.append([f"close/{half}/*/*.npz", f"close/{half}/at_bay/monday/*.npz"])
        for number in numbers:
            folder = ("elsewhere", "at_bay", "at_bay/monday")[number % 3]
            z = made[number][0]
            label = np.full(len(z), number % 3 > 0)
            npz(f"close/{half}/{folder}/{number}", {"z": z, "truth.at_bay": label})
    expected = results("one.etl", *halves)
    for path in pathlib.Path("close").rglob("*.npz"):
        npz(path.with_suffix(""), {"z": np.load(path)["z"]})
    expect_same(results("one.etl", *halves, "--label-by", "folder"), expected, "folders")
    # The folder "close" is a predicate, but all episodes lie below it.
    said = call("calibrate", "dock.etl", "--data", "close/a/elsewhere", "close/b/elsewhere",
                "--label-by", "folder", status=1)
    assert "the episodes lie in 'a', 'b' and 'elsewhere', and none of these is a predicate" in said


def outcomes_agree(made):
    """Folders, a table and the recordings say alike which episodes succeed; calibration on normal
    episodes leaves the others out."""
    spec = SPEC.split("predicate")[0] + "predicate near = min l2(z, bay) <= {};\n" \
        "monitor calm = G near;\n"
    pathlib.Path("normal.etl").write_text(spec.format("calibrated(normal, alpha = 0.25)"))
    pathlib.Path("fixed.etl").write_text(spec.format(3))
    lines, kept = [], []
    for number, (z, _) in enumerate(made):
        folder = ("success", "failure", "success")[number % 3]
        os.makedirs(f"outcomes/{folder}", exist_ok=True)
        npz(f"outcomes/{folder}/{number}", {"z": z})
        lines.append([f"{folder}/{number}", "", 9 if number == 1 else "", "", folder])
        if folder == "success":
            kept.append(f"outcomes/{folder}/{number}.npz")
    table = ["--labels", "outcomes.csv", "--data", "outcomes/*/*.npz"]
    folders = ["--label-by", "folder", "--data", "outcomes/*/*.npz"]
    said = []
    for words in (folders, table):
        columns = "episode,predicate,start,end,outcome"
        write_table("outcomes.csv", lines, columns)
        figures = json.loads(call("evaluate", "fixed.etl", *words, "--json", "-"))["monitors"]
        said.append(figures["calm"]["outcomes"])
        call("calibrate", "normal.etl", *words, "-o", "some.json")
        call("calibrate", "normal.etl", "--data", *kept, "-o", "kept.json")
        some, only = (json.loads(pathlib.Path(name).read_text())["predicates"]["near"]
                      for name in ("some.json", "kept.json"))
        assert some["scores"] == only["scores"] and len(some["scores"]) == 8, (some, only)
    # What was left out may be judged.
    rest = call("evaluate", "normal.etl", "--thresholds", "some.json", "--data", "outcomes/failure",
                "--label-by", "folder", "--by-episode", "--json", "-")
    assert {row["outcome"] for row in json.loads(rest)["by_episode"]} == {"failure"}, rest
    assert said[0]["failures"] == 4 and said[0]["successes"] == 8, said[0]
    # The table says when an episode failed; folders do not.
    times = [name for name in said[0] if name.startswith("warning")]
    assert all(said[0][name] == said[1][name] for name in said[0] if name not in times), said
    for store in (npz, h5, csv):
        os.mkdir("told")
        for number, (z, _) in enumerate(made):
            succeeds = number % 3 != 1
            name, success = f"told/{number:02}", np.arange(len(z)) == 5
            if store == h5 and number > 5:
                h5(name, {"z": z}, success=succeeds)
            else:
                store(name, {"z": z, "next.success": success & succeeds})
        figures = call("evaluate", "fixed.etl", "--label-by", "outcome", "--data", "told", "--json",
                       "-")
        told = json.loads(figures)["monitors"]["calm"]["outcomes"]
        for one in (told, said[0]):  # an interval from resamples depends on the order
            one.pop("auroc_interval", None)
        assert told == said[0], (store, told, said[0])
        shutil.rmtree("told")
    error = call("evaluate", "fixed.etl", "--label-by", "outcome", "--data", *kept, status=1)
    assert "no episode has 'next.success', which is true at some step of a success" in error, error
    for line, why in (
        (["success/0", "", "", "", "failed"], "found 'failed', expected success, failure or"),
        (["success/0", "near", "", "", "success"], "stands in a row of its own"),
        (["success/0", "", 3, "", "success"], "only a failure has a start"),
        (["success/0", "", "", "", ""], "names no predicate"),
        (["success/0", "", "", "", "failure"], "calls 'outcomes/success/0.npz' a failure"),
    ):
        write_table("outcomes.csv", [*lines, line], columns)
        error = call("evaluate", "fixed.etl", *table, status=1)
        assert why in error and "outcomes.csv:14:" in error, error
    write_table("outcomes.csv", [["0", "success"]], "episode,outcome")
    error = call("evaluate", "normal.etl", "--labels", "outcomes.csv", "--data", kept[0], status=1)
    assert "'near' is calibrated, but there is no thresholds file" in error, error


def groups_of_files_agree(made):
    names = [f"data/demo_{number}" for number in range(EPISODES)]
    halves, words = (["a.h5"], ["b.h5"]), ["--episodes", "data/*"]

    def write(with_arrays):
        for file, numbers in (("a", range(6)), ("b", range(6, EPISODES))):
            arrays = {f"{names[n]}/z": made[n][0] for n in numbers}
            for n in numbers if with_arrays else ():
                for predicate, values in made[n][1].items():
                    arrays[f"{names[n]}/truth.{predicate}"] = values
            h5(file, arrays, ["data", *(names[n] for n in numbers)])

    write(True)
    expected = results("dock.etl", *halves, *words)
    write(False)
    lines = []
    for number, (_, labels) in enumerate(made):
        file = "ab"[number // 6]
        name = (names[number][5:], names[number], f"{file}.h5:{names[number]}")[number % 3]
        for predicate, values in labels.items():
            lines += rows(name, predicate, values)
    write_table("labels.csv", lines)  # beside both files
    expect_same(results("dock.etl", *halves, *words), expected, "groups of files")
    os.remove("labels.csv")


def videos_agree():
    """Labels beside a video need no new embeddings, and its episodes keep their fingerprint."""
    os.mkdir("demos")
    random = np.random.default_rng(6)
    lines, count = [], 6
    for number in range(count):
        lerobot.video(f"demos/ep{number}.mp4", 10 + number, number)
        label = np.arange(10 + number) >= random.integers(3, 8)
        cells = "".join(f"{int(v)}\n" for v in label)
        pathlib.Path(f"demos/ep{number}.csv").write_text("truth.at_bay\n" + cells)
        lines += rows(f"ep{number}", "at_bay", label.astype(float))
    words = ["embed", "seen.etl", "--data", "demos", "--encoder-cmd", f"{sys.executable} see.py"]
    halves = [[f"{{0}}/ep{number}.npz" for number in half] for half in ((0, 1, 2), (3, 4, 5))]
    call(*words, "-o", "with")
    os.rename("with", "made")
    placed = [[path.format("made") for path in half] for half in halves]
    expected = results("seen.etl", *placed)
    for number in range(count):
        os.remove(f"demos/ep{number}.csv")
    write_table("demos/labels.csv", lines)
    assert f"{count} episodes in made, {count} with embeddings of an earlier call" in call(
        *words, "-o", "made"), "labels in a table are no reason to encode again"
    expect_same(results("seen.etl", *placed, "--labels", "demos/labels.csv"), expected, "videos")
    said = subprocess.run([ETLC, "calibrate", "seen.etl", "--data", "made", "--labels",
                           "demos/labels.csv"], capture_output=True, text=True)
    assert "W1001" not in said.stderr, said.stderr


def data_sets_agree():
    lengths = (20, 15, 12, 18, 16, 13)
    mapped = ["--map", "q=observation.state"]
    for release in ("v2.1", "v3.0"):
        name = f"set{release[1]}"
        truth = lerobot.write(name, release, lengths)
        halves = [[f"{name}:0:3"], [f"{name}:3:6"]]
        expected = results("rows.etl", *halves, *mapped, "truth.near=next.success")
        lines = []
        for number, (_, _, success) in enumerate(truth):
            named = (f"{number}", f"{name}:{number}", f"{number:06}")[number % 3]
            for start, end, value in intervals(list(success)):
                if value:  # the rest is false
                    lines.append([named, "near", start / lerobot.FPS, end / lerobot.FPS])
        write_table(f"{name}/labels.csv", lines, "episode,predicate,start_s,end_s")
        expect_same(results("rows.etl", *halves, *mapped), expected, release)
        told = json.loads(call("evaluate", "rows.etl", "--thresholds", "rows.thresholds.json",
                               "--label-by", "outcome", "--data", *halves[1], *mapped,
                               "--by-episode", "--json", "-"))["by_episode"]
        succeeded = ["success" if truth[number][2].any() else "failure" for number in (3, 4, 5)]
        assert sorted(row["outcome"] for row in told) == sorted(succeeded), told


def unlabelled_is_not_false(made):
    """An episode without a row is refused, until a row says that the predicate never holds."""
    shutil.rmtree("runs")
    os.mkdir("runs")
    for number in range(4):
        npz(f"runs/{number}", {"z": made[number][0]})
    lines = [[f"{number}", "at_bay", 20, ""] for number in (0, 1, 3)]
    write_table("runs/labels.csv", lines)
    said = call("calibrate", "one.etl", "--data", "runs", status=1)
    assert "runs/2.npz" in said and "[E0810]" in said and "!NAME" in said, said
    said = call("evaluate", "one.etl", "--data", "runs/2.npz", "runs/0.npz", status=1)
    assert "[E0650]" in said or "[E0810]" in said, said
    write_table("runs/labels.csv", [*lines, ["2", "!at_bay", "", ""]])
    report = call("calibrate", "one.etl", "--data", "runs")
    positives = sum(len(made[number][0]) - 20 for number in (0, 1, 3))
    assert f"labels: {positives} frames positive, " in report, report
    write_table("runs/labels.csv", [*lines, ["2", "?at_bay", "", ""]])
    report = call("calibrate", "one.etl", "--data", "runs")
    assert f", {len(made[2][0])} unknown and left out" in report, report
    # Another label makes no other recording.
    write_table("runs/labels.csv", [[f"{number}", "at_bay", 5, 9] for number in range(4)])
    assert "[E0670]" in call("evaluate", "one.etl", "--data", "runs", status=1)


def groups_stay_together(made):
    group_of = {number: f"g{number % 5}" if number < 10 else "" for number in range(EPISODES)}
    lines = [[f"{number}", "at_bay", 15, "", group] for number, group in group_of.items()]
    columns = "episode,predicate,start,end,group"
    shutil.rmtree("runs")
    os.mkdir("runs")
    for number, (z, _) in enumerate(made):
        npz(f"runs/{number}", {"z": z})

    def folds(table, *words):
        write_table("runs/labels.csv", table, columns)
        call("crossvalidate", "one.etl", "--data", "runs", *words, "--by-episode", "--json",
             "out.json")
        return {int(pathlib.Path(row["episode"]).stem): row["fold"]
                for row in json.loads(pathlib.Path("out.json").read_text())["by_episode"]}

    def split(of):
        return [group for group in set(group_of.values()) - {""}
                if len({of[number] for number in of if group_of[number] == group}) > 1]

    assert split(folds([[*line[:4], ""] for line in lines])), "without groups some are split"
    together = folds(lines)
    assert not split(together) and len(set(together.values())) == 5, together
    # A row may give the group alone.
    alone = [[*line[:4], ""] for line in lines]
    alone += [[line[0], "", "", "", line[4]] for line in lines if line[4]]
    assert folds(alone) == together
    sizes = [list(together.values()).count(fold) for fold in set(together.values())]
    assert max(sizes) - min(sizes) <= 2, sizes
    write_table("runs/labels.csv", [[*line[:4], f"g{number % 2}"]
                                    for number, line in enumerate(lines)], columns)
    said = call("crossvalidate", "one.etl", "--data", "runs", "--folds", 3, status=1)
    assert "3 folds take at least as many groups; there are 2 [E0690]" in said, said


def shards_agree(made):
    """Takes the episodes of groups_stay_together."""
    lines = [[f"{number}", "at_bay", 15, "", f"g{number % 4}"] for number in range(EPISODES)]
    write_table("runs/labels.csv", lines, "episode,predicate,start,end,group")
    words = ["calibrate", "one.etl", "--data", "runs", "--folds", 4]
    printed = call(*words)
    one = pathlib.Path("one.thresholds.json").read_bytes()
    os.remove("one.thresholds.json")
    for shard in (1, 2):
        call(*words, "--shard", f"{shard}/2", "--part", f"{shard}.part")
    assert call("merge", "1.part", "2.part") == printed
    assert pathlib.Path("one.thresholds.json").read_bytes() == one
    lines[3][2] = 16
    write_table("runs/labels.csv", lines, "episode,predicate,start,end,group")
    assert "[E1103]" in call("merge", "1.part", "2.part", status=1), "labels have changed since"
    call(*words, "--shard", "2/2", "--part", "2.part")
    assert "[E1103]" in call("merge", "1.part", "2.part", status=1), "shards have other labels"


def tables_are_no_output(made):
    said = call("evaluate", "one.etl", "--data", "runs", "--json", "runs/labels.csv", status=1)
    assert "runs/labels.csv" in said, said
    said = call("calibrate", "one.etl", "--data", "runs/labels.csv", status=1)
    assert "is a table of labels, and no episode [E0801]" in said, said


def main():
    made = episodes()
    one = "".join(line for line in SPEC.splitlines(True) if "close" not in line)
    seen = one.replace("input z : f32[2]", 'encoder see = load("see.py");\ninput z : f32[2] by see')
    rows_spec = one.replace("f32[2]", "f32[4]").replace("[0, 0]", "[0, 0, 0, 0]")
    rows_spec = rows_spec.replace("at_bay", "near").replace("(z,", "(q,").replace("z :", "q :")
    for name, text in (("see.py", SMALL_CHECKSUMS), ("dock.etl", SPEC), ("fits.etl", FITTED),
                       ("timed.etl", SPEC.replace("input z", "rate 30 Hz;\ninput z")),
                       ("one.etl", one), ("seen.etl", seen), ("rows.etl", rows_spec)):
        pathlib.Path(name).write_text(text)
    formats_agree(made)
    seconds_are_steps(made)
    fits_agree(made)
    folders_agree(made)
    outcomes_agree(made)
    groups_of_files_agree(made)
    videos_agree()
    data_sets_agree()
    unlabelled_is_not_false(made)
    groups_stay_together(made)
    shards_agree(made)
    tables_are_no_output(made)


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
print("labels beside episodes count as arrays in them")
