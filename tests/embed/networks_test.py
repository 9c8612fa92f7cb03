"""networks_test.py ETLC RUNTIME: a convolutional network and transformers give the embeddings of
plain loops, to 1e-4 relative, by opencv or onnxruntime and by a command; each step of the
preparation counts; what is not run, or would be computed wrongly, is refused by the name of its
node."""
import os
import subprocess
import sys
import tempfile

import numpy as np
import onnx
from networks import DEVIATION, MEAN, Convolutional, Exported, Graph, Transformer
from networks import prepared, resized
from onnx import TensorProto, helper, numpy_helper
from PIL import Image

ETLC, RUNTIME = os.path.abspath(sys.argv[1]), sys.argv[2]
BY_RUNTIME = ["--runtime", RUNTIME]
COMMAND = os.path.join(os.path.dirname(os.path.abspath(__file__)), "onnx_encoder.py")
TOLERANCE = 1e-4
random = np.random.default_rng(23)


def call(*words, status=0):
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    assert status != 0 or done.stderr == "", done.stderr
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
    for kind in (Convolutional, Transformer, Exported):
        network = kind("net.onnx", random)
        expected = [network(prepared(image, network.rows, network.columns)) for image in images]
        spec("t.etl", network.rows, network.columns)
        spec("own.etl")  # the size is the model's
        ways = [["t.etl", "--encoder-cmd", command(network)]]
        if kind is not Exported or RUNTIME != "opencv":
            ways += [["own.etl", *BY_RUNTIME], ["t.etl", *BY_RUNTIME]]
        found = []
        for words in ways:
            call(ETLC, "embed", *words)
            rows = np.load(words[0].replace(".etl", ".embedded.npz"))["rows-1"]
            assert rows.shape == (2, network.dimension), rows.shape
            error = difference(rows, expected)
            assert error <= TOLERANCE, (kind, words, error)
            found.append(rows)
        assert len(found) < 3 or (found[1] == found[2]).all(), "the same bits each time"
        for what, wrong in wrong_preparations(images[1], network.rows, network.columns):
            error = difference([rows[1]], [network(wrong)])
            assert error > 10 * TOLERANCE, (kind, what, error)


def opencv_is_what_runs_where_none_is_named():
    Convolutional("net.onnx", random)
    spec("t.etl", 8, 6)
    files = []
    for words in ([], ["--runtime", "opencv"]):
        call(ETLC, "embed", "t.etl", *words)
        files.append(open("t.embedded.npz", "rb").read())
    assert files[0] == files[1]


def refused(*words):
    said = call(ETLC, "embed", "t.etl", *BY_RUNTIME, status=1)
    for word in ("E1012", *words):
        assert word in said, (word, said)
    assert ".h:" not in said and ".cc:" not in said, "a place in a library's sources"
    assert len(said.splitlines()) == 5, said  # the error, where the encoder is declared, the count
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


def what_onnxruntime_does_not_run_is_named():
    spec("t.etl", 32, 32)
    out = "--encoder-cmd (docs/encoders.md)"

    def save(make, **options):
        g = Graph()
        g.save("net.onnx", [1, 3, 32, 32], make(g), 3072, opset=17, **options)
        return g.nodes[-1].name if g.nodes else None

    name = save(lambda g: g.node("Frobnicate", "x"))  # in no set of operators
    refused("Frobnicate", name, out)
    name = save(lambda g: g.node("MatMul", "x", g.weight(np.ones((7, 3)))))
    refused("MatMul", name, out)
    save(lambda g: g.node("Cast", g.node("Erf", g.node("Cast", "x", to=TensorProto.BFLOAT16)),
                          to=TensorProto.FLOAT))  # Erf has this type, and ONNX Runtime does not
    refused("Erf", "erf1", out)

    def above(g, x):
        """So many numbers as x has positive elements, which is known only when it runs."""
        return g.node("Gather", g.node("NonZero", g.node("Greater", x, g.weight(0))),
                      g.weight(0, np.int64))

    name = save(lambda g: g.node("Reshape", "x", g.node("Squeeze", above(g, "x"),
                                                        g.weight(0, np.int64))))
    refused("cannot be run", "Reshape", name, out)
    save(lambda g: "nowhere")
    refused("nowhere")
    save(lambda g: g.node("Cast", above(g, "x"), to=TensorProto.FLOAT))
    refused("numbers for frame 1 and", "an embedding of one length")
    save(lambda g: g.node("Cast", above(g, g.node("Neg", g.node("Abs", "x"))),
                          to=TensorProto.FLOAT))
    refused("gives no number, expected an embedding")


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
    g = Graph()
    g.save("net.onnx", [1, 3, 2, 2], g.node("Flatten", g.node("Cast", "x", to=TensorProto.DOUBLE)),
           12, gives=TensorProto.DOUBLE)
    refused("of not float, 1 x 12, expected float")
    save([1, 3, 2, 2])
    whole = open("net.onnx", "rb").read()
    open("net.onnx", "wb").write(whole[: len(whole) // 2])
    refused("is no ONNX model, or a damaged one")
    g = Graph()
    x = g.node("Flatten", "x")
    zero = g.node("Sub", x, x)
    g.save("net.onnx", [1, 3, 2, 2], g.node("Div", zero, zero), 12)
    said = call(ETLC, "embed", "t.etl", *BY_RUNTIME, status=1)
    assert "nan at element 0 of the embedding of bay, frame 0" in said and "E1014" in said, said
    save(["batch", 3, 2, 2])  # of any number of images: one at a time
    call(ETLC, "embed", "t.etl", *BY_RUNTIME)
    assert np.load("t.embedded.npz")["rows-1"].shape == (2, 12)


def weights_in_another_file_are_refused():
    """Where they lie in the working folder, too: a library would take them from there."""
    g = Graph()
    weights = g.weight(random.normal(size=(12, 1000)))
    in_one = g.node("MatMul", g.node("Flatten", "x"), weights)
    g.save("net.onnx", [1, 3, 2, 2], in_one, 1000)
    onnx.save(onnx.load("net.onnx"), "net.onnx", save_as_external_data=True, location="net.data")
    spec("t.etl")
    refused("keeps weights in another file, 'net.data'", "external_data=False")
    body = helper.make_graph(
        [helper.make_node("Identity", ["inner"], ["inside"])], "body", [],
        [helper.make_tensor_value_info("inside", TensorProto.FLOAT, [1, 12])],
        [numpy_helper.from_array(np.ones((1, 12), np.float32), "inner")])
    onnx.external_data_helper.set_external_data(body.initializer[0], "inner.data")
    g = Graph()
    positive = g.node("Greater", g.node("ReduceMax", "x", keepdims=0), g.weight(0))
    g.save("net.onnx", [1, 3, 2, 2],
           g.node("If", positive, then_branch=body, else_branch=body), 12)
    refused("keeps weights in another file, 'inner.data'")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    networks_give_what_loops_give()
    if RUNTIME == "opencv":
        opencv_is_what_runs_where_none_is_named()
    os.remove("t.embedded.npz")
    if RUNTIME == "opencv":
        what_opencv_does_not_run_is_named()
    else:
        what_onnxruntime_does_not_run_is_named()
    weights_in_another_file_are_refused()
    models_of_another_form_are_refused()
    os.chdir("/")
