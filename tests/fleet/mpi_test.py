#!/usr/bin/env python3
"""mpi_test.py ETLC MPIRUN: two ranks of an MPI job give the results of one process; a killed job
leaves its finished parts, and --resume continues with them."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

ETLC = os.path.abspath(sys.argv[1])
MPIRUN = [sys.argv[2], "--oversubscribe", "-n", "2", ETLC]
SPEC = """
spec fleet;
input z : f32[4];
input x : f32;
target goal = [[0, 0, 0, 0], [1, 0, 0, 0]];
predicate near = min l2(z, goal) <= calibrated(conformal, alpha = 0.2);
truth near = x < 1;
monitor arrives = F near;
"""
EPISODES, STEPS = 48, 6000
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                  OMPI_MCA_btl="self,vader", OMPI_MCA_rmaps_base_oversubscribe="1")


def make_episodes(folder, seed):
    os.mkdir(folder)
    numbers = np.random.default_rng(seed)
    for number in range(EPISODES):
        x = np.cumsum(numbers.normal(0, 0.1, STEPS)) + 1
        z = np.stack([x] * 4, 1) / 2 + numbers.normal(0, 0.1, (STEPS, 4))
        np.savetxt(f"{folder}/{number:02}.csv", np.column_stack([z, x]), "%.7g", ",",
                   header="z[0],z[1],z[2],z[3],x", comments="")


def call(*words, status=0):
    done = subprocess.run(words, capture_output=True, text=True)
    assert (done.returncode == 0) == (status == 0), (words, done.stdout, done.stderr)
    return done.stdout if status == 0 else done.stderr


def same(*words):
    """Two ranks print and write the same as one process; no part is left."""
    printed = call(ETLC, *words)
    one = pathlib.Path("out.json").read_bytes()
    os.remove("out.json")
    assert call(*MPIRUN, *words) == printed
    assert pathlib.Path("out.json").read_bytes() == one and not os.path.exists("etlc.parts")
    return one


def contents_are_only_a_memory(words):
    """Episodes belong to the same ranks wherever the parts are kept."""
    shard = [*words, "--shard", "1/3", "--part", "a.part"]
    call(ETLC, *shard)
    part = pathlib.Path("a.part").read_bytes()
    kept = pathlib.Path("contents")
    os.environ["ETLC_CONTENTS"] = str(kept.absolute())
    for bytes_before in (None, b"", b"damaged", part):
        if bytes_before is not None:
            kept.write_bytes(bytes_before)
        call(ETLC, *shard)
        assert pathlib.Path("a.part").read_bytes() == part
        of_these = kept.read_bytes()
        assert of_these not in (b"", b"damaged", part)
    call(ETLC, *["two" if word == "one" else word for word in shard])
    assert kept.read_bytes() != of_these, "it is of other episodes"
    call(ETLC, *shard)
    assert pathlib.Path("a.part").read_bytes() == part and kept.read_bytes() == of_these
    os.environ["ETLC_CONTENTS"] = str(pathlib.Path("nowhere/contents").absolute())
    call(ETLC, *shard)
    assert pathlib.Path("a.part").read_bytes() == part
    del os.environ["ETLC_CONTENTS"]


def processes_with(word):
    """Processes of this test with this argument."""
    found = []
    for path in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = path.read_bytes().decode(errors="replace").split("\0")
        except OSError:  # it has ended meanwhile
            continue
        of_test = any(os.path.abspath("kept") in one for one in words)
        if of_test and word in words:
            found.append(int(path.parent.name))
    return found


def is_killed(words, parts):
    """Returns whether a job was killed after its first part, and before it had ended."""
    job = subprocess.Popen([*MPIRUN, *words, "--parts", parts.absolute()],
                           stderr=subprocess.DEVNULL)
    while not list(parts.glob("*.part")) and job.poll() is None:
        time.sleep(0.01)
    for process in processes_with("--parts"):  # the ranks, and mpirun
        os.kill(process, signal.SIGKILL)
    status = job.wait()
    while processes_with("--part"):
        time.sleep(0.01)  # processes that a rank started end by themselves
    return status != 0 and len(list(parts.glob("*.part"))) < 32


def killed_and_resumed(words, one):
    parts = pathlib.Path("kept")
    while not is_killed(words, parts):
        shutil.rmtree(parts, ignore_errors=True)
        pathlib.Path("out.json").unlink(missing_ok=True)
    assert not os.path.exists("out.json")
    done = {path: path.stat().st_mtime_ns for path in parts.glob("*.part")}
    refused = call(*MPIRUN, *words, "--parts", "kept", status=1)
    assert "kept: holds parts of another job" in refused, refused
    assert {path: path.stat().st_mtime_ns for path in done} == done
    call(*MPIRUN, *words, "--parts", "kept", "--resume")
    assert pathlib.Path("out.json").read_bytes() == one and not parts.exists()


def main():
    pathlib.Path("fleet.etl").write_text(SPEC)
    make_episodes("one", 1)
    make_episodes("two", 2)
    calibrate = ["calibrate", "fleet.etl", "--data", "one", "-o", "out.json"]
    one = same(*calibrate)
    contents_are_only_a_memory(calibrate)
    os.rename("out.json", "thresholds.json")
    same("evaluate", "fleet.etl", "--thresholds", "thresholds.json", "--data", "two", "--json",
         "out.json")
    os.remove("out.json")
    killed_and_resumed(calibrate, one)
    os.remove("out.json")
    pathlib.Path("one/07.csv").write_text("z[0],z[1],z[2],z[3],x\n1,2,3,4,five\n")
    refused = call(*MPIRUN, *calibrate, status=1)
    assert "one/07.csv:2:9" in refused and not os.path.exists("out.json"), refused


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
