#!/usr/bin/env python3
"""frames_test.py ETLC DATASETS_FOLDER: the frames that `etlc label` shows, from videos, images and
a data set, are those of ffmpeg at every step, in any order; a spec with fitted targets learns."""
import io
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import urllib.error
import urllib.request

import numpy as np
from PIL import Image

from service import Service

sys.path.insert(0, sys.argv[2])
import lerobot  # noqa: E402

ETLC = sys.argv[1]
STEPS = 90
JUMPS = [0, 1, 2, 80, 79, 60, 3, 89, 88, 0, 40]
SPEC = """
spec stack;
rate 10 Hz;
input z : f32[4];
target places = fitted(medoids, k = 2, of = z, where = near);
predicate near = min l2(z, places) <= calibrated(f1);
monitor arrives = F near;
"""


def frame(service, episode, step):
    """Returns the picture, or the message in place of it."""
    try:
        with urllib.request.urlopen(f"{service.address}frame/{episode}/{step}") as answer:
            return np.asarray(Image.open(io.BytesIO(answer.read())).convert("RGB"))
    except urllib.error.HTTPError as error:
        assert error.code == 404, error
        return error.read().decode()


def make_episodes(folder, names):
    random = np.random.default_rng(2)
    folder.mkdir()
    for name in names:
        near = np.arange(STEPS) >= STEPS // 2
        z = random.normal(size=(STEPS, 4)) * 0.3 + 2 * near[:, None]
        np.savez(folder / f"{name}.npz", z=z.astype(np.float32))


def videos(folder):
    """A video of 20 frames a second has two for each step; seeking counts them right."""
    film = folder / "films" / "one.mp4"
    film.parent.mkdir()
    made = f"testsrc2=size=64x48:rate=20,trim=end_frame={2 * STEPS}"
    lerobot.call("ffmpeg", "-v", "error", "-f", "lavfi", "-i", made, "-pix_fmt", "yuv420p", "-c:v",
                 "libx264", "-g", "12", str(film))
    frames = lerobot.raw_frames(str(film))[::2]
    with Service(ETLC, folder, "--frames", "films/{episode}.mp4") as service:
        for step in JUMPS:
            assert (frame(service, 0, step) == frames[step]).all(), step
        assert "found 0 pictures" in frame(service, 1, 0)
        for change in (-1, 1):
            lerobot.call("ffmpeg", "-v", "error", "-f", "lavfi", "-i", made.replace(
                str(2 * STEPS), str(2 * (STEPS + change))), "-pix_fmt", "yuv420p", "-c:v",
                "libx264", "-g", "12", str(folder / "films" / "two.mp4"))
            word = "fewer" if change < 0 else "more"
            said = f"two.mp4: found {word} than {STEPS} pictures, expected {STEPS}, one per step"
            assert said in frame(service, 1, 0), frame(service, 1, 0)
            (folder / "films" / "two.mp4").unlink()
            assert (frame(service, 0, 0) == frames[0]).all()
            assert "found 0 pictures" in frame(service, 1, 0)
        film.rename(folder / "gone.mp4")
        assert "found 0 pictures" in frame(service, 0, 50)
        (folder / "gone.mp4").rename(film)
        assert (frame(service, 0, 50) == frames[50]).all()
        film.write_bytes(film.read_bytes()[:9000])
        assert "one.mp4" in frame(service, 1, 0) or "found" in frame(service, 1, 0)
        assert "one.mp4: " in frame(service, 0, 0)


def images(folder):
    (folder / "images" / "one").mkdir(parents=True)
    for step in range(STEPS):
        Image.new("RGB", (4, 4), (2 * step, 0, 0)).save(folder / f"images/one/{step:03}.png")
    with Service(ETLC, folder, "--frames", "images/{episode}/*.png") as service:
        for step in JUMPS:
            assert frame(service, 0, step)[0, 0, 0] == 2 * step, step
        (folder / "images" / "one" / "007.png").unlink()
        assert "found 89 pictures, expected 90" in frame(service, 0, 3)


def data_set(folder):
    """Episodes that etlc embed names after a data set show the frames of its cameras."""
    lengths = (30, 20, STEPS)
    lerobot.write(str(folder / "pick"), "v3.0", lengths)
    camera = lerobot.CAMERAS[1]
    shutil.copy(folder / "demos" / "one.npz", folder / "demos" / "pick-000002.npz")
    with Service(ETLC, folder, "--frames", "pick", "--camera", camera) as service:
        frames = lerobot.frames_of(str(folder / "pick"), "v3.0", lengths, 2, camera)
        for step in JUMPS:
            assert (frame(service, 1, step) == frames[step]).all(), step
        assert isinstance(frame(service, 0, 0), str)
    with Service(ETLC, folder, "--frames", "pick") as service:
        assert "observation.images.top" in frame(service, 1, 0)
    (folder / "plain.etl").write_text("spec plain; rate 10 Hz; input z : f32[4];\n"
                                      "target t = [[0, 0, 0, 0]]; monitor m = F l2(z, t) <= 1;")

    def report(name):
        return subprocess.run([ETLC, "report", "plain.etl", "--data", f"demos/{name}.npz",
                               "--frames", "pick", "--camera", camera, "--no-truths", "-o",
                               "page.html"], cwd=folder, capture_output=True, text=True)

    assert report("pick-000002").returncode == 0
    assert "data:image/png" in (folder / "page.html").read_text()
    # Neither frames of an episode of another length, nor of another data set.
    for name, said in (("pick-000001", "found 20 pictures, expected 90, one per step"),
                       ("pick-000007", "is not an episode of the data set"),
                       ("place-000002", "is named after another data set than pick: "
                        "expected pick-000002")):
        (folder / "demos" / "pick-000002.npz").rename(folder / "demos" / f"{name}.npz")
        with Service(ETLC, folder, "--frames", "pick", "--camera", camera) as service:
            assert said in frame(service, 1, 0), frame(service, 1, 0)
        done = report(name)
        assert done.returncode == 1 and "[E0840]" in done.stderr and said in done.stderr, done
        (folder / "demos" / f"{name}.npz").rename(folder / "demos" / "pick-000002.npz")
    (folder / "demos" / "pick-000002.npz").unlink()


def grey_arrays(folder):
    """Arrays of grey frames are shown, and those of another length are not."""
    grey = np.arange(STEPS, dtype=np.uint8)[:, None, None] + np.zeros((1, 6, 8), np.uint8)
    for name, camera in (("one", grey), ("two", grey[1:])):
        made = dict(np.load(folder / "demos" / f"{name}.npz"))
        np.savez(folder / "demos" / f"{name}.npz", **made, grey=camera)
    with Service(ETLC, folder, "--frames", "grey") as service:
        for step in JUMPS:
            assert (frame(service, 0, step) == step).all(), step
        assert f"found {STEPS - 1} pictures, expected {STEPS}" in frame(service, 1, 0)


def fitted(folder):
    names = [f"run{number}" for number in range(6)]
    make_episodes(folder / "runs", names)
    table = "episode,predicate,start,end\n"
    (folder / "runs" / "labels.csv").write_text(
        table + "".join(f"{name},near,{STEPS // 2},\n" for name in names[:3]))
    done = subprocess.run([ETLC, "label", "stack.etl", "--data", "runs", "--proposals"],
                          cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done
    found = json.loads(done.stdout)["proposals"]
    assert sorted(one["name"] for one in found) == names[3:], found
    for one in found:
        assert one["predicates"]["near"] == [[STEPS // 2, STEPS, 1]], one
        assert 0 <= one["doubt"] < 0.1, one
    assert not list(folder.glob("*.fitted.npz"))


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "stack.etl").write_text(SPEC)
        make_episodes(folder / "demos", ("one", "two"))
        fitted(folder)
        videos(folder)
        images(folder)
        data_set(folder)
        grey_arrays(folder)


main()
