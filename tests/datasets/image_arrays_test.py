#!/usr/bin/env python3
"""image_arrays_test.py ETLC HDF5: arrays of images in .npz and .h5 files, and GIFs, become episodes
with the embeddings of their pixels; other arrays in the file become the other inputs."""
import os
import re
import subprocess
import sys
import tempfile

import numpy as np

from encoders import CHECKSUMS, checksums

ETLC = os.path.abspath(sys.argv[1])
HDF5 = os.path.abspath(sys.argv[2])
STEPS, ROWS, COLUMNS = 6, 7, 5
SPEC = """spec seen;
encoder see = load("see.py");
input z : f32[2] by see;
target none = [[0, 0]];
{}monitor m = F l2(z, none) <= 1;
"""
OTHERS = """input q : f32[3];
input grip : f32;
target home = [[0, 0, 0]];
monitor n = F (l2(q, home) <= grip);
"""


def embed(*words, spec="others.etl", status=0):
    done = subprocess.run([ETLC, "embed", spec, "-o", "out", "--encoder-cmd",
                           f"{sys.executable} see.py", *words], capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stderr


def check(path, images, q, grip):
    made = np.load(path)
    assert np.array_equal(made["z"], checksums(images)), path
    assert np.array_equal(made["q"], q) and np.array_equal(made["grip"], grip), path


def archives(random):
    images = random.integers(0, 256, (STEPS, ROWS, COLUMNS, 3), dtype=np.uint8)
    other = random.integers(0, 256, (STEPS, ROWS, COLUMNS, 3), dtype=np.uint8)
    q = random.normal(size=(STEPS, 3)).astype(np.float32)
    grip = random.normal(size=STEPS).astype(np.float32)
    os.mkdir("runs")
    np.savez("runs/one.npz", image=images, q=q, grip=grip)
    np.savez_compressed("runs/two.npz", image=images[::-1].copy(), q=q, grip=grip)
    embed("--data", "runs")
    check("out/one.npz", images, q, grip)
    check("out/two.npz", images[::-1], q, grip)
    np.savez("many.npz", image=images, wrist=other, state=q, grip=grip)
    embed("--data", "many.npz", "--camera", "wrist", "--map", "q=state")
    check("out/many.npz", other, q, grip)

    np.savez("floats.npz", image=images / 255, q=q, grip=grip)
    np.savez("grey.npz", image=images[..., 0], q=q, grip=grip)
    np.savez("short.npz", image=images[1:], q=q, grip=grip)
    np.savez("turned.npz", image=np.asfortranarray(images), q=q, grip=grip)
    with open("runs/one.npz", "rb") as whole, open("cut.npz", "wb") as cut:
        cut.write(whole.read()[:900])
    for words, code, said in (
            (["many.npz"], "E0852", "has the arrays of images 'image' and 'wrist'; name one"),
            (["many.npz", "--camera", "top"], "E0852", "top"),
            (["floats.npz"], "E0852", "has no array of images"),
            (["floats.npz", "--camera", "image"], "E0808", "elements of float64, expected uint8"),
            (["grey.npz", "--camera", "image"], "E0807", "has shape (6, 7, 5), expected"),
            (["turned.npz", "--camera", "image"], "E0806", "Fortran order"),
            (["short.npz"], "E0807", "'q' has 6 steps, 'z' has 5"),
            (["cut.npz"], "E0806", "cut.npz")):
        found = embed("--data", *words, status=1)
        assert f"[{code}]" in found and said in found, (code, said, found)


def groups():
    """Files as in robomimic, made by images_hdf5.cpp."""
    subprocess.run([HDF5, "demos.h5"], check=True)
    embed("--data", "demos.h5", "--episodes", "data/*", "--camera", "obs/agentview_image",
          "--map", "q=obs/eef_pos", "grip=actions")
    for demo in range(2):
        step, row, column, channel = np.ogrid[:4, :6, :8, :3]
        images = ((37 * demo + 11 * step + 5 * row + 3 * column + channel) % 256).astype(np.uint8)
        q = np.array([[demo + step + i / 2 for i in range(3)] for step in range(4)])
        check(f"out/demos-demo_{demo}.npz", images, q, np.arange(4) / 4 + demo)
    for words, code, said in (
            (["demos.h5:data/demo_0"], "E0852",
             "has the datasets of images 'obs/agentview_image', 'obs/eye_in_hand_image'; name one"),
            (["demos.h5:data/demo_0", "--camera", "obs/eef_pos"], "E0808", "holds no images"),
            (["demos.h5:data/demo_0", "--camera", "obs/top"], "E0852", "no dataset 'obs/top'"),
            (["demos.h5:data/demo_7", "--camera", "obs/top"], "E0852", "no group 'data/demo_7'")):
        found = embed("--data", *words, "--map", "q=obs/eef_pos", "grip=actions", status=1)
        assert f"[{code}]" in found and said in found, (code, said, found)


def shown():
    """etlc report shows grey images, too, which no encoder gets."""
    report = [ETLC, "report", "plain.etl", "--data", "demos.h5", "--episodes", "data/*", "--map",
              "q=obs/eef_pos", "--no-truths", "-o", "page.html", "--frames"]
    for camera, size in (("obs/agentview_image", (8, 6)), ("obs/grey_image", (24, 6))):
        done = subprocess.run([*report, camera], capture_output=True, text=True)
        assert done.returncode == 0 and "W0840" not in done.stderr, done
        with open("page.html", encoding="utf-8") as page:
            text = page.read()
        found = re.findall(r'"steps":\[([0-9,]+)\],"files":.*?"width":(\d+),"height":(\d+)', text)
        assert found == [("0,1,2,3", str(size[0]), str(size[1]))] * 2, found
    found = embed("--data", "demos.h5", "--episodes", "data/*", "--camera", "obs/grey_image",
                  "--map", "q=obs/eef_pos", "grip=actions", status=1)
    assert "holds no images, expected (steps, rows, columns, 3) of uint8" in found, found


def moving_pictures():
    """A GIF is a video: its frames are those of ffmpeg."""
    def call(*words):
        return subprocess.run(["ffmpeg", "-v", "error", *words], check=True,
                              capture_output=True).stdout

    call("-f", "lavfi", "-i", "testsrc2=size=32x24:rate=10:duration=1", "drive.gif")
    raw = call("-i", "drive.gif", "-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt",
               "rgb24", "-")
    frames = np.frombuffer(raw, np.uint8).reshape(-1, 24, 32, 3)
    embed("--data", "drive.gif", spec="seen.etl")
    assert np.array_equal(np.load("out/drive.npz")["z"], checksums(frames)) and len(frames) == 10


def main():
    plain = "spec plain; input q : f32[3]; target t = [[0, 0, 0]]; monitor m = F l2(q, t) <= 1;"
    for name, text in (("see.py", CHECKSUMS), ("plain.etl", plain), ("seen.etl", SPEC.format("")),
                       ("others.etl", SPEC.format(OTHERS))):
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
    archives(np.random.default_rng(2))
    groups()
    shown()
    moving_pictures()


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
    os.chdir("/")
