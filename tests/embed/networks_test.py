"""networks_test.py ETLC: a convolutional network and a transformer give the embeddings of plain
loops, to 1e-4 relative, through OpenCV and through a command; each step of the preparation counts;
what OpenCV does not run, or would compute wrongly, is refused by the name of its node."""
import os
import subprocess
import sys
import tempfile

import numpy as np
from networks import DEVIATION, MEAN, Convolutional, Graph, Transformer, prepared, resized
from onnx import TensorProto
from PIL import Image

ETLC = os.path.abspath(sys.argv[1])
COMMAND = os.path.join(os.path.dirname(os.path.abspath(__file__)), "onnx_encoder.py")
TOLERANCE = 1e-4
random = np.random.default_rng(23)


def call(*words, status=0):
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stderr


def spec(path, rows=None, columns=None):
    image = "" if rows is None else f", image [{rows}, {columns}]"
    with open(path, "w") as file:
        file.write(f"""spec t;
encoder net = load("net.onnx"){image}, mean {list(MEAN)}, deviation {list(DEVIATION)};
target bay = images("bay") by net;
input x : f32;
monitor m = F x <= 1;
""")


def difference(rows, expected):
    return max(np.abs(r - e).max() / np.abs(e).max() for r, e in zip(rows, expected))


def command(network):
    """With what is done to a frame, which a command does by itself."""
    words = ["/usr/bin/python3", COMMAND, str(network.rows), str(network.columns)]
    return " ".join(words + [",".join(map(str, numbers)) for numbers in (MEAN, DEVIATION)])


def wrong_preparations(image, rows, columns):
    """What the preparation would be with one step left out or done otherwise."""
    whole = image.astype(float)
    nearest = whole[np.arange(rows) * len(whole) // rows][:, np.arange(columns) *
                                                          whole.shape[1] // columns]
    ready = resized(whole, rows, columns)
    corners = np.stack([np.interp(np.linspace(0, len(whole) - 1, rows), np.arange(len(whole)), c)
                        for c in whole.mean(1).T], 1)
    yield "colours change places", prepared(image[:, :, ::-1], rows, columns)
    yield "red and green change places", prepared(image[:, :, [1, 0, 2]], rows, columns)
    yield "the nearest pixel", (nearest / 255 - MEAN) / DEVIATION
    yield "pixel centres at the corners", (
        (ready + (corners - ready.mean(1))[:, None]) / 255 - MEAN) / DEVIATION
    yield "rows and columns change places", prepared(
        np.ascontiguousarray(image.transpose(1, 0, 2)), rows, columns)
    yield "without 1/255", (ready - MEAN) / DEVIATION
    yield "without mean", ready / 255 / DEVIATION
    yield "without deviation", ready / 255 - MEAN
    yield "deviation first", ready / 255 / DEVIATION - MEAN
    yield "means change places", (ready / 255 - MEAN[::-1]) / DEVIATION
    yield "rounded to bytes", (np.round(ready) / 255 - MEAN) / DEVIATION


def networks_give_what_loops_give():
    os.mkdir("bay")
    images = [random.integers(0, 256, size, dtype=np.uint8) for size in ((32, 32, 3), (45, 61, 3))]
    for i, image in enumerate(images):
        Image.fromarray(image).save(f"bay/{i}.png")
    for kind in (Convolutional, Transformer):
        network = kind("net.onnx", random)
        expected = [network(prepared(image, network.rows, network.columns)) for image in images]
        spec("t.etl", network.rows, network.columns)
        spec("own.etl")  # the size is the model's
        found = {}
        for words in (["t.etl"], ["own.etl"], ["t.etl", "--encoder-cmd", command(network)]):
            call(ETLC, "embed", *words)
            rows = np.load(words[0].replace(".etl", ".embedded.npz"))["rows-1"]
            assert rows.shape == (2, network.dimension), rows.shape
            error = difference(rows, expected)
            assert error <= TOLERANCE, (kind, words, error)
            found[words[0]] = rows
        assert (found["own.etl"] == np.load("own.embedded.npz")["rows-1"]).all()
        for what, wrong in wrong_preparations(images[1], network.rows, network.columns):
            error = difference([rows[1]], [network(wrong)])
            assert error > 10 * TOLERANCE, (kind, what, error)


def refused(*words):
    said = call(ETLC, "embed", "t.etl", status=1)
    for word in ("E1012", *words):
        assert word in said, (word, said)
    assert not os.path.exists("t.embedded.npz")


def tokens(g, width, count):
    """`count` tokens of `width` elements, of an image of 32 x 32."""
    kernel = g.weight(random.normal(0, 0.1, (width, 3, 8, 8)))
    x = g.node("Conv", "x", kernel, kernel_shape=[8, 8], strides=[8, 8])
    return g.node("Transpose", g.node("Reshape", x, g.weight((1, width, count), np.int64)),
                  perm=[0, 2, 1])


def what_opencv_does_not_run_is_named():
    spec("t.etl", 32, 32)
    out = "--encoder-cmd (docs/encoders.md)"
    for kind, make in (
            ("LayerNormalization", lambda g, x: g.node(
                "LayerNormalization", x, g.weight(np.ones(24)), g.weight(np.zeros(24)))),
            ("Expand", lambda g, x: g.node(
                "Expand", g.node("ReduceMean", x, axes=[1, 2]),
                g.weight((1, 16, 24), np.int64))),
            ("Where", lambda g, x: g.node(
                "Where", g.node("Greater", x, g.weight(0)), x, g.node("Neg", x)))):
        g = Graph()
        z = g.node("Flatten", make(g, tokens(g, 24, 16)))
        g.save("net.onnx", [1, 3, 32, 32], z, 384)
        name = next(node.name for node in g.nodes if node.op_type == kind)
        refused(kind, name, out)
    # Runs only where the axes happen to be equally long, and then takes the wrong one.
    for width, shape in ((24, (24,)), (16, (16,)), (16, (1, 1, 16))):
        for kind in ("Add", "Mul"):
            g = Graph()
            x = g.node(kind, tokens(g, width, 16), g.weight(random.normal(size=shape)))
            g.save("net.onnx", [1, 3, 32, 32], g.node("Flatten", x), 16 * width)
            if kind == "Mul" or width == 16:
                refused(f"{kind} '{x}'", "along the wrong axes", out)
    # Fails when it runs: the node is found.
    g = Graph()
    x = g.node("Conv", "x", g.weight(random.normal(0, 0.1, (4, 3, 8, 8))), kernel_shape=[8, 8],
               strides=[8, 8])
    x = g.node("Sub", g.node("ReduceMean", x, axes=[1], keepdims=1), x)
    g.save("net.onnx", [1, 3, 32, 32], g.node("Flatten", x), 64)
    refused(x, out)


def models_of_another_form_are_refused():
    def save(shape, inputs=("x",), element=TensorProto.FLOAT, outputs=1):
        g = Graph()
        x = g.node("Flatten", g.node("Relu", inputs[0]))
        if len(inputs) > 1:
            g.node("Relu", inputs[1])
        g.save("net.onnx", shape, x, 12, inputs, element)

    spec("t.etl")
    save([1, 3, 2, 2], ("x", "y"))
    refused("takes 2 inputs, expected one image: 'x' (1 x 3 x 2 x 2), 'y' (1 x 3 x 2 x 2)")
    save([8, 3, 2, 2])
    refused("takes 'x' of 8 x 3 x 2 x 2, expected float 1 x 3 x rows x columns")
    save([1, 1, 2, 2])
    refused("takes 'x' of 1 x 1 x 2 x 2")
    save([1, 3, 2, 2], element=TensorProto.UINT8)
    refused("not float")
    save([1, 3, "rows", "columns"])
    refused("takes images of any size", "image [224, 224]")
    save([1, 3, 4, 4])
    spec("t.etl", 2, 2)
    refused("takes images of 4 x 4, the spec says image [2, 2]")
    open("net.onnx", "wb").write(random.bytes(300))
    refused("is no ONNX model, or a damaged one")
    save(["batch", 3, 2, 2])  # of any number of images: one at a time
    call(ETLC, "embed", "t.etl")
    assert np.load("t.embedded.npz")["rows-1"].shape == (2, 12)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    networks_give_what_loops_give()
    os.remove("t.embedded.npz")
    what_opencv_does_not_run_is_named()
    models_of_another_form_are_refused()
    os.chdir("/")
