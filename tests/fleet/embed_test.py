#!/usr/bin/env python3
"""embed_test.py ETLC: the shards of `etlc embed` write, for any number of shards in any order, the
files of one process, each recording once; with --embedded a spec reads another file."""
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

ETLC = os.path.abspath(sys.argv[1])
SPEC = """
spec look;
encoder net = load("encode.py");
input z : f32[2] by net;
target bay = images("bay") by net;
monitor docked = F min l2(z, bay) <= 1;
"""
ENCODE = """import struct, sys
sys.stdout.buffer.write(struct.pack("<I", 2))
while head := sys.stdin.buffer.read(8):
    height, width = struct.unpack("<II", head)
    pixels = sys.stdin.buffer.read(3 * height * width)
    sys.stdout.buffer.write(struct.pack("<2f", pixels[0], pixels[-1]))
"""
WORDS = ["embed", "look.etl", "--encoder-cmd", "/usr/bin/python3 encode.py"]


def call(*words, status=0):
    done = subprocess.run([ETLC, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def png(path, colour):
    """Writes an image of two pixels."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))

    row = b"\0" + bytes(colour) * 2
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(
        b"IHDR", struct.pack(">IIBBBBB", 2, 1, 8, 2, 0, 0, 0)) + chunk(
            b"IDAT", zlib.compress(row)) + chunk(b"IEND", b""))


def result(folder):
    files = {path.name: path.read_bytes() for path in pathlib.Path(folder).glob("*.npz")}
    return files | {"": pathlib.Path("look.embedded.npz").read_bytes()}


def shards_make_what_one_process_makes():
    pathlib.Path("look.etl").write_text(SPEC)
    pathlib.Path("encode.py").write_text(ENCODE)
    numbers = random.Random(3)
    for number in range(9):
        os.makedirs(f"drives/ep{number}")
        for step in range(3):
            png(f"drives/ep{number}/{step}.png", [numbers.randrange(256) for _ in range(3)])
    os.mkdir("bay")
    png("bay/1.png", (1, 2, 3))
    call(*WORDS, "--data", "drives", "-o", "one")
    one = result("one")
    assert len(one) == 10
    for count in (1, 2, 7, 64):
        os.remove("look.embedded.npz")
        order = list(range(1, count + 1))
        numbers.shuffle(order)
        of_shards = []
        for shard in order:
            shutil.rmtree("own", ignore_errors=True)
            call(*WORDS, "--data", "drives", "-o", "own", "--shard", f"{shard}/{count}")
            made = {path.name for path in pathlib.Path("own").glob("*.npz")}
            of_shards.append(made)
            assert os.path.exists("look.embedded.npz") == (1 in order[: order.index(shard) + 1])
            os.makedirs("many", exist_ok=True)
            for name in made:
                os.rename(f"own/{name}", f"many/{name}")
        assert sum(map(len, of_shards)) == 9 and result("many") == one, (count, of_shards)
        assert count == 1 or max(map(len, of_shards)) < 9, "the recordings are shared out"
        shutil.rmtree("many")
    assert "--data" in call(*WORDS, "--shard", "1/2", status=2)
    assert "3/2" in call(*WORDS, "--data", "drives", "-o", "x", "--shard", "3/2", status=2)


def another_file_is_read():
    os.rename("look.embedded.npz", "elsewhere.npz")
    assert "E1003" in call("look.etl", "-o", "look.hpp", status=1)
    call("look.etl", "-o", "look.hpp", "--embedded", "elsewhere.npz", "--depfile", "look.d")
    assert "elsewhere.npz" in pathlib.Path("look.d").read_text()
    for words in (["run", "look.etl", "--trace", "one/ep1.npz"],
                  ["explain", "look.etl", "--trace", "one/ep1.npz"]):
        assert "E1003" in call(*words, status=1)
        call(*words, "--embedded", "elsewhere.npz")
    call(*WORDS, "--embedded", "third.npz")
    assert not os.path.exists("look.embedded.npz")
    assert pathlib.Path("third.npz").read_bytes() == pathlib.Path("elsewhere.npz").read_bytes()
    png("bay/2.png", (9, 9, 9))
    said = call("look.etl", "-o", "look.hpp", "--embedded", "third.npz", status=1)
    assert "E1004" in said and "third.npz" in said and "bay/2.png is new" in said, said


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    shards_make_what_one_process_makes()
    another_file_is_read()
    os.chdir("/")
