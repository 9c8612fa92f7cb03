#!/usr/bin/env python3
"""refusals_test.py ETLC: contradictory, incomplete or damaged data sets. Missing parts are named
and left out, and the rest is read; unreadable ones are an error."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

from encoders import FIRST_PIXEL
import lerobot
import parquet_writer as parquet

ETLC = os.path.abspath(sys.argv[1])
LENGTHS = (9, 8, 7)
TOP, WRIST = lerobot.CAMERAS
PLAIN = "spec plain;\nrate {} Hz;\ninput q : {};\nmonitor m = F {} > 1;\n"
SEEN = """spec seen;
rate 10 Hz;
encoder see = load("see.py");
input z : f32[1] by see;
target none = [[0]];
monitor m = F l2(z, none) <= 1;
"""


def embed(spec, *words, status):
    shutil.rmtree("out", ignore_errors=True)
    done = subprocess.run([ETLC, "embed", spec, *words, "-o", "out", "--encoder-cmd",
                           f"{sys.executable} see.py"], capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stderr


def change(path, make):
    with open(path, encoding="utf-8") as file:
        value = json.load(file)
    make(value)
    lerobot.write_json(path, value)


def write(path, text, mode="w"):
    with open(path, mode) as file:
        file.write(text)


def rewrite_lines(make):
    path = "set/meta/episodes.jsonl"
    with open(path, encoding="utf-8") as file:
        lines = [json.loads(line) for line in file]
    for number, line in enumerate(lines):
        make(number, line)
    write(path, "".join(json.dumps(line) + "\n" for line in lines))


def rewrite_rows(episode, make):
    columns, _ = lerobot.rows_of(LENGTHS)
    begin = sum(LENGTHS[:episode])
    own = {name: (kind, values[begin:begin + LENGTHS[episode]])
           for name, (kind, values) in columns.items()}
    make(own)
    parquet.write(f"set/data/chunk-000/episode_{episode:06}.parquet", own)


def rewrite_table(make):
    table = lerobot.episode_table(LENGTHS)
    make(table)
    parquet.write("set/meta/episodes/chunk-000/file-000.parquet", table,
                  nested=("stats/action/mean",))


# Incomplete sets: a change, the text of the warning, and the remaining episodes.
ROWS = "set/data/chunk-000/episode_000001.parquet"
VIDEO = f"set/videos/chunk-000/{TOP}/episode_000001.mp4"
LACKING_21 = (
    (lambda: os.remove(ROWS), "episode_000001.parquet: no such file", (0, 2)),
    (lambda: os.remove(VIDEO), f"{TOP}/episode_000001.mp4: no such file", (0, 2)),
    (lambda: os.remove(VIDEO.replace(TOP, WRIST)), None, (0, 1, 2)),
    (lambda: write(ROWS, "version https://git-lfs.github.com/spec/v1\n"),
     "is a pointer of Git LFS", (0, 2)),
    (lambda: write(ROWS, open(ROWS, "rb").read()[:-9], "wb"), "is cut", (0, 2)),
    (lambda: rewrite_lines(lambda n, line: line.update(length=line["length"] + (n == 1))),
     "has 8 rows of it, the metadata say 9", (0, 2)),
    (lambda: rewrite_lines(lambda n, line: line.update(length=line["length"] + (n == 1))),
     "promises 24 rows, meta/episodes.jsonl lists 25 rows", (0, 2)),
    (lambda: change("set/meta/info.json", lambda info: info.update(total_episodes=50)),
     "promises 50 episodes, meta/episodes.jsonl lists 3 episodes", (0, 1, 2)),
    (lambda: write("set/meta/tasks.jsonl", '{"task_index": 0, "task": "pick the cube"}\n'),
     "meta/tasks.jsonl does not list 'place it in the bin'", (0, 1, 2)),
    (lambda: change("set/meta/info.json", lambda info: info.update(total_episodes=float("nan"))),
     "meta/info.json has 'null' for total_episodes, expected a whole number", (0, 1, 2)),
    (lambda: rewrite_lines(lambda n, line: line.update(stats={"NaN": [float("nan"), -float("inf")],
                                                              "\\": "\"NaN"})), None, (0, 1, 2)),
    (lambda: (os.remove(ROWS), os.mkfifo(ROWS)), "episode_000001.parquet: is a pipe", (0, 2)),
    (lambda: (os.remove(VIDEO), os.mkfifo(VIDEO)), "episode_000001.mp4: is a pipe", (0, 2)),
    (lambda: write("set/meta/tasks.jsonl", '{"task_index": 0, "task": "pick the cube"}\n'),
     "promises 2 tasks, meta/tasks.jsonl lists 1 task", (0, 1, 2)),
    (lambda: change("set/meta/info.json", lambda info: info.update(total_tasks=1.7)),
     "meta/info.json has '1.7' for total_tasks, expected a whole number", (0, 1, 2)),
    (lambda: os.remove("set/meta/tasks.jsonl"), "meta/tasks.jsonl: no such file", (0, 1, 2)),
    (lambda: write(VIDEO, "version https://git-lfs.github.com/spec/v1\n"),
     "is a pointer of Git LFS", (0, 2)),
    (lambda: shutil.copy(ROWS, ROWS.replace("1.p", "7.p")),
     "'data/chunk-000/episode_000007.parquet', which the metadata do not mention", (0, 1, 2)),
    (lambda: rewrite_rows(1, lambda own: own["timestamp"][1].__setitem__(5, 0.45)),
     "row 5 is at 0.45 s, expected it at 0.5 s", (0, 2)),
    (lambda: rewrite_rows(1, lambda own: own.update(
        timestamp=(parquet.FLOAT, [0.3 + t for t in own["timestamp"][1]]))),
     "episode_000001.parquet: row 0 is at 0.3 s, expected it at 0 s", (0, 2)),
    (lambda: rewrite_rows(1, lambda own: own["timestamp"][1].__setitem__(5, None)),
     "episode_000001.parquet: row 5 is at null s, expected it at 0.5 s", (0, 2)),
    (lambda: rewrite_rows(1, lambda own: own["frame_index"][1].__setitem__(5, None)),
     "episode_000001.parquet: row 5 has the frame_index null", (0, 2)),
    (lambda: rewrite_rows(1, lambda own: own["frame_index"][1].__setitem__(5, 6)),
     "row 5 has the frame_index 6", (0, 2)),
    (lambda: rewrite_rows(1, lambda own: own["episode_index"][1].__setitem__(5, 0)),
     "has 7 rows of it, the metadata say 8", (0, 2)))
LACKING_30 = (
    (lambda: os.remove("set/data/chunk-000/file-001.parquet"), "file-001.parquet: no such file",
     (0, 1)),
    (lambda: rewrite_table(lambda table: table["length"][1].__setitem__(1, 9)),
     "has 8 rows of it, the metadata say 9", (0, 2)),
    (lambda: rewrite_table(
        lambda table: table[f"videos/{TOP}/to_timestamp"][1].__setitem__(1, 1.5)),
     "it has 8 rows, and from 0.9 to 1.5 s", (0, 2)),
    (lambda: rewrite_table(
        lambda table: table[f"videos/{TOP}/from_timestamp"][1].__setitem__(1, 0.95)),
     "it begins at 0.95 s", (0, 2)))


def move(episode, by):
    """Moves its window in the video by this many seconds."""
    def change(table):
        for name in ("from_timestamp", "to_timestamp"):
            table[f"videos/{TOP}/{name}"][1][episode] += by
    return lambda: rewrite_table(change)


def place(begins, ends):
    def change(table):
        table[f"videos/{TOP}/from_timestamp"][1][:] = begins
        table[f"videos/{TOP}/to_timestamp"][1][:] = ends
    return lambda: rewrite_table(change)


# Videos with contradictory windows: a change, and the error for every episode.
NEIGHBOURS = (
    (move(1, -0.3), "episode 0 (9 rows, from 0 to 0.9 s) and episode 1 (8 rows, from 0.6 to 1.4 s) "
                    "overlap"),
    (move(2, 0.2), "episode 1 (8 rows, from 0.9 to 1.7 s) and episode 2 (7 rows, from 1.9 to 2.6 s)"
                   " leave a hole between them"),
    (place([0.1, 1.0, 1.8], [1.0, 1.8, 2.5]),
     "episode 0 (9 rows, from 0.1 to 1 s) is its first, expected one that begins at 0 s"),
    (place([0.8, 0.0, 1.7], [1.7, 0.8, 2.4]),
     "are not in the order of their numbers"),
    (lambda: change("set/meta/info.json", lambda info: info.update(
        video_path="videos/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4")) or shutil.copytree(
            f"set/videos/{TOP}/chunk-000", "set/videos/chunk-000"),
     f"it is the video of two cameras, '{TOP}' and '{WRIST}'"))

# Errors: a change, the code, the text.
INFO = "set/meta/info.json"
ERRORS_21 = (
    (lambda: write(INFO, "{"), "E0850", "is not JSON"),
    (lambda: change(INFO, lambda info: info.update(codebase_version="v1.6")), "E0850",
     "is of the version 'v1.6', expected v2.0, v2.1 or v3.0"),
    (lambda: change(INFO, lambda info: info.pop("fps")), "E0850", "(fps)"),
    (lambda: change(INFO, lambda info: info.update(data_path="../{episode_index}")), "E0850",
     "leads out of its folder"),
    (lambda: change(INFO, lambda info: info.update(video_path="{videos_key}")), "E0850",
     "with the unknown field '{videos_key}'"),
    (lambda: change(INFO, lambda info: info.update(
        video_path="videos/chunk-000/{video_key}/episode_000001.mp4")), "E0854",
     "episode 0 (9 rows, from 0 to 0.9 s) and episode 1 (8 rows, from 0 to 0.8 s) overlap"),
    (lambda: change(INFO, lambda info: info.update(fps=float("nan"))), "E0850", "(fps)"),
    (lambda: (os.remove(INFO), os.mkfifo(INFO)), "E0850", "info.json: is a pipe, expected a file"),
    (lambda: (os.remove("set/meta/episodes.jsonl"), os.mkfifo("set/meta/episodes.jsonl")), "E0850",
     "episodes.jsonl: is a pipe, expected a file"),
    (lambda: (os.remove(INFO), os.symlink("/dev/zero", INFO)), "E0850", "is a device, expected a"),
    (lambda: change(INFO, lambda info: info["features"][TOP].update(dtype="image")), "E0851",
     f"has no column '{TOP}.bytes', expected '{TOP}' as a struct of bytes and path"),
    (lambda: os.remove("set/meta/episodes.jsonl"), "E0850", "episodes.jsonl: no such file"),
    (lambda: write("set/meta/episodes.jsonl", "{}\n"), "E0850", "line 1 is not an object with"),
    (lambda: rewrite_lines(lambda n, line: line.update(length=2.7)), "E0850",
     "line 1 is not an object with episode_index and length, whole numbers"),
    (lambda: rewrite_lines(lambda n, line: line.update(tasks=["pick the cube", None])), "E0850",
     "line 1 has 'null' among its tasks, expected texts"),
    (lambda: change(INFO, lambda info: info.update(chunks_size=2.7)), "E0850",
     "does not say its chunks_size, a whole number from 1"),
    (lambda: rewrite_lines(lambda n, line: line.update(episode_index=0)), "E0850",
     "has episode 0 twice"),
    (lambda: lerobot.video(VIDEO, 6, 1), "E1011", "has only 6 steps, the rows of the episode give"),
    (lambda: lerobot.video(VIDEO, 11, 1), "E1011", "has more than 8 steps"),
    (lambda: write(VIDEO, "no video"), "E1010", "is no video, or a damaged one"))
ERRORS_30 = (
    (lambda: write("set/meta/episodes/chunk-000/file-000.parquet", "PAR1"), "E0851", "is cut"),
    (lambda: rewrite_table(lambda table: table.pop("length")), "E0850", "has no column 'length'"),
    (lambda: rewrite_table(lambda table: table["length"][1].__setitem__(1, None)), "E0850",
     "has a row whose 'length' is no number"),
    (lambda: rewrite_table(lambda table: table.update(length=(
        parquet.DOUBLE, [float(n) + 0.7 * (n == LENGTHS[1]) for n in table["length"][1]]))),
     "E0850", "has a row whose 'length' is 8.7, expected a whole number"),
    (lambda: rewrite_table(lambda table: table["tasks"][1][1].append(None)), "E0850",
     "has a row whose 'tasks' has a task without text"),
    (lambda: write(f"set/videos/{TOP}/chunk-000/file-000.mp4", open(
        f"set/videos/{TOP}/chunk-000/file-000.mp4", "rb").read()[:3000], "wb"), "E1010",
     f"videos/{TOP}/chunk-000/file-000.mp4"))


def check(base, lacking, errors):
    def begin(make):
        shutil.rmtree("set", ignore_errors=True)
        shutil.copytree(base, "set")
        make()

    for make, words, left in lacking:
        begin(make)
        if any(word in (words or "") for word in ("parquet", "lists")):
            said = embed("rows.etl", "--data", "set", status=0)  # faster without frames
        else:
            said = embed("seen.etl", "--data", "set", "--camera", TOP, status=0)
        assert words is None and said == "" or words in said and "[W0850]" in said, (words, said)
        assert sorted(os.listdir("out")) == [f"set-{n:06}.npz" for n in left], (words, said)
    for make, words in NEIGHBOURS if base == "v30" else ():
        begin(make)
        for data in ("set", "set:0", "set:2"):
            said = embed("seen.etl", "--data", data, "--camera", TOP, status=1)
            assert "[W0850]" in said and "[E0854]" in said and words in said, (words, said)
            assert "file-000.mp4" in said and not os.path.exists("out"), said
    for make, code, words in errors:
        begin(make)
        said = embed("seen.etl", "--data", "set", "--camera", TOP, status=1)
        assert f"[{code}]" in said and words in said, (code, words, said)
        left = sorted(os.listdir("out")) if os.path.exists("out") else []
        assert left == [f"set-{n:06}.npz" for n in range(len(left))], (words, left)
        assert len(left) < len(LENGTHS), "all episodes in spite of the error"


def check_calls(base):
    def said(*words, spec="seen.etl", q="f32", rate=10, more="q"):
        write("plain.etl", PLAIN.format(rate, q, more))
        return embed(spec, *words, status=1)

    for found, code, words in (
            (said("--data", base), "E0852", f"has the cameras '{TOP}' and '{WRIST}'; name one"),
            (said("--data", base, "--camera", "front"), "E0852", "has no camera 'front', but"),
            (said("--data", base, "--camera", "y=front"), "E0852", "no input 'y' is by an encoder"),
            (said("--data", f"{base}:7", "--camera", TOP), "E0854", "it has 3 episodes, 0 to 2"),
            (said("--data", base, spec="plain.etl"), "E0804", "no column 'q'; there are 'action'"),
            (said("--data", base, "--map", "q=observation.stat", spec="plain.etl"), "E0804",
             "did you mean 'observation.state'?"),
            (said("--data", base, "--map", f"q={TOP}", spec="plain.etl"), "E0804", "is a camera"),
            (said("--data", base, "--map", "q=note", spec="plain.etl"), "E0808", "holds text"),
            (said("--data", base, "--map", "q=next.success", spec="plain.etl"), "E0808",
             "bool elements"),
            (said("--data", base, "--map", "q=observation.state", spec="plain.etl"), "E0807",
             "has 4 elements in row 0 of the episode, expected 1"),
            (said("--data", base, "--map", "q=action[2]", spec="plain.etl"), "E0807",
             "has 2 elements in row 0 of the episode, expected more than 2"),
            (said("--data", base, "--map", "q=timestamp", spec="plain.etl", rate=4), "E0853",
             "has 10 rows a second, expected a multiple of the 4 steps")):
        assert f"[{code}]" in found and words in found, (code, words, found)
    write("plain.etl", PLAIN.format(10, "f32", "q"))
    os.mkdir("empty")
    for path, words in (
            (f"{base}:-1", f"':-1' chooses no episodes of the data set: '{base}:3' is episode 3, "
                           f"'{base}:0:50' are the episodes 0 to 49"),
            (f"{base}:0-2", f"':0-2' chooses no episodes of the data set: '{base}:3'"),
            (f"{base}:0:2:1", f"':0:2:1' chooses no episodes of the data set: '{base}:3'"),
            (f"{base}:", f"':' chooses no episodes of the data set: '{base}:3'"),
            (f"{base}:2:2", "'2:2' ends before it begins"),
            ("v211", "did you mean the data set 'v21'?"), ("v211:0:2", "the data set 'v21'?"),
            ("empty:0", "'empty' has no meta/info.json and is no data set"),
            *((path, "`hf download --repo-type dataset lerobot/pusht --local-dir FOLDER`")
              for path in ("lerobot/pusht", "lerobot/pusht:0:2", "hf://datasets/lerobot/pusht",
                           "https://huggingface.co/datasets/lerobot/pusht"))):
        for call in (["embed", "seen.etl", "--data", path, "-o", "out", "--encoder-cmd", "true"],
                     ["run", "plain.etl", "--trace", path, "--map", "q=timestamp"],
                     ["evaluate", "plain.etl", "--data", path, "--map", "q=timestamp"]):
            done = subprocess.run([ETLC, *call], capture_output=True, text=True)
            assert done.returncode == 1 and words in done.stderr, (call, words, done.stderr)
    for path, rate, code, words in ((f"{base}:1", 5, "E0853", "makes episodes of one row in 2"),
                                    (f"{base}:3", 10, "E0854", "is not an episode of the data set"),
                                    (base, 10, "E0854", f"name one, '{base}:000000'")):
        write("plain.etl", PLAIN.format(rate, "f32", "q"))
        done = subprocess.run([ETLC, "run", "plain.etl", "--trace", path, "--map", "q=timestamp"],
                              capture_output=True, text=True)
        assert done.returncode == 1, done
        assert f"[{code}]" in done.stderr and words in done.stderr, (words, done.stderr)


def main():
    write("see.py", FIRST_PIXEL)
    write("seen.etl", SEEN)
    write("rows.etl", PLAIN.format(10, "f32", "timestamp").replace("q :", "timestamp :"))
    lerobot.write("v21", "v2.1", LENGTHS)
    lerobot.write("v30", "v3.0", LENGTHS)
    check("v21", LACKING_21, ERRORS_21)
    check("v30", LACKING_30, ERRORS_30)
    check_calls("v21")


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
    os.chdir("/")
