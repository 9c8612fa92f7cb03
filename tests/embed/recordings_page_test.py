#!/usr/bin/env python3
"""recordings_page_test.py ETLC RECORDINGS.MD: the spec and the three commands of that page lead
from images and videos to verdicts that agree with the labels. A table beside a recording that
does not match it is refused."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper
from PIL import Image

ETLC = os.path.abspath(sys.argv[1])
PAGE = pathlib.Path(sys.argv[2]).read_text().partition("## Data sets")[0]
SPEC = re.search(r"```\n(spec look;.*?)```", PAGE, re.DOTALL).group(1)
KEEPING = re.search(r"```python\n(import zipfile.*?)```", PAGE, re.DOTALL).group(1)
COMMANDS = re.findall(r"^    (etlc .*)$", PAGE, re.MULTILINE)
SIDE, DIMENSION, PATCH, FRAMES, DEMOS = 224, 384, 32, 20, 12
random = np.random.default_rng(11)


def make_network():
    """A convolution, its mean over the image, and a linear map."""
    weights = {"w": random.normal(0, 0.02, (8, 3, PATCH, PATCH)),
               "m": random.normal(0, 0.5, (DIMENSION, 8))}
    graph = helper.make_graph(
        [helper.make_node("Conv", ["x", "w"], ["a"], strides=[PATCH, PATCH]),
         helper.make_node("GlobalAveragePool", ["a"], ["b"]),
         helper.make_node("Flatten", ["b"], ["c"]),
         helper.make_node("Gemm", ["c", "m"], ["z"], transB=1)], "net",
        [helper.make_tensor_value_info("x", TensorProto.FLOAT, [1, 3, SIDE, SIDE])],
        [helper.make_tensor_value_info("z", TensorProto.FLOAT, [1, DIMENSION])],
        [numpy_helper.from_array(value.astype(np.float32), name)
         for name, value in weights.items()])
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)])
    model.ir_version = 7
    onnx.save(model, "net.onnx")


def image(is_bay):
    """A bay is green, everything else has another colour; no two images are equal."""
    colour = (20, 220, 20) if is_bay else (220, random.integers(0, 120), random.integers(0, 200))
    noise = random.integers(-15, 16, (32, 32, 3))
    return Image.fromarray(np.clip(np.array(colour) + noise, 0, 255).astype(np.uint8))


def call(*words, status=0):
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def video(path, at_bay):
    with tempfile.TemporaryDirectory() as frames:
        for step, is_bay in enumerate(at_bay):
            image(is_bay).save(f"{frames}/{step:03}.png")
        call("ffmpeg", "-v", "error", "-framerate", "10", "-i", f"{frames}/%03d.png", "-c:v",
             "libx264", "-pix_fmt", "yuv420p", "-crf", "10", path)


def main():
    make_network()
    pathlib.Path("look.etl").write_text(SPEC)
    os.mkdir("bay")
    os.mkdir("demos")
    for number in range(3):
        image(True).save(f"bay/{number}.png")
    video("tour.mp4", [True] * FRAMES)
    for number in range(1, DEMOS + 1):
        at_bay = np.arange(FRAMES) >= number
        video(f"demos/ep{number}.mp4", at_bay)
        rows = "".join(f"{int(is_so)}\n" for is_so in at_bay[:-1])
        pathlib.Path(f"demos/ep{number}.csv").write_text(f"truth.at_bay\n{rows}\"\"\n")
    first = 13
    video("today.mp4", np.arange(FRAMES) >= first)

    os.environ["PATH"] = os.path.dirname(ETLC) + ":" + os.environ["PATH"]
    assert [command.split()[1] for command in COMMANDS] == ["embed", "calibrate", "run", "embed"]
    said = [call("bash", "-c", command) for command in COMMANDS]
    assert f"labels: {sum(FRAMES - 1 - n for n in range(1, DEMOS + 1))} frames positive" in said[1]
    assert f"docked: satisfied for good from step {first} " in said[2], said[2]
    assert sorted(os.listdir("references")) == [f"reference-{i}.png" for i in range(4)]
    labels = np.load("episodes/ep4.npz")["truth.at_bay"]
    assert labels[:-1].tolist() == [step >= 4 for step in range(FRAMES - 1)], labels
    assert np.isnan(labels[-1]), "an empty cell is missing"

    # Files of numpy do not record the encoder, unless saved as shown on the page.
    unmarked = "changed.npz: warning: does not say which encoder made its embeddings"
    with np.load("episodes/ep1.npz") as episode:
        np.savez("changed.npz", **episode)
    assert unmarked in call(ETLC, "run", "look.etl", "--trace", "changed.npz", "--summary")
    call(ETLC, "run", "look.etl", "--trace", "changed.npz", "--summary", "-Werror", status=1)
    exec(KEEPING)  # pylint: disable=exec-used
    kept = call(ETLC, "run", "look.etl", "--trace", "changed.npz", "--summary", "-Werror")
    assert kept == call(ETLC, "run", "look.etl", "--trace", "episodes/ep1.npz", "--summary"), kept

    for table, fault in (("truth.at_bay\n1\n0\n", "'truth.at_bay' has 2 steps, 'z' has 20"),
                         ("z[0]\n" + "1\n" * FRAMES, "has a column 'z', which 'net' makes"),
                         ("truth.at_bay\nyes\n", "E08"), ("q[0],q[7]\n1,2\n", "E08")):
        pathlib.Path("demos/ep4.csv").write_text(table)
        before = pathlib.Path("episodes/ep4.npz").read_bytes()
        refused = call("bash", "-c", COMMANDS[0], status=1)
        assert "demos/ep4.csv" in refused and fault in refused, refused
        assert pathlib.Path("episodes/ep4.npz").read_bytes() == before, "an episode was replaced"


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
