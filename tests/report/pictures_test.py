#!/usr/bin/env python3
"""pictures_test.py ETLC RECORDINGS.MD: from images and a video to a page that shows, at every step,
the frame of the camera and the image of the nearest row of each target. The encoder is that of the
page about encoders."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

from browser import Browser

ETLC = os.path.abspath(sys.argv[1])
PAGE = pathlib.Path(sys.argv[2]).read_text()
CODE = re.search(r"```python\n(import struct.*?)```", PAGE, re.DOTALL).group(1)
SPEC = """
spec look;
rate 10 Hz;
encoder mine = load("encoder.py");
input z : f32[4] by mine;
target bay = images("bay/*.png"), frames("tour.mp4", [19, 0]) by mine;
predicate at_bay = min l2(z, bay) <= 0.3;
monitor docked = F at_bay;
"""
COLOURS = [(0, 200, 0), (200, 0, 0), (0, 0, 200)]
FRAMES = 20


def call(*words):
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, (words, done.stdout, done.stderr)
    return done.stderr


def image(colour):
    return Image.fromarray(np.full((16, 16, 3), colour, np.uint8))


def colour_at(step):
    return COLOURS[step * len(COLOURS) // FRAMES]


def make_files():
    pathlib.Path("encoder.py").write_text(CODE)
    pathlib.Path("look.etl").write_text(SPEC)
    for folder in ("bay", "drives"):
        os.mkdir(folder)
    for number, colour in enumerate(COLOURS[:2]):
        image(colour).save(f"bay/{number}.png")
    for step in range(FRAMES):
        image(colour_at(step)).save(f"{step:03}.png")
    for video in ("tour.mp4", "drives/one.mp4"):
        call("ffmpeg", "-v", "error", "-framerate", "10", "-i", "%03d.png", "-c:v", "libx264",
             "-qp", "0", "-pix_fmt", "yuv444p", video)


def middle(page, selector):
    """Returns the colour in the middle of an image or a canvas."""
    page.wait(f"document.querySelector('{selector}').complete !== false")
    return page.value(f"""(() => {{
        const often = {{willReadFrequently: true}};
        const copy = document.createElement("canvas").getContext("2d", often);
        copy.drawImage(document.querySelector("{selector}"), 0, 0);
        return Array.from(copy.getImageData(8, 8, 1, 1).data).slice(0, 3);
    }})()""")


def is_like(colour, other):
    return np.abs(np.subtract(colour, other)).max() <= 6  # tolerance for the colours of a video


def look(browser):
    page = browser.page("page.html")
    page.wait("view.episode !== null")
    page.wait("sheet !== null")
    rows = set()
    for step in range(FRAMES):
        page.value(f"moveCursor({step})")
        assert page.value("document.getElementById('frame').dataset.step") == str(step)
        assert is_like(middle(page, "#frame"), colour_at(step)), step
        assert is_like(middle(page, "#nearest img"), colour_at(step)), step
        rows.add(page.value("document.querySelector('#nearest figure').dataset.row"))
    assert "2" in rows, rows  # frame 19 of the video, named first, is the only blue one
    assert page.messages == [] and page.requests == [], (page.messages, page.requests)


def look_without_a_target(report):
    """Embeddings are enough for verdicts: only the page misses a deleted video."""
    os.rename("tour.mp4", "gone.mp4")
    said = call(*report, "drives/{episode}.mp4", "-o", "page.html")
    os.rename("gone.mp4", "tour.mp4")
    assert "tour.mp4" in said and "W0840" in said and "without pictures" in said, said


def telling_steps(browser):
    """Of 1000 grey frames the page has those of the samples that decide, and of every change."""
    pathlib.Path("far.etl").write_text("spec far; input x : f32; input held : bool;\n"
                                       "monitor safe = G x >= 0;\nmonitor hold = F held;\n")
    steps = np.arange(1000)
    np.savez("far.npz", x=np.where(steps == 329, -1.0, 1.0 + (steps > 500)),
             held=(steps > 713) & (steps < 777), camera=np.tile(
                 (steps % 251).astype(np.uint8)[:, None, None], (1, 12, 16)))
    said = call(ETLC, "report", "far.etl", "--data", "far.npz", "--no-truths", "--frames", "camera",
                "-o", "far.html")
    assert "W0840" not in said, said
    page = browser.page("far.html")
    page.wait("sheet !== null")
    pictures = page.value("view.row.pictures.steps")
    assert pictures == sorted(pictures) and len(pictures) == 120, pictures
    assert {0, 329, 330, 714, 777, 999} <= set(pictures), pictures
    assert max(np.diff(pictures)) <= 17, pictures  # the others are even
    for step in (0, 329, 330, 714, 777, 999):
        page.value(f"moveCursor({step})")
        assert page.value("document.getElementById('frame').dataset.step") == str(step)
        assert middle(page, "#frame") == [step % 251] * 3, step
    # Pictures that arrive when an episode without timelines is shown are not drawn.
    page.value("""selectEpisode(episodes[0]).then(() => {
        selectEpisode({ ...episodes[0], series: null });
        return new Promise((done) => {
            const image = new Image();
            image.addEventListener("load", done);
            image.src = episodes[0].pictures.files[0];
        });
    }).then(() => 0)""")
    assert page.value("document.getElementById('frame') === null")
    assert page.messages == [], page.messages


def frames_that_do_not_belong():
    """Frames of another length, and those of another data set, are refused."""
    report = [ETLC, "report", "far.etl", "--no-truths", "-o", "no.html", "--data"]
    np.savez("short.npz", **{**np.load("far.npz"), "camera": np.zeros((999, 2, 2), np.uint8)})
    for words, code, said in (
            (["far.npz", "--frames", "x"], "E0841", "has elements of float64, expected uint8"),
            (["far.npz", "--frames", "top"], "E0840", "top"),
            (["short.npz", "--frames", "camera"], "E0840",
             "found 999 pictures, expected 1000, one per step")):
        done = subprocess.run([*report, *words], capture_output=True, text=True)
        assert done.returncode == 1 and f"[{code}]" in done.stderr, (words, done.stderr)
        assert said in done.stderr, (words, done.stderr)


def main():
    make_files()
    call(ETLC, "embed", "look.etl", "--data", "drives/one.mp4", "-o", "episodes",
         "--encoder-cmd", "/usr/bin/python3 encoder.py")
    report = [ETLC, "report", "look.etl", "--data", "episodes/one.npz", "--no-truths", "--frames"]
    said = call(*report, "drives/{episode}.mp4", "-o", "page.html")
    assert "warning" not in said, said
    with Browser() as browser:
        look(browser)
        telling_steps(browser)
    frames_that_do_not_belong()

    look_without_a_target(report)
    call("ffmpeg", "-v", "error", "-y", "-i", "tour.mp4", "-frames:v", "7", "drives/short.mp4")
    done = subprocess.run([*report, "drives/short.mp4", "-o", "short.html"], capture_output=True,
                          text=True)
    assert done.returncode == 1 and "found 7 pictures, expected 20" in done.stderr, done.stderr


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
