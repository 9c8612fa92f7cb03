#!/usr/bin/env python3
"""speed.py ETLC [FRAMES] [ROUNDS]: the cost of etlc-embed beside its libraries.

In turns: ffmpeg decodes a video of 640 x 480 to rawvideo in /dev/null; etlc-embed decodes it to
/dev/null; etlc-embed encodes frames of the size of a network, which then takes nearly all of the
time, and the frames of the video, both from a file. Prints medians of processor time per frame,
without that of the start, and ratios of speed within a round."""
import os
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "embed"))
import numpy as np  # noqa: E402
from networks import Graph  # noqa: E402

ETLC = os.path.abspath(sys.argv[1])
EMBEDDER = os.path.join(os.path.dirname(ETLC), "etlc-embed")
FRAMES = int(sys.argv[2]) if len(sys.argv) > 2 else 300
ROUNDS = int(sys.argv[3]) if len(sys.argv) > 3 else 5
SIDE, CHANNELS, DIMENSION = 112, 32, 64


def make_network(path):
    """Eight convolutions in four residual blocks: some 10 ms."""
    random, g = np.random.default_rng(1), Graph()

    def conv(x, channels, side, stride):
        kernel = g.weight(random.normal(0, 0.05, (CHANNELS, channels, side, side)))
        return g.node("Conv", x, kernel, g.weight(random.normal(0, 0.1, CHANNELS)),
                      kernel_shape=[side] * 2, strides=[stride] * 2, pads=[side // 2] * 4)

    x = g.node("Relu", conv("x", 3, 7, 2))
    for _ in range(4):
        y = conv(g.node("Relu", conv(x, CHANNELS, 3, 1)), CHANNELS, 3, 1)
        x = g.node("Relu", g.node("Add", x, y))
    pooled = g.node("Flatten", g.node("GlobalAveragePool", x))
    z = g.node("Gemm", pooled, g.weight(random.normal(0, 1, (DIMENSION, CHANNELS))), transB=1)
    g.save(path, [1, 3, SIDE, SIDE], z, DIMENSION)


def cores(*words, source=None):
    """Seconds of all cores, which other work affects less than the clock."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stdin=source)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, words
    return usage.ru_utime + usage.ru_stime


def encode(frames):
    def of(path):
        with open(path, "rb") as source:
            return cores(EMBEDDER, "encode", "net.onnx", source=source)

    return of(frames) - of(os.devnull)


def decode_by_ffmpeg(*options):
    return cores("ffmpeg", "-v", "error", "-i", "v.mp4", *options, "-f", "rawvideo", "-pix_fmt",
                 "rgb24", "-y", "/dev/null")


def main():
    make_network("net.onnx")
    subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i",
                    f"testsrc2=size=640x480:rate=30:duration={FRAMES / 30}", "-c:v", "libx264",
                    "-pix_fmt", "yuv420p", "v.mp4"], check=True)
    with open("frames", "wb") as frames:
        subprocess.run([EMBEDDER, "video", "v.mp4"], check=True, stdout=frames)
    with open("small", "wb") as frames:
        image = np.random.default_rng(2).integers(0, 256, SIDE * SIDE * 3, np.uint8).tobytes()
        frames.write((struct.pack("<II", SIDE, SIDE) + image) * FRAMES)
    one = ["--first", "0", "--count", "1"]
    parts = {  # everything, and the cost of starting
        "ffmpeg": lambda: decode_by_ffmpeg() - decode_by_ffmpeg("-frames:v", "1"),
        "etlc-embed video": lambda: (cores(EMBEDDER, "video", "v.mp4") -
                                     cores(EMBEDDER, "video", "v.mp4", *one)),
        "encode, no resizing": lambda: encode("small"),
        "encode": lambda: encode("frames"),
    }
    taken = {name: [] for name in parts}
    for _ in range(ROUNDS):
        for name, part in parts.items():
            taken[name].append(part())
    print(f"{FRAMES} frames, {ROUNDS} rounds, {os.cpu_count()} cores")
    for name, times in taken.items():
        print(f"{name:19} {1000 * statistics.median(times) / FRAMES:7.3f} ms of a core a frame")

    def speed(of, against):
        return statistics.median(b / a for a, b in zip(taken[of], taken[against]))

    print(f"decoding, of ffmpeg's speed         {speed('etlc-embed video', 'ffmpeg'):.2f}")
    print(f"encoding, of that without resizing  {speed('encode', 'encode, no resizing'):.2f}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
