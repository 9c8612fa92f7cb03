#!/usr/bin/env python3
"""watching.py ETLC [SECONDS] [ROUNDS]: what `etlc watch` costs beside decoding and encoding alone,
and how late it is.

In turns: `etlc-embed` decodes a video of 640 x 480 at its own speed, 30 frames a second, and
encodes it, through a pipe; `etlc embed` does, at full speed; `etlc watch` does, without and with a
page that somebody reads. Prints
medians of processor time per frame, without that of the start, and for a page the time from a
frame's decoding to its event, of which the encoder takes a part."""
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.argv[1] = ETLC = os.path.abspath(sys.argv[1])
SECONDS = int(sys.argv[2]) if len(sys.argv) > 2 else 10
ROUNDS = int(sys.argv[3]) if len(sys.argv) > 3 else 3
EMBEDDER = os.path.join(os.path.dirname(ETLC), "etlc-embed")
RATE, SIDE = 30, 112
SPEC = f"""spec look;
rate {RATE} Hz;
encoder net = load("net.onnx"), image [{SIDE}, {SIDE}];
input z : f32[64] by net;
target goal = frames("long.mp4", [10, 20]) by net;
predicate near = min l2(z, goal) <= 1;
monitor reached = F[0, 5 s] near;
sliding monitor now = near;
"""


def network():
    """The network of speed.py, which measures when it is imported."""
    source = (ROOT / "bench" / "embed" / "speed.py").read_text().split("\nwith tempfile")[0]
    names = {"__file__": str(ROOT / "bench" / "embed" / "speed.py")}
    exec(compile(source, "speed.py", "exec"), names)
    names["make_network"]("net.onnx")


def usage_of(process):
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, process.args
    return usage.ru_utime + usage.ru_stime


def alone(video):
    """Decoding at the video's speed, and encoding; the times in front of frames are taken out."""
    decoder = subprocess.Popen([EMBEDDER, "video", video, "--pace", "real", "--rate", str(RATE)],
                               stdout=subprocess.PIPE)
    encoder = subprocess.Popen([EMBEDDER, "encode", "net.onnx"], stdin=subprocess.PIPE,
                               stdout=subprocess.DEVNULL)
    while head := decoder.stdout.read(16):
        size = 3 * int.from_bytes(head[8:12], "little") * int.from_bytes(head[12:], "little")
        encoder.stdin.write(head[8:] + decoder.stdout.read(size))
        encoder.stdin.flush()
    encoder.stdin.close()
    return usage_of(decoder) + usage_of(encoder)


def embed(video):
    """`etlc embed`, which does not wait for the video's speed."""
    shutil.rmtree("episodes", ignore_errors=True)
    return usage_of(subprocess.Popen([ETLC, "embed", "look.etl", "--data", video, "-o", "episodes"],
                                     stdout=subprocess.DEVNULL))


def watch(video):
    return usage_of(subprocess.Popen([ETLC, "watch", "look.etl", "--video", video],
                                     stdout=subprocess.DEVNULL))


def read_events(address, arrivals):
    try:
        with urllib.request.urlopen(address + "events") as events:
            for line in events:
                if line.startswith(b"data: "):
                    step = json.loads(line[6:]).get("step")
                    arrivals[step] = time.monotonic()
    except OSError:
        pass


def watch_with_page(video, arrivals=None):
    process = subprocess.Popen([ETLC, "watch", "look.etl", "--video", video, "--page"],
                               stdout=subprocess.PIPE, text=True)
    address = process.stdout.readline().strip()
    reader = threading.Thread(target=read_events,
                              args=(address, {} if arrivals is None else arrivals))
    reader.start()
    process.stdout.read()
    used = usage_of(process)
    reader.join()
    return used


def make_video(name, seconds):
    subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i",
                    f"testsrc2=size=640x480:rate={RATE}:duration={seconds}", "-c:v", "libx264",
                    "-bf", "0", "-pix_fmt", "yuv420p", name], check=True)


def main():
    network()
    make_video("long.mp4", SECONDS + 1)
    make_video("short.mp4", 1)
    pathlib.Path("look.etl").write_text(SPEC)
    subprocess.run([ETLC, "embed", "look.etl"], check=True, stdout=subprocess.DEVNULL)
    parts = {"alone": alone, "etlc embed": embed, "etlc watch": watch,
             "with a page": watch_with_page}
    taken = {name: [] for name in parts}
    for _ in range(ROUNDS):
        for name, part in parts.items():
            taken[name].append((part("long.mp4") - part("short.mp4")) / (SECONDS * RATE))
    print(f"{SECONDS * RATE} frames, {ROUNDS} rounds, {os.cpu_count()} cores")
    for name, times in taken.items():
        ratio = statistics.median(a / b for a, b in zip(times, taken["alone"]))
        print(f"{name:12} {1000 * statistics.median(times):6.2f} ms of a core a frame, {ratio:.3f} "
              "of decoding and encoding alone")
    arrivals = {}
    watch_with_page("long.mp4", arrivals)
    steps = sorted(step for step in arrivals if step is not None)
    early = min(arrivals[step] - step / RATE for step in steps)
    late = sorted(arrivals[step] - step / RATE - early for step in steps)
    print(f"page: {len(steps)} of {(SECONDS + 1) * RATE} steps; later than the soonest event by "
          f"{1000 * late[len(late) // 2]:.1f} ms (median), "
          f"{1000 * late[len(late) * 95 // 100]:.1f} ms (95th percentile)")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
