"""etlc label as a process, and the episodes and the table of a test."""
import csv
import io
import pathlib
import subprocess

import numpy as np

HOSTILE = "<img src=x onerror=alert(1)>, \"quoted\" 'ünï' 日本"
SPEC = """
spec stack;
rate 10 Hz;
input z : f32[2];
target goal = [[0, 0]];
target gate = [[3, 0]];
predicate near = min l2(z, goal) <= calibrated(conformal, alpha = 0.1);
predicate passes = min l2(z, gate) <= 1;
monitor arrives = F (near && F passes);
"""
STEPS = 60


def make_episodes(folder, count=6):
    """Episodes that go from 5 to 0: near is true at the end, passes in the middle."""
    random = np.random.default_rng(5)
    folder.mkdir()
    names = [f"ep{number}" for number in range(count - 1)] + [HOSTILE]
    for number, name in enumerate(names):
        x = np.linspace(5, -0.2 * number, STEPS)
        z = np.stack([x, np.zeros(STEPS)], 1) + 0.02 * random.normal(size=(STEPS, 2))
        camera = np.zeros((STEPS, 12, 16, 3), np.uint8)
        camera += 4 * np.arange(STEPS, dtype=np.uint8)[:, None, None, None]
        np.savez(folder / f"{name}.npz", z=z.astype(np.float32), camera=camera)
    return sorted(names)


def rows(path):
    """The rows of a table, without its header; sorted, since their order is free."""
    if not path.exists():
        return []
    return sorted(list(csv.reader(io.StringIO(path.read_text())))[1:])


class Service:
    def __init__(self, etlc, folder, *words):
        self.process = subprocess.Popen([etlc, "label", "stack.etl", "--data", "demos", *words],
                                        cwd=folder, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://127.0.0.1:"), self.address
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.token = self.address.rstrip("/").split("/")[-1]
        self.table = pathlib.Path(folder) / "demos" / "labels.csv"

    def kill(self):
        self.process.kill()
        self.process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.kill()
        self.process.stdout.close()
        self.process.stderr.close()
