#!/usr/bin/env python3
"""resume_test.py ETLC: an episode of `etlc embed` is on disk as soon as it is made. A call that was
killed, or failed, goes on where it stopped and gives the bytes of one call; whatever embeddings are
made from, another content of it is encoded again, and nothing else is."""
import os
import pathlib
import pty
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zipfile

import numpy as np

ETLC = os.path.abspath(sys.argv[1])
SPEC = """
spec look;
encoder net = load("net.onnx");
input z : f32[2] by net;
input charge : f32;
target bay = images("bay") by net;
monitor docked = F (min l2(z, bay) <= 1 && charge > 0);
"""
# It adds a line to the file that $LOG names when it starts, and for each frame. Before frame $HOLD
# it waits until it must have been stopped.
ENCODE = """import os, struct, sys, time
log = open(os.environ["LOG"], "a", buffering=1)
print("start", file=log)
sys.stdout.buffer.write(struct.pack("<I", 2))
sys.stdout.flush()
seen = 0
while head := sys.stdin.buffer.read(8):
    seen += 1
    height, width = struct.unpack("<II", head)
    pixels = sys.stdin.buffer.read(3 * height * width)
    time.sleep(20 if seen == int(os.environ["HOLD"]) else float(os.environ.get("PAUSE", "0")))
    print("frame", file=log)
    sys.stdout.buffer.write(struct.pack("<2f", pixels[0], pixels[-1]))
    sys.stdout.flush()
"""
# In place of etlc-embed, which takes longer to start: the files hold what it would print.
DECODE = """#!/bin/sh
shift
exec cat "$@"
"""
EPISODES, STEPS = 9, 4
TARGETS = 1 + 5  # reference frames too, the first of them twice
PAUSE = "0.004"
numbers = random.Random(20)


def png(path, colour):
    """Writes an image of two pixels, as the decoder below reads it."""
    pathlib.Path(path).write_bytes(struct.pack("<II", 1, 2) + bytes(colour) * 2)


def colour():
    return [numbers.randrange(256) for _ in range(3)]


def make_recordings(folder, count, steps):
    for number in range(count):
        os.makedirs(f"{folder}/ep{number:02}")
        for step in range(steps):
            png(f"{folder}/ep{number:02}/{step}.png", colour())
        rows = "".join(f"{step}\n" for step in range(steps))
        pathlib.Path(f"{folder}/ep{number:02}.csv").write_text("charge\n" + rows)


def words(out, data="drives", spec="look.etl", command="/usr/bin/python3 -IS encode.py"):
    return [ETLC, "embed", spec, "--encoder-cmd", command, "--data", data, "-o", out]


def frames_of_log():
    """Returns the number of frames that encoders got since the last call, without targets, and the
    number of encoders."""
    lines = pathlib.Path("log").read_text().split("\n") if os.path.exists("log") else [""]
    pathlib.Path("log").unlink(missing_ok=True)
    assert lines.pop() == "" and set(lines) <= {"start", "frame"}, lines
    return lines.count("frame") - TARGETS, lines.count("start")


def call(arguments, status=0, **options):
    """Returns its output, and the frames that it had encoded."""
    pathlib.Path("log").unlink(missing_ok=True)
    done = subprocess.run(arguments, capture_output=True, text=True, check=False, **options)
    assert done.returncode == status, (arguments, done.stdout, done.stderr)
    assert "\r" not in done.stderr, "progress is for terminals"
    return done.stdout + done.stderr, frames_of_log()[0]


def content(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir()}


def wait_for_frames(log, frames, running):
    while running.poll() is None:
        if os.path.exists(log) and pathlib.Path(log).read_text().count("frame") >= frames:
            return
        time.sleep(0.001)


def interrupted_calls_go_on():
    """Calls end at any moment; one that ends by itself is a call that was not interrupted."""
    _, frames = call(words("one"))
    whole = content("one")
    assert sorted(whole) == [f"ep{number:02}.npz" for number in range(EPISODES)]
    assert frames == EPISODES * STEPS
    partly = 0
    for moment in range(10):
        shutil.rmtree("many", ignore_errors=True)
        os.environ["LOG"] = f"log{moment}"  # an encoder may outlive etlc for an instant
        os.environ["HOLD"] = "29" if moment == 7 else "0"
        running = subprocess.Popen(words("many"), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        wait_for_frames(f"log{moment}", 4 * moment, running)
        time.sleep(numbers.uniform(0, 0.004))
        if moment % 2 == 0:
            running.kill()
        else:
            os.killpg(running.pid, signal.SIGINT)  # as a terminal does
        running.wait()
        os.environ["LOG"], os.environ["HOLD"] = "log", "0"
        found = content("many") if os.path.exists("many") else {}
        assert found.items() <= whole.items(), "each file is whole"
        partly += 0 < len(found) < EPISODES
        said, frames = call(words("many"))
        assert content("many") == whole
        assert frames == (EPISODES - len(found)) * STEPS, (frames, len(found))
        kept = f", {len(found)} with embeddings of an earlier call\n" if found else "\n"
        assert said.endswith(f"{EPISODES} episodes in many{kept}"), said
    assert partly > 0, "some calls were interrupted between episodes"


def episodes_appear_one_by_one():
    """The encoder waits for the first episode before it goes on with the last frame."""
    pathlib.Path("waits.py").write_text(ENCODE.replace("    print", f"""
    while seen == {TARGETS + EPISODES * STEPS} and not os.path.exists("soon/ep00.npz"):
        time.sleep(0.01)
    print""", 1))
    call(words("soon", command="/usr/bin/python3 -IS waits.py"))


def what_changed_is_encoded_again():
    episodes = 3
    everything = episodes * STEPS
    make_recordings("three", episodes, STEPS)

    def check(frames, what, **options):
        """Compares a call in 'kept' with one in a new folder."""
        shutil.rmtree("fresh", ignore_errors=True)
        assert call(words("fresh", data="three", **options))[1] == everything, what
        assert call(words("kept", data="three", **options))[1] == frames, what
        assert content("kept") == content("fresh"), what

    check(everything, "the first call")
    check(0, "nothing")
    before = os.stat("three/ep00/2.png")
    png("three/ep00/2.png", colour())
    os.utime("three/ep00/2.png", ns=(before.st_atime_ns, before.st_mtime_ns))
    check(STEPS, "an image of the same size and time")
    os.rename("three/ep01/0.png", "other.png")
    os.rename("three/ep01/1.png", "three/ep01/0.png")
    os.rename("other.png", "three/ep01/1.png")
    check(STEPS, "the order of images")
    for one, other in (("three/ep00", "other"), ("three/ep01", "three/ep00"),
                       ("other", "three/ep01")):
        os.rename(one, other)
    check(2 * STEPS, "two recordings with exchanged names")
    pathlib.Path("three/ep02.csv").write_text("charge\n" + "7\n" * STEPS)
    check(0, "a table, which is read again")
    assert (np.load("kept/ep02.npz")["charge"] == 7).all()
    pathlib.Path("look.etl").write_text(SPEC.replace("<= 1", "<= 2"))
    check(0, "the spec, outside of encoders")
    pathlib.Path("look.etl").write_text(SPEC.replace('net.onnx")', 'net.onnx"), image [2, 2]'))
    check(everything, "the transform")
    pathlib.Path("net.onnx").write_text("another model")
    check(everything, "the model")
    pathlib.Path("encode.py").write_text(ENCODE + "# another version\n")
    check(everything, "the script of the encoder")
    check(everything, "the command", command="PAUSE=0 /usr/bin/python3 -IS encode.py")
    check(everything, "the command")

    path = pathlib.Path("kept/ep01.npz")
    whole = path.read_bytes()
    for damaged in (b"", whole[:-9], whole[:99], b"text", whole.replace(b"origins", b"Origins"),
                    pathlib.Path("kept/ep02.npz").read_bytes()):
        path.write_bytes(damaged)
        check(STEPS, f"an episode of {len(damaged)} bytes")
    z = np.load(path)["z"]
    z[0, 0] += 1
    with zipfile.ZipFile(path) as old:
        texts = {name: old.read(name) for name in old.namelist()}
    with zipfile.ZipFile(path, "w") as new:
        for name, text in texts.items():
            new.writestr(name, text if name != "z.npy" else text[:-z.nbytes] + z.tobytes())
    check(STEPS, "another embedding in an episode")
    path.unlink()
    check(STEPS, "an episode that is not there")


def errors_leave_the_episodes_before():
    call(words("all"))
    whole = content("all")
    broken = pathlib.Path("drives/ep06/1.png")
    image = broken.read_bytes()
    table = pathlib.Path("drives/ep06.csv")
    rows = table.read_text()
    for path, text in ((broken, b"no image"), (table, b"charge\n1\n"), (table, b"charge\nx\n")):
        path.write_bytes(text)
        shutil.rmtree("some", ignore_errors=True)
        said, _ = call(words("some"), status=1)
        assert "drives/ep06" in said and said.count("error:") == 1, said
        found = content("some")
        assert sorted(found) <= [f"ep{n:02}.npz" for n in range(9)] and len(found) == 6, found
        assert found.items() <= whole.items(), "those before it"
        broken.write_bytes(image)
        table.write_text(rows)
        assert call(words("some"))[1] == (EPISODES - 6) * STEPS
        assert content("some") == whole
    twice = 'p("<2f", pixels[0], pixels[-1])'.replace("p(", "struct.pack(")
    pathlib.Path("twice.py").write_text(ENCODE.replace(twice, "2 * " + twice))
    said, _ = call(words("twice", command="/usr/bin/python3 -IS twice.py"), status=1)
    assert "wrote more than" in said and not content("twice"), "no embedding is trusted"


def few_descriptors_are_enough():
    make_recordings("hundred", 100, 1)
    limit = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (64, 64))}
    assert call(words("few", data="hundred"), **limit)[1] == 100
    assert len(content("few")) == 100
    assert call(words("few", data="hundred"), **limit)[1] == 0


def arrays_are_hashed_too():
    shown = {"rgb": np.array([[[colour()] * 2]] * 3, np.uint8), "charge": np.ones(3)}
    np.savez("array.npz", **shown)
    arguments = words("arrays", data="array.npz") + ["--camera", "rgb"]
    assert [call(arguments)[1] for _ in range(2)] == [3, 0]
    first = content("arrays")
    shown["rgb"][1] ^= 1
    np.savez("array.npz", **shown)
    assert [call(arguments)[1] for _ in range(2)] == [3, 0]
    assert content("arrays") != first


def progress_is_seen_on_terminals():
    terminal, child = pty.openpty()
    running = subprocess.Popen(words("shown"), stdout=subprocess.DEVNULL, stderr=child,
                               env=os.environ | {"PAUSE": "0.05"})
    os.close(child)
    seen = ""
    try:
        while text := os.read(terminal, 4096):
            seen += text.decode()
    except OSError:  # the other end is closed
        os.close(terminal)
    assert running.wait() == 0 and "\n" not in seen and seen.endswith(" \r"), seen
    assert re.search(rf"\r[1-8] of {EPISODES} episodes, \d+ frames, \d s left", seen), seen


with tempfile.TemporaryDirectory() as place:
    os.chdir(place)
    os.environ |= {"LOG": "log", "PAUSE": PAUSE, "HOLD": "0", "ETLC_EMBEDDER": "./decode.sh"}
    pathlib.Path("decode.sh").write_text(DECODE)
    os.chmod("decode.sh", 0o755)
    pathlib.Path("look.etl").write_text(SPEC)
    pathlib.Path("encode.py").write_text(ENCODE)
    pathlib.Path("net.onnx").write_text("for a command")
    os.mkdir("bay")
    png("bay/1.png", (1, 2, 3))
    make_recordings("drives", EPISODES, STEPS)
    interrupted_calls_go_on()
    episodes_appear_one_by_one()
    what_changed_is_encoded_again()
    errors_leave_the_episodes_before()
    few_descriptors_are_enough()
    arrays_are_hashed_too()
    progress_is_seen_on_terminals()
    os.chdir("/")
