"""A camera for tests: a named pipe into which a thread writes grey frames at its own times, and
`etlc watch` as a process."""
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "embed"))
from networks import Graph  # noqa: E402

WIDTH, HEIGHT = 64, 48
DARK, LIGHT = 20, 200
RATE = 30
SPEC = """spec look;
rate 30 Hz;
encoder net = load("net.onnx"), image [8, 8];
input z : f32[3] by net;
target bright = [[1, 1, 1]];
predicate light = min l2(z, bright) <= 0.8;
monitor lit = F[0, 500 ms] light;
monitor seen = F light;
sliding monitor now = light;
"""


# A command that encodes as the network does; `times`: embeddings for each frame behind the
# reference frames.
ENCODER = """import struct, sys, time
import numpy as np
frames, embeddings = sys.stdin.buffer, sys.stdout.buffer
embeddings.write(struct.pack("<I", 3))
number = 0
while head := frames.read(8):
    height, width = struct.unpack("<II", head)
    pixels = np.frombuffer(frames.read(height * width * 3), np.uint8)
    is_reference = (height, width) == (480, 640)
    if not is_reference: time.sleep({seconds})
    z = pixels.reshape(-1, 3).mean(0) / 255 + {shift}
    for _ in range(1 if is_reference else {times}): embeddings.write(z.astype("<f4").tobytes())
    embeddings.flush()
"""


BY_COMMAND = ("--encoder-cmd", f"'{sys.executable}' encode.py")


def make_encoder(folder, seconds=0.0, shift=0, times=1):
    (pathlib.Path(folder) / "encode.py").write_text(
        ENCODER.format(seconds=seconds, shift=shift, times=times))


def run(etlc, folder, *words, **more):
    return subprocess.run([etlc, *words], cwd=folder, capture_output=True, text=True, timeout=120,
                          **more)


def write_video(folder, levels, rate=RATE):
    (pathlib.Path(folder) / "video.y4m").write_bytes(
        y4m_head(rate) + b"".join(map(y4m_frame, levels)))
    subprocess.run(["ffmpeg", "-y", "-v", "error", "-i", "video.y4m", "-c:v", "libx264", "-bf", "2",
                    "-g", "12", "video.mp4"], cwd=folder, check=True)


def changes_of(lines, name):
    """Returns (step, status) of the lines about a monitor or an input."""
    pattern = re.compile(rf"step (\d+)(?: \(\S+ s\))?: {name} (.*?)(?:, .*)?$")
    return [(int(found[1]), found[2]) for found in map(pattern.match, lines) if found]


def make_network(path):
    """The mean of each colour: three numbers from 0 to 1."""
    graph = Graph()
    mean = graph.node("Flatten", graph.node("GlobalAveragePool", "x"))
    graph.save(path, [1, 3, 8, 8], mean, 3)


def make_project(folder, etlc, spec=SPEC, *words):
    folder = pathlib.Path(folder)
    make_network(str(folder / "net.onnx"))
    (folder / "look.etl").write_text(spec)
    subprocess.run([etlc, "embed", "look.etl", *words], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)


def y4m_head(rate=RATE):
    return f"YUV4MPEG2 W{WIDTH} H{HEIGHT} F{rate}:1 Ip A1:1 C420jpeg\n".encode()


def y4m_frame(level):
    return b"FRAME\n" + bytes([level]) * (WIDTH * HEIGHT) + bytes([128]) * (WIDTH * HEIGHT // 2)


def wait_until(end):
    """Waits for a time without the delays of a long sleep."""
    while (left := end - time.monotonic()) > 0:
        time.sleep(left if left > 0.002 else 0)


class Camera:
    """Writes a frame for each of `frames`, at its time: (seconds, level)."""

    def __init__(self, folder, frames, rate=RATE):
        self.path = os.path.join(folder, "camera")
        os.mkfifo(self.path)
        self.frames, self.rate = frames, rate
        self.begun = None  # when the first frame was written
        self.thread = threading.Thread(target=self._write, daemon=True)
        self.thread.start()

    def _write(self):
        try:
            with open(self.path, "wb", buffering=0) as pipe:
                pipe.write(y4m_head(self.rate))
                self.begun = time.monotonic()
                for seconds, level in self.frames:
                    wait_until(self.begun + seconds)
                    pipe.write(y4m_frame(level))
        except BrokenPipeError:
            pass


def at_rate(levels, rate=RATE, begin=0.0):
    return [(begin + number / rate, level) for number, level in enumerate(levels)]


def blinking(count, longest=7):
    """Dark and light in runs of 1 to `longest` frames, which no regular delay matches."""
    random = np.random.default_rng(3)
    levels, level = [], DARK
    while len(levels) < count:
        levels += [level] * random.integers(1, longest + 1)
        level = DARK + LIGHT - level
    return levels[:count]


def at_last(test, tries=3):
    """Runs a test of times up to three times: another program may delay a frame, whose step then
    has no sample. A fault of etlc fails each time."""
    for left in reversed(range(tries)):
        try:
            return test()
        except AssertionError:
            if left == 0:
                raise


class Watch:
    def __init__(self, etlc, folder, *words, stdin=None):
        self.process = subprocess.Popen([etlc, "watch", "look.etl", *words], cwd=folder,
                                        stdin=stdin, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)

    def line(self):
        return self.process.stdout.readline().rstrip("\n")

    def lines_until(self, beginning):
        """Reads lines up to the one that begins so; returns (time of arrival, line)."""
        lines = []
        while not lines or not lines[-1][1].startswith(beginning):
            line = self.line()
            assert line, (lines, self.end())
            lines.append((time.monotonic(), line))
        return lines

    def lines_containing(self, part):
        """Reads lines up to one that contains this."""
        while part not in (line := self.line()):
            assert line, self.end()

    def child(self, name):
        """The number of the process of this name that it has started."""
        own = self.process.pid
        for child in pathlib.Path(f"/proc/{own}/task/{own}/children").read_text().split():
            if pathlib.Path(f"/proc/{child}/comm").read_text().strip() == name:
                return int(child)
        raise AssertionError(f"no process {name}")

    def write(self, text):
        self.process.stdin.write(text)
        self.process.stdin.flush()

    def stop(self, number=signal.SIGINT):
        self.process.send_signal(number)
        return self.end()

    def end(self):
        """Returns the lines that are left, the messages and the exit status."""
        out, err = self.process.communicate(timeout=120)
        return out.splitlines(), err, self.process.returncode
