"""Demonstrations for tests of void guarantees: one embedding, and arrays with the labels of
predicates."""
import subprocess

import numpy as np

EPISODES, STEPS, D = 10, 12, 8
PREDICATES = "abcde"
CONFORMAL = "<= calibrated(conformal, alpha = 0.25)"
WHOLE = " calibrated(conformal, alpha = 0.25, against = missed_success)"


def codes(text):
    return {word.strip("[]") for word in text.split() if word[:2] in ("[E", "[W")}


class World:
    """Demonstrations of one input z in their own folder, and a spec."""

    def __init__(self, etlc, folder, seed):
        self.etlc, self.folder = etlc, folder
        self.random = np.random.default_rng(seed)
        self.demos = [self.episode() for _ in range(EPISODES)]
        self.others = [self.episode() for _ in range(EPISODES)]
        self.q = self.random.normal(size=(4, D)).astype(np.float32)
        self.p = self.random.normal(size=(3, 4)).astype(np.float32)
        self.line = self.random.normal(size=(1, D)).astype(np.float32)
        self.m = self.random.normal(size=D).astype(np.float32)
        self.w = self.random.normal(size=(5, 2 * D)).astype(np.float32)
        for name, array in (("q", self.q), ("p", self.p), ("l", self.line), ("m", self.m),
                            ("w", self.w)):
            np.save(folder / f"{name}.npy", array)

    def episode(self, steps=STEPS):
        z = self.random.normal(size=(steps, D)).astype(np.float32)
        return z, np.arange(steps) % 3 == 0

    def write(self, part, episodes):
        (self.folder / part).mkdir(exist_ok=True)
        for number, (z, label) in enumerate(episodes):
            np.savez(self.folder / part / f"{number:02}.npz", z=z,
                     **{f"truth.{name}": label for name in PREDICATES})

    def run(self, command, *words):
        done = subprocess.run([self.etlc, command, "t.etl", *words], cwd=self.folder,
                              capture_output=True, text=True)
        assert done.returncode in (0, 1), (command, done.returncode, done.stderr)
        return codes(done.stderr) - {"W0201", "W0671", "W0673", "W0677"}

    def spec(self, text):
        (self.folder / "t.etl").write_text(text)
