"""Compares `logpzo` of `etlc fit` with a flow that is trained like that of FAIL-Detect
(Xu et al., "Can We Detect Failures Without Failure Data?", RSS 2025): x_t = (1 - t) x + t noise,
loss |v(x_t, t) - (noise - x)|^2, score |x + v(x, 0)|^2. The flow has two linear layers for x and
a hidden layer with tanh for t; it does not use the closed form.
Usage: trained_flow_test.py ETLC"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

D = 8
HIDDEN = 32
SPEC = """
spec flow;
rate 10 Hz;
input z : f32[8];
input good : bool;
projection N = fitted(logpzo, of = z, where = holds);
target zero = [[0, 0, 0, 0, 0, 0, 0, 0]] of N(z);
predicate holds = l2sq(N(z), zero) <= calibrated(f1);
truth holds = good;
monitor m = G holds;
"""


def draw(random, count):
    """Frames of success: correlated, with deviations from 0.3 to 2 and a mean that is not 0."""
    mix = np.linalg.qr(random.normal(size=(D, D)))[0] * np.geomspace(0.3, 2, D)
    return random.normal(size=(count, D)) @ mix.T + np.linspace(-1, 1, D)


def forward(p, x, t):
    inner = np.tanh(t @ p["t1"] + p["t0"])
    hidden = x @ p["x1"] + p["x0"]
    return hidden @ p["x2"] + inner @ p["t2"], hidden, inner


def gradients(p, x, t, error):
    """Gradient of half the sum of squared errors."""
    _, hidden, inner = forward(p, x, t)
    back_x = error @ p["x2"].T
    back_t = error @ p["t2"].T * (1 - inner**2)
    return {"x1": x.T @ back_x, "x0": back_x.sum(0), "x2": hidden.T @ error,
            "t1": t.T @ back_t, "t0": back_t.sum(0), "t2": inner.T @ error}


def train(random, frames, steps=3000, batch=512):
    """Adam, with a rate that falls to 0."""
    shapes = {"x1": (D, HIDDEN), "x0": HIDDEN, "x2": (HIDDEN, D), "t1": (1, HIDDEN), "t0": HIDDEN,
              "t2": (HIDDEN, D)}
    p = {name: random.normal(size=shape) / np.sqrt(HIDDEN) for name, shape in shapes.items()}
    first = {name: np.zeros_like(value) for name, value in p.items()}
    second = {name: np.zeros_like(value) for name, value in p.items()}
    for step in range(1, steps + 1):
        x = frames[random.integers(len(frames), size=batch)]
        noise = random.normal(size=x.shape)
        t = random.uniform(size=(batch, 1))
        xt = x + t * (noise - x)
        error = (forward(p, xt, t)[0] - (noise - x)) / batch
        for name, g in gradients(p, xt, t, error).items():
            first[name] = 0.9 * first[name] + 0.1 * g
            second[name] = 0.999 * second[name] + 0.001 * g**2
            slope = first[name] / (1 - 0.9**step)
            slope /= np.sqrt(second[name] / (1 - 0.999**step)) + 1e-12
            p[name] -= 3e-3 * (1 - step / (steps + 1)) * slope
    return p


def fitted(etlc, folder, frames, good):
    spec = folder / "flow.etl"
    spec.write_text(SPEC)
    for i, part in enumerate(np.array_split(np.arange(len(frames)), 10)):
        np.savez(folder / f"{i}.npz", z=frames[part].astype(np.float32),
                 good=good[part].astype(np.float32))
    files = [str(folder / f"{i}.npz") for i in range(10)]
    subprocess.run([etlc, "fit", str(spec), "--data", *files], check=True,
                   stdout=subprocess.DEVNULL)
    return np.load(folder / "flow.fitted.npz")


def main(etlc):
    random = np.random.default_rng(4)
    frames = draw(random, 20_000)
    away = frames[:200] + 6  # a failure, so that the labels have two classes
    p = train(random, frames)
    with tempfile.TemporaryDirectory() as name:
        n = fitted(etlc, pathlib.Path(name), np.concatenate([frames, away]),
                   np.arange(len(frames) + len(away)) < len(frames))
    x = np.concatenate([frames[:1000], frames[:200] + random.normal(size=(200, D))])
    v = forward(p, x, np.zeros((len(x), 1)))[0]
    trained = np.square(x + v).sum(1)
    closed = np.square((x - n["N-offset"]) @ n["N"].T).sum(1)
    correlation = np.corrcoef(trained, closed)[0, 1]
    apart = np.abs(trained - closed).mean() / closed.mean()
    print(f"correlation {correlation:.4f}, mean difference {apart:.3f} of the mean score")
    assert correlation > 0.99, correlation
    assert apart < 0.1, apart


if __name__ == "__main__":
    main(sys.argv[1])
