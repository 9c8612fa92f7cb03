#!/usr/bin/env python3
"""against_sklearn_test.py ETLC: compares every method of `etlc fit` on one set of episodes with
scikit-learn, or with its definition in numpy; the bytes are the same for any number of threads, and
any names and order of the files. Also compares the figures of monitors as detectors of failures."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

import numpy as np
from sklearn.cluster import KMeans
from sklearn.decomposition import PCA
from sklearn.discriminant_analysis import LinearDiscriminantAnalysis
from sklearn.metrics import balanced_accuracy_score, roc_auc_score

SPEC = """
spec grasp;
input z : f32[12];
input x : f32;
projection Q = fitted(pca, r = 4, of = z, where = true);
projection V = fitted(whitened_pca, r = 3, of = z, where = x <= 0);
projection L = fitted(discriminant, r = 1, of = z, where = holds);
projection N = fitted(logpzo, of = z, where = holds);
target anchors = fitted(medoids, k = 5, away = 4, of = z, where = holds);
target centres = fitted(kmeans, k = 6, of = Q(z), where = true);
target mean = fitted(mean, of = V(z), where = holds);
target zero = [[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]] of N(z);
predicate holds = min l2(z, anchors) <= calibrated(conformal, alpha = 0.1);
predicate along = min l2(L(z), anchors) <= 1;
predicate near = min mahalanobis(fitted(discriminant, of = z, where = holds))(z, anchors) <= 4;
predicate known = min l2(Q(z), centres) <= 1;
predicate white = min l2(V(z), mean) <= 1;
predicate usual = min l2sq(N(z), zero) <= 1;
truth holds = x <= 0;
monitor m = F (holds && along && near && known && white && usual);
"""
METRIC = "fitted(discriminant, of = z, where = holds)"


def make_episodes(folder, random):
    """Drifting frames, shifted where the predicate holds; a few of them missing."""
    mix = random.normal(size=(3, 12)) * 2
    shift = random.normal(size=12) * 1.5
    episodes = []
    for number in range(12):
        steps = 150 + 10 * number
        x = np.cumsum(random.normal(size=steps) * 0.3) + random.normal()
        drift = np.cumsum(random.normal(size=(steps, 3)), 0) * 0.2
        z = random.normal(size=(steps, 12)) + drift @ mix + np.outer(x <= 0, shift)
        z = z.astype(np.float32)
        z[number] = np.nan
        np.savez(folder / f"{number:02}.npz", z=z, x=x)
        episodes.append((z, x))
    return episodes


def close(found, expected, tolerance, what):
    error = np.abs(found - expected).max() / np.abs(expected).max()
    assert error <= tolerance, f"{what}: off by {error:.2g}, at most {tolerance} is allowed"


def same_up_to_sign(found, expected, what):
    for row, (a, b) in enumerate(zip(found, expected)):
        close(a * np.sign(a @ b), b, 1e-4, f"{what}, row {row}")


def check_projections(fitted, frames, holds, shrinkage):
    pca = PCA(4, svd_solver="full").fit(frames)
    same_up_to_sign(fitted["Q"], pca.components_, "pca")
    close(fitted["Q-offset"], pca.mean_, 1e-5, "mean of pca")
    whitened = PCA(3, svd_solver="full", whiten=True).fit(frames[holds])
    rows = whitened.components_ / np.sqrt(whitened.explained_variance_)[:, None]
    same_up_to_sign(fitted["V"], rows, "whitened_pca")

    lda = LinearDiscriminantAnalysis(solver="lsqr", shrinkage=shrinkage, store_covariance=True)
    lda.fit(frames, holds)
    direction = fitted["L"][0] / np.linalg.norm(fitted["L"][0])
    close(direction, lda.coef_[0] / np.linalg.norm(lda.coef_), 1e-4, "discriminant")
    close(fitted["L"] @ lda.covariance_ @ fitted["L"].T, np.ones((1, 1)), 1e-4, "its unit")
    close(fitted["metric-1"], np.linalg.inv(lda.covariance_), 1e-4, "metric")

    s = np.cov(frames[holds].T)
    one = np.eye(12)
    close(fitted["N"], (2.5 * one - 0.5 * s) @ np.linalg.inv(one + s), 1e-4, "logpzo")
    close(fitted["N-offset"], frames[holds].mean(0), 1e-5, "mean of logpzo")


def check_targets(fitted, entries, frames, holds, episodes):
    mean = fitted["V"].astype(float) @ (frames[holds].mean(0) - fitted["V-offset"])
    close(fitted["mean"][0], mean, 1e-4, "mean")

    points = (frames - fitted["Q-offset"]) @ fitted["Q"].T.astype(float)
    squared = ((points[:, None] - fitted["centres"][None]) ** 2).sum(2).min(1).sum()
    best = KMeans(6, n_init=10, random_state=0).fit(points).inertia_
    assert squared <= 1.02 * best, f"kmeans: {squared / best:.4f} times the objective of sklearn"

    assert len(set(entries["episodes"])) == len(episodes)
    known = {}  # the hash identifies the episode
    for row, medoid in zip(fitted["anchors"], entries["entries"]["anchors"]["medoids"]):
        step = medoid["step"]
        (found,) = [
            i for i, (z, _) in enumerate(episodes) if len(z) > step and (z[step] == row).all()
        ]
        assert medoid["episode"] in entries["episodes"]
        assert known.setdefault(medoid["episode"], found) == found, "one hash, one episode"
        assert list(known.values()).count(found) == 1, "one episode, one hash"
        z, x = episodes[found]
        around = x[max(0, step - 4) : step + 5]
        assert (around <= 0).all(), f"a medoid is 4 steps away from a change: {around}"


def check_outcomes(etlc, folder, random):
    """Compares 40 thresholds on a score as detectors of 30 failures among 70 episodes."""
    limits = np.round(np.linspace(0.5, 4, 40), 2)
    spec = "spec alarms; rate 10 Hz; input x : f32;\n" + "".join(
        f"monitor m{k} = G x <= {limit};\n" for k, limit in enumerate(limits))
    (folder / "alarms.etl").write_text(spec)
    fails = np.arange(70) < 30
    paths, scores = [], []
    for number, failed in enumerate(fails):
        x = np.float32(np.round(np.abs(random.normal(size=40)) + failed * np.arange(40) / 20, 2))
        path = folder / ("failure" if failed else "success") / f"{number}.csv"
        path.parent.mkdir(exist_ok=True)
        path.write_text("x\n" + "\n".join(map(str, x)) + "\n")
        paths.append(str(path))
        scores.append(x)
    scores = np.array(scores)
    call = [etlc, "evaluate", "alarms.etl", "--label-by", "folder", "--json", "f.json", "--data"]
    subprocess.run(call + paths, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    found = json.loads((folder / "f.json").read_text())["monitors"]
    for k, limit in enumerate(limits):
        one = found[f"m{k}"]["outcomes"]
        beyond = scores > np.float32(limit)
        alarms = beyond.any(1)
        assert one["successes"] == 40 and one["failures"] == 30, one
        assert one["false_alarms"] == alarms[~fails].sum(), (k, one)
        assert one["detected"] == alarms[fails].sum(), (k, one)
        values = {name: one[name] for name in ("balanced_accuracy", "auroc")}
        close(values["balanced_accuracy"], balanced_accuracy_score(fails, alarms), 1e-12, k)
        close(values["auroc"], roc_auc_score(fails, scores.max(1) - np.float32(limit)), 1e-12, k)
        warnings = 39 - beyond.argmax(1)[fails & alarms]
        for q, name in ((0.25, "lower_quartile"), (0.5, "median"), (0.75, "upper_quartile")):
            expected = np.quantile(warnings, q, method="inverted_cdf") if len(warnings) else None
            assert one[f"warning_{name}_steps"] == expected, (k, name, one)


def main(etlc):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "demos").mkdir()
        (folder / "grasp.etl").write_text(SPEC)
        episodes = make_episodes(folder / "demos", np.random.default_rng(3))

        def fit(output, *options, data=("demos",)):
            call = [etlc, "fit", "grasp.etl", "--data", *data, "-o", output, *options]
            return subprocess.run(
                call, cwd=folder, check=True, stdout=subprocess.PIPE, text=True
            ).stdout

        report = fit("grasp.fitted.npz", "-j", "1")
        assert fit("two.npz", "-j", "2") == report
        one, two = ((folder / n).read_bytes() for n in ("grasp.fitted.npz", "two.npz"))
        assert one == two, "the same bytes for 1 and 2 threads"
        shuffled = [str(path.relative_to(folder)) for path in (folder / "demos").iterdir()]
        shuffled.sort(key=lambda path: path[::-1])
        for number, path in enumerate(shuffled):  # and under other names
            (folder / path).rename(folder / f"{number:03}.npz")
        names = [f"{number:03}.npz" for number in range(len(shuffled))]
        for data in (names, names[::-1]):
            fit("other.npz", data=data)
            assert (folder / "other.npz").read_bytes() == one, "the content alone counts"

        frames = np.concatenate([z for z, _ in episodes]).astype(float)
        holds = np.concatenate([x <= 0 for _, x in episodes])
        there = np.isfinite(frames).all(1)
        frames, holds = frames[there], holds[there]
        shrinkage = float(re.search(r"shrinkage ([\d.e-]+),", report).group(1))
        fitted = np.load(folder / "grasp.fitted.npz")
        with zipfile.ZipFile(folder / "grasp.fitted.npz") as archive:
            entries = json.loads(archive.read("fitted.json"))
        assert entries["entries"][METRIC]["array"] == "metric-1"
        assert entries["entries"]["Q"]["frames"] == len(frames)
        assert "12 frames left out: the point is missing" in report
        check_projections(fitted, frames, holds, shrinkage)
        check_targets(fitted, entries, frames, holds, episodes)
        check_outcomes(etlc, folder, np.random.default_rng(4))


main(sys.argv[1])
