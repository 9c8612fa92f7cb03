#!/usr/bin/env python3
"""piped_trace_test.py ETLC: `etlc run --trace -` gives the verdicts of a step as soon as its row
arrives, and in the end the same output as for the file. Named pipes are read where one trace is
expected; elsewhere pipes and devices are refused, and nothing waits for them."""
import os
import pathlib
import subprocess
import sys
import tempfile

ETLC = os.path.abspath(sys.argv[1])
SPEC = "spec t; input x : f32; predicate near = x <= 0.5; monitor m = F near; monitor n = G near;\n"
ROWS = ["x", "1", "", "0.25", "2"]


def main():
    pathlib.Path("t.etl").write_text(SPEC)
    pathlib.Path("t.csv").write_text("".join(row + "\n" for row in ROWS))
    of_file = subprocess.run([ETLC, "run", "t.etl", "--trace", "t.csv"], capture_output=True,
                             check=True, text=True).stdout
    running = subprocess.Popen([ETLC, "run", "t.etl", "--trace", "-"], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    heard = []
    for step, row in enumerate(ROWS, start=-1):
        running.stdin.write(row + "\n")
        running.stdin.flush()
        if step < 0:
            continue
        if step == 0:
            heard.append(running.stdout.readline())  # the head
        for monitor in ("m", "n"):
            heard.append(running.stdout.readline())
            assert heard[-1].startswith(f"{step},{monitor},"), heard
    rest, _ = running.communicate()
    assert running.returncode == 0 and "".join(heard) + rest == of_file, (heard, rest, of_file)

    explain = [ETLC, "explain", "t.etl", "--monitor", "n", "--trace"]
    for words in ([], ["--step", "2"]):
        with open("t.csv", encoding="utf-8") as trace:
            piped = subprocess.run([*explain, "-", *words], stdin=trace, capture_output=True)
        whole = subprocess.run([*explain, "t.csv", *words], capture_output=True)
        assert piped.stdout == whole.stdout and whole.returncode == 0, (piped, whole)
    with open("t.csv", encoding="utf-8") as trace:
        lost = subprocess.run([ETLC, "run", "t.etl", "--trace", "-", "-o", "t.csv"], stdin=trace,
                              capture_output=True, text=True)
    assert lost.returncode == 1 and "as standard input: it would be lost" in lost.stderr, lost

    def refused(text, *words, status):
        done = subprocess.run([ETLC, "run", "t.etl", "--trace", "-", *words], input=text,
                              capture_output=True, text=True)
        assert done.returncode == status, done
        return done.stderr

    assert "standard input:3:1: error" in refused("x\n1\nno\n", status=1)
    assert "standard input: error" in refused("", status=1)
    assert "cannot be standard input" in refused("x\n1\n", "--svg", "t.svg", status=2)


def named_pipes():
    os.mkfifo("p.csv")
    with subprocess.Popen(["sh", "-c", "cat t.csv > p.csv"]):
        piped = subprocess.run([ETLC, "run", "t.etl", "--trace", "p.csv"], capture_output=True)
    whole = subprocess.run([ETLC, "run", "t.etl", "--trace", "t.csv"], capture_output=True)
    assert piped.stdout == whole.stdout and piped.returncode == 0, piped
    for ending in ("npz", "h5", "mp4"):
        os.mkfifo(f"p.{ending}")
        os.symlink("/dev/zero", f"zero.{ending}")
    os.symlink("/dev/zero", "zero.csv")
    calls = [["evaluate", "t.etl", "--data"], ["embed", "t.etl", "-o", "out", "--data"],
             ["run", "t.etl", "--trace"]]
    for words in calls:
        for path in ("p.npz", "p.h5", "p.mp4", "p.csv", "zero.npz", "zero.h5", "zero.csv", "."):
            if path == "p.csv" and "run" in words:
                continue
            done = subprocess.run([ETLC, *words, path], capture_output=True, text=True)
            place = f"{path}:" if path != "." else ": error"  # also among the files of a folder
            assert done.returncode == 1 and place in done.stderr, (words, path, done)
            if "run" not in words and (path != "." or "evaluate" in words):
                assert "expected a file" in done.stderr, (words, path, done)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    named_pipes()
    os.chdir("/")
