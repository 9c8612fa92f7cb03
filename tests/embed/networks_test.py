"""networks_test.py ETLC: a convolutional network and transformers give the embeddings of plain
loops, to 1e-5 relative, and quantised products those of integers; each step of the preparation
matters; unsupported nodes, and outputs that contradict their declaration, are refused, with the
name of the node if it has one."""
import os
import subprocess
import sys
import tempfile

import exports
import numpy as np
import onnx
import onnx_encoder
from networks import DEVIATION, MEAN, Convolutional, Exported, Graph, Transformer
from networks import prepared, resized
from onnx import TensorProto, helper, numpy_helper
from PIL import Image

ETLC = os.path.abspath(sys.argv[1])
COMMAND = os.path.join(os.path.dirname(os.path.abspath(__file__)), "onnx_encoder.py")
TOLERANCE = 1e-5
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
    """Applies the preparation of a frame, which a command does by itself."""
    words = ["/usr/bin/python3", COMMAND, str(network.rows), str(network.columns)]
    return " ".join(words + [",".join(map(str, numbers)) for numbers in (MEAN, DEVIATION)])


def wrong_preparations(image, rows, columns):
    """Variants of the preparation with one step omitted or changed."""
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
        spec("own.etl")  # the model's own size
        ways = [["t.etl", "--encoder-cmd", command(network)], ["own.etl"], ["t.etl"]]
        found = []
        for words in ways:
            call(ETLC, "embed", *words)
            rows = np.load(words[0].replace(".etl", ".embedded.npz"))["rows-1"]
            assert rows.shape == (2, network.dimension), rows.shape
            error = difference(rows, expected)
            assert error <= TOLERANCE, (kind, words, error)
            found.append(rows)
        assert (found[1] == found[2]).all(), "the same bits each time"
        for what, wrong in wrong_preparations(images[1], network.rows, network.columns):
            error = difference([rows[1]], [network(wrong)])
            assert error > 10 * TOLERANCE, (kind, what, error)


def exports_give_what_their_nodes_give():
    """Computes in double precision."""
    spec("t.etl", exports.SIDE, exports.SIDE)
    images = [np.asarray(Image.open(f"bay/{i}.png")) for i in range(2)]
    for make in (exports.mobilenet, exports.convnext, exports.clip, exports.dinov2):
        dimension = make("net.onnx", random)
        call(ETLC, "embed", "t.etl")
        rows = np.load("t.embedded.npz")["rows-1"]
        assert rows.shape == (2, dimension), (make, rows.shape)
        graph = onnx.load("net.onnx").graph
        expected = [onnx_encoder.run(graph, prepared(image, exports.SIDE, exports.SIDE).transpose(
            2, 0, 1)[None])[0] for image in images]
        error = difference(rows, expected)
        assert error <= TOLERANCE, (make, error)


def refused(*words, code="E1012"):
    said = call(ETLC, "embed", "t.etl", status=1)
    for word in (code, *words):
        assert word in said, (word, said)
    assert ".h:" not in said and ".cc:" not in said, "a place in a library's sources"
    assert len(said.splitlines()) == 5, said  # the error, the place of the encoder, the count
    assert not os.path.exists("t.embedded.npz")


def quantised(name, graph, inputs, weights, scale):
    """Makes a node of 8-bit products whose sums exceed 16 bits; returns its result."""
    q, s, z = inputs
    if name in ("MatMulInteger", "ConvInteger"):
        return graph.node(name, q, weights, z, graph.weight(0, np.int8),
                          **({"pads": [1] * 4} if name == "ConvInteger" else {}))
    out = (graph.weight(scale), graph.weight(0, np.uint8))
    one = (graph.weight(1), graph.weight(0, np.int8))
    if name in ("QLinearMatMul", "QLinearConv"):
        pads = {"pads": [1] * 4} if name == "QLinearConv" else {}
        return graph.node(name, q, s, z, weights, *one, *out, **pads)
    floats = graph.node("DequantizeLinear", q, s, z), graph.node("DequantizeLinear", weights, *one)
    kind, pads = (name, {}) if name == "MatMul" else (name, {"pads": [1] * 4})
    return graph.node("QuantizeLinear", graph.node(kind, *floats, **pads), *out)


def quantised_products_are_those_of_whole_numbers():
    """Processors that add in 16 bits saturate, unless ONNX Runtime is told not to."""
    image = random.integers(180, 256, (8, 8, 3), dtype=np.uint8)
    os.mkdir("quantised")
    Image.fromarray(image).save("quantised/0.png")
    pixels = image.transpose(2, 0, 1).astype(np.int64)
    flat = random.integers(100, 128, (192, 16)).astype(np.int8)
    kernel = random.integers(100, 128, (4, 3, 3, 3)).astype(np.int8)
    windows = np.lib.stride_tricks.sliding_window_view(
        np.pad(pixels, ((0, 0), (1, 1), (1, 1))), (3, 3), axis=(1, 2))
    sums = {"MatMul": pixels.reshape(-1) @ flat.astype(np.int64),
            "Conv": np.einsum("chwkl,ockl->ohw", windows, kernel.astype(np.int64)).ravel()}
    with open("quantised.etl", "w") as file:
        file.write("""spec t;
encoder net = load("net.onnx");
target t = images("quantised") by net;
input x : f32;
monitor m = F x <= 1;
""")
    for name in ("MatMulInteger", "QLinearMatMul", "MatMul", "ConvInteger", "QLinearConv", "Conv"):
        expected = sums["Conv" if "Conv" in name else "MatMul"]
        scale = np.float32(expected.max() / 255 / 200)
        if not name.endswith("Integer"):
            expected = np.round(expected / 255 / scale)
        g = Graph()
        inputs = g.weight(1 / 255), g.weight(0, np.uint8)
        q = g.node("QuantizeLinear", "x", *inputs)
        if "Conv" not in name:
            q = g.node("Flatten", q)
        weights = g.weight(kernel if "Conv" in name else flat, np.int8)
        found = quantised(name, g, (q, *inputs), weights, scale)
        z = g.node("Flatten", g.node("Cast", found, to=TensorProto.FLOAT))
        g.save("net.onnx", [1, 3, 8, 8], z, len(expected))
        call(ETLC, "embed", "quantised.etl")
        row = np.load("quantised.embedded.npz")["rows-1"][0]
        slack = 0 if name.endswith("Integer") else 1  # a sum exactly between two steps
        assert np.abs(row - expected).max() <= slack, (name, row[:4], expected[:4])


def what_is_not_run_is_named():
    spec("t.etl", 32, 32)
    out = "--encoder-cmd (docs/recordings.md)"

    def save(make, **options):
        g = Graph()
        g.save("net.onnx", [1, 3, 32, 32], make(g), 3072, opset=17, **options)
        return g.nodes[-1].name if g.nodes else None

    name = save(lambda g: g.node("Frobnicate", "x"))  # in no set of operators
    refused("Frobnicate", name, out)
    g = Graph()
    z = g.node("Own", "x", domain="our.operators")
    g.save("net.onnx", [1, 3, 32, 32], z, 3072)
    model = onnx.load("net.onnx")
    model.opset_import.append(helper.make_opsetid("our.operators", 1))
    onnx.save(model, "net.onnx")
    refused("our.operators", "Own", out)
    name = save(lambda g: g.node("MatMul", "x", g.weight(np.ones((7, 3)))))
    refused("MatMul", name, out)
    save(lambda g: g.node("Cast", g.node("Erf", g.node("Cast", "x", to=TensorProto.BFLOAT16)),
                          to=TensorProto.FLOAT))  # Erf has this type, and ONNX Runtime does not
    refused("Erf", "erf1", out)

    def above(g, x):
        """Returns as many numbers as x has positive elements, which is known only at run time."""
        return g.node("Gather", g.node("NonZero", g.node("Greater", x, g.weight(0))),
                      g.weight(0, np.int64))

    name = save(lambda g: g.node("Reshape", "x", g.node("Squeeze", above(g, "x"),
                                                        g.weight(0, np.int64))))
    refused("cannot be run", "Reshape", name, out)
    save(lambda g: "nowhere")
    refused("nowhere")
    for positive, fault in (("x", "numbers for frame 1 and"), ("none", "gives no number")):
        def make(g, positive=positive):
            x = g.node("Neg", g.node("Abs", "x")) if positive == "none" else "x"
            return g.node("Transpose", g.node("Cast", above(g, x), to=TensorProto.FLOAT))

        save(make)
        undeclared("net.onnx")
        refused(fault, "expected an embedding")


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
    said = call(ETLC, "embed", "t.etl", status=1)
    assert "nan at element 0 of the embedding of bay, frame 0" in said and "E1014" in said, said
    save(["batch", 3, 2, 2])  # a batch of any size: one at a time
    call(ETLC, "embed", "t.etl")
    assert np.load("t.embedded.npz")["rows-1"].shape == (2, 12)


def undeclared(path):
    """Removes the shape that the model declares for its output."""
    model = onnx.load(path)
    model.graph.output[0].type.tensor_type.ClearField("shape")
    onnx.save(model, path)


def what_is_given_is_what_is_declared():
    spec("t.etl")

    def save(declared, ends_flat=True):
        g = Graph()
        # As many numbers as there are positive ones: the nodes imply no shape.
        positive = g.node("Squeeze", g.node("NonZero", g.node("Greater", g.node(
            "Reshape", "x", g.weight([-1], np.int64)), g.weight(-1e9))), g.weight([0], np.int64))
        z = g.node("Gather", g.node("Reshape", "x", g.weight([-1], np.int64)), positive, axis=0)
        if ends_flat:
            z = g.node("Unsqueeze", z, g.weight([0], np.int64))
        g.save("net.onnx", [1, 3, 2, 2], z, 12)
        model = onnx.load("net.onnx")
        value = helper.make_tensor_value_info(z, TensorProto.FLOAT, declared)
        model.graph.output[0].CopyFrom(value)
        onnx.save(model, "net.onnx")
        return z

    for declared in ([1, 12], ["batch", 12], ["batch", "width"], None):
        save(declared)
        call(ETLC, "embed", "t.etl")
        os.remove("t.embedded.npz")
    z = save([1, 13])
    refused(f"gives '{z}' of 1 x 12, and declares 1 x 13")
    z = save(["batch", 3, 4])
    refused("12", "3 x 4")
    save([1, 12], ends_flat=False)
    refused("1 x 12")
    g = Graph()
    g.save("net.onnx", [1, 3, 2, 2], g.node("Flatten", "x"), 13)  # contradicted by the nodes
    refused("13")


def networks_that_draw_numbers_are_refused():
    """They are in training mode. One that gives the same for everything is named."""
    def save(make):
        g = Graph()
        flat = g.node("Flatten", "x")
        g.save("net.onnx", [1, 3, 2, 2], make(g, flat), 12)

    def constant(g, value):
        return g.node("Constant", value=numpy_helper.from_array(np.array(value)))

    spec("t.etl")
    cause = "probably it is in training mode"
    half = np.float32(0.5)
    save(lambda g, x: g.node("Dropout", x, constant(g, half), constant(g, True)))
    refused("'net' gives another embedding of the same frame the second time", cause,
            "model.eval()", code="E1013")
    save(lambda g, x: g.node("Add", x, g.node("RandomNormalLike", x, scale=0.1, seed=3.0)))
    refused("expected at most 0.001", cause, code="E1013")
    assert not os.path.exists("t.embedded.npz")
    for make, words in ((lambda g, x: g.node("Mul", x, g.weight(0)), "it gives only zeros for 4"),
                        (lambda g, x: g.node("Add", g.node("Mul", x, g.weight(0)), g.weight(2)),
                         "it gives one and the same embedding for 4"),
                        (lambda g, x: g.node("Dropout", x, constant(g, half)), "")):
        save(make)
        done = subprocess.run([ETLC, "embed", "t.etl"], capture_output=True, text=True)
        assert done.returncode == 0 and words in done.stdout, (words, done)
        assert ("it gives" in done.stdout) == (words != ""), done
    os.remove("t.embedded.npz")


def weights_in_another_file_are_refused():
    """Even in the working folder, where a library would load them."""
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
    exports_give_what_their_nodes_give()
    quantised_products_are_those_of_whole_numbers()
    os.remove("t.embedded.npz")
    what_is_not_run_is_named()
    what_is_given_is_what_is_declared()
    networks_that_draw_numbers_are_refused()
    weights_in_another_file_are_refused()
    models_of_another_form_are_refused()
    os.chdir("/")
