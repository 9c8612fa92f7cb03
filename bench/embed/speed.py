#!/usr/bin/env python3
"""speed.py ETLC BENCH_NETWORK [FRAMES] [ROUNDS]: what `etlc embed` takes beside its parts.

In turns: ffmpeg decodes a video of 640 x 480 to rawvideo in /dev/null; etlc-embed decodes it to
/dev/null; a network runs alone, in a loop over one prepared image; etlc-embed encodes the frames
of the video from a file; `etlc embed` does all of it. Prints medians of seconds, and ratios of
speed within a round; the last is against ffmpeg and the network one after the other."""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "embed"))
import numpy as np  # noqa: E402
from networks import Graph  # noqa: E402

ETLC, NETWORK = (os.path.abspath(word) for word in sys.argv[1:3])
EMBEDDER = os.path.join(os.path.dirname(ETLC), "etlc-embed")
FRAMES = int(sys.argv[3]) if len(sys.argv) > 3 else 600
ROUNDS = int(sys.argv[4]) if len(sys.argv) > 4 else 5
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


def seconds(*words, source=None, result=subprocess.DEVNULL):
    begin = time.perf_counter()
    subprocess.run(words, check=True, stdout=result, stdin=source)
    return time.perf_counter() - begin


def encode():
    with open("frames", "rb") as frames:
        return seconds(EMBEDDER, "encode", "net.onnx", source=frames)


def network():
    return float(subprocess.run([NETWORK, "net.onnx", str(SIDE), str(SIDE), str(FRAMES)],
                                check=True, capture_output=True).stdout)


def main():
    make_network("net.onnx")
    subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i",
                    f"testsrc2=size=640x480:rate=30:duration={FRAMES / 30}", "-c:v", "libx264",
                    "-pix_fmt", "yuv420p", "v.mp4"], check=True)
    with open("frames", "wb") as frames:
        seconds(EMBEDDER, "video", "v.mp4", result=frames)
    pathlib.Path("t.etl").write_text(f"""spec t;
encoder net = load("net.onnx");
input z : f32[{DIMENSION}] by net;
target bay = [[{", ".join("0" * DIMENSION)}]];
monitor m = F min l2(z, bay) <= 1;
""")
    parts = {
        "ffmpeg": lambda: seconds("ffmpeg", "-v", "error", "-i", "v.mp4", "-f", "rawvideo",
                                  "-pix_fmt", "rgb24", "-y", "/dev/null"),
        "etlc-embed video": lambda: seconds(EMBEDDER, "video", "v.mp4"),
        "network alone": network,
        "etlc-embed encode": encode,
        "etlc embed": lambda: seconds(ETLC, "embed", "t.etl", "--data", "v.mp4", "-o", "out"),
    }
    taken = {name: [] for name in parts}
    for _ in range(ROUNDS):
        for name, part in parts.items():
            taken[name].append(part())
    median = {name: statistics.median(times) for name, times in taken.items()}
    print(f"{FRAMES} frames, {ROUNDS} rounds, {os.cpu_count()} cores")
    for name, value in median.items():
        print(f"{name:18} {value:8.3f} s  {1000 * value / FRAMES:7.3f} ms a frame")

    def speed(of, against):
        return statistics.median(b / a for a, b in zip(taken[of], against))

    print(f"decoding, of ffmpeg's speed       {speed('etlc-embed video', taken['ffmpeg']):.2f}")
    print("encoding, of the network's speed  "
          f"{speed('etlc-embed encode', taken['network alone']):.2f}")
    both = [a + b for a, b in zip(taken["ffmpeg"], taken["network alone"])]
    print(f"both, of their sum                {speed('etlc embed', both):.2f}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
