"""A camera for tests: a named pipe into which grey frames come at their times, `etlc watch` as a
process, and the clock of both."""
import os
import pathlib
import re
import select
import signal
import struct
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
    return subprocess.run([etlc, *words], cwd=folder, capture_output=True, text=True, **more)


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


class Camera:
    """A named pipe into which frames come, each of `frames` at its time: (seconds, level), or
    (seconds, bytes) of another format without a head."""

    def __init__(self, clock, folder, frames, rate=RATE, head=None, frame_of=y4m_frame):
        self.path = os.path.join(folder, "camera")
        os.mkfifo(self.path)
        self.head = y4m_head(rate) if head is None else head
        self.frames = [(seconds, frame_of(level)) for seconds, level in frames]
        self.begun = self.pipe = None
        self.written = 0
        clock.add(self)

    def write(self, now):
        """Writes what has come up to this time; a reader that has gone is no matter."""
        if self.pipe is None:
            try:
                self.pipe = os.open(self.path, os.O_WRONLY | os.O_NONBLOCK)
            except OSError:
                return  # nobody has opened the pipe to read it
            os.set_blocking(self.pipe, True)
            os.write(self.pipe, self.head)
            self.begun = now
        while self.written < len(self.frames) and self.due() <= now:
            try:
                os.write(self.pipe, self.frames[self.written][1])
            except BrokenPipeError:
                self.written = len(self.frames) - 1
            self.written += 1
            if self.written == len(self.frames):
                os.close(self.pipe)

    def due(self):
        """Returns the time of the next frame; 0 before the pipe is read, and after the last."""
        if self.begun is None or self.written == len(self.frames):
            return 0
        return self.begun + self.frames[self.written][0]


class Clock:
    """The clock by which the processes of a test wait, and the times of its camera. It moves on
    when all of them have nothing to do but wait, so a slow machine changes nothing."""

    NUMBERS = 128  # of the file: the time, and those that threads wait for

    def __init__(self, folder):
        self.path = os.path.join(folder, "clock")
        self.now = 1000.0
        self.file = os.open(self.path, os.O_CREAT | os.O_RDWR)
        os.truncate(self.file, 8 * self.NUMBERS)
        self._set()
        self.cameras, self.processes = [], []
        self.lock = threading.RLock()
        self.is_free, self.is_over = True, False
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _set(self):
        os.pwrite(self.file, struct.pack("=q", round(1e9 * self.now)), 0)

    def add(self, camera):
        with self.lock:
            self.cameras.append(camera)

    def start(self, *command, **more):
        """Starts a process that waits by this clock."""
        process = subprocess.Popen(command, env={
            **os.environ, "LD_PRELOAD": os.environ["ETLC_CLOCK_LIBRARY"], "ETLC_CLOCK": self.path},
            **more)
        with self.lock:
            self.processes = [one for one in self.processes if one.poll() is None] + [process]
        return process

    def advance(self, seconds):
        """Moves the clock on, and waits until the processes have nothing left to do."""
        with self.lock:
            end = self.now + seconds
            while self.now < end:
                self.settle()
                numbers = struct.unpack(f"={self.NUMBERS}q", os.pread(self.file, 1024, 0))
                ends = [end, *(one / 1e9 for one in numbers), *(one.due() for one in self.cameras)]
                self.now = min(one for one in ends if one > self.now)
                self._set()
                for camera in self.cameras:
                    camera.write(self.now)
            self.settle()

    def settle(self):
        """Waits until every thread of the processes waits for something: two looks see the same
        counts, so that none ran between them."""
        while (before := self._waits()) is None or before != self._waits():
            time.sleep(0.0005)

    def hold(self):
        """From now on only advance() moves the clock."""
        self.is_free = False
        with self.lock:
            pass

    def _run(self):
        try:
            while not self.is_over:
                if self.is_free and any(one.poll() is None for one in self.processes):
                    self.advance(1 / RATE)
                time.sleep(0.0005)  # for others to take the lock
        except BaseException:
            for process in self.processes:  # their ends are failures of the test, which waits
                process.kill()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.is_over = True
        self.thread.join()
        os.close(self.file)

    def _waits(self):
        """Returns how often each thread has waited; None where one is at work."""
        counts = {}
        todo = [str(process.pid) for process in self.processes if process.poll() is None]
        for process in todo:
            try:
                for thread in os.listdir(f"/proc/{process}/task"):
                    folder = f"/proc/{process}/task/{thread}"
                    status = content(folder + "/status")
                    if status.startswith(b"Name:\tetlc-serve"):  # a browser keeps it at work
                        continue
                    if status[status.index(b"\nState:") + 8:][:1] not in b"SZ":
                        return None
                    counts[thread] = status[status.index(b"\nvoluntary_ctxt"):]
                    todo += content(folder + "/children").decode().split()
            except OSError:
                return None  # it has ended meanwhile
        return counts


def content(path):
    with open(path, "rb", buffering=0) as file:
        return file.read()


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


class Watch:
    def __init__(self, clock, etlc, folder, *words, stdin=None):
        self.process = clock.start(etlc, "watch", "look.etl", *words, cwd=folder, stdin=stdin,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.clock, self.text = clock, ""

    def _read(self):
        piece = os.read(self.process.stdout.fileno(), 1 << 16).decode()
        self.text += piece
        return piece != ""

    def line(self):
        """Waits for the next line, and returns it; "" at the end."""
        while "\n" not in self.text and self._read():
            pass
        line, _, self.text = self.text.partition("\n")
        return line

    def lines_so_far(self):
        """Returns the lines that it has written and that were not read yet."""
        while select.select([self.process.stdout], [], [], 0)[0] and self._read():
            pass
        *lines, self.text = self.text.split("\n")
        return lines

    def lines_until(self, beginning):
        """Reads lines up to the one that begins so, and returns them."""
        lines = []
        while not lines or not lines[-1].startswith(beginning):
            lines.append(self.line())
            assert lines[-1], (lines, self.end())
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
        self.process.stdin.write(text.encode())
        self.process.stdin.flush()

    def stop(self, number=signal.SIGINT):
        self.process.send_signal(number)
        return self.end()

    def end(self):
        """Returns the lines that are left, the messages and the exit status."""
        self.clock.is_free = True
        out, err = self.process.communicate()
        return (self.text + out.decode()).splitlines(), err.decode(), self.process.returncode
