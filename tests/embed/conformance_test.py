"""conformance_test.py ETLC NODES PART PARTS: `etlc embed` computes the results that ONNX defines.
NODES has the node tests of the ONNX project: a folder for each, with a node, its inputs and its
outputs. Many tests share a model. The first input of a node depends on the image, so that nothing
can be precomputed; the others are weights. Tests without an embedding, or that cannot run, are
listed by reason."""
import collections
import json
import os
import re
import subprocess
import sys
import tempfile

import numpy as np
import onnx
from onnx import TensorProto, compose, helper, numpy_helper
from PIL import Image

ETLC, NODES = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
PART, PARTS = int(sys.argv[3]), int(sys.argv[4])
TOGETHER = 40  # tests per model
TOLERANCE = 1e-4  # relative to the greatest number; the tests' own numbers are often rounded to
                  # four digits
TOLERANCE_OF_HALVES = 1e-3
NAN, LARGE = 7777.0, 8888.0  # replace nan and infinity, which no embedding may hold
HALVES = (TensorProto.FLOAT16, TensorProto.BFLOAT16)

# Tests without an embedding of one image, or without a result to compare.
LEFT_OUT = {"takes or gives sequences": 24, "gives text": 9, "gives nothing": 6,
            "gives what chance gives": 12, "trains": 7}

# Tests that ONNX Runtime does not support.
REFUSED = {
    "Could not find an implementation": [
        "bitshift_left_uint16", "bitshift_right_uint16", "max_int16", "max_uint16", "min_int16",
        "min_uint16", "pow_types_float32_uint32", "pow_types_float32_uint64"],
    "Batchwise recurrent operations (layout == 1) are not supported": [
        "gru_batchwise", "lstm_batchwise", "simple_rnn_batchwise"],
}

# Tests of which ONNX Runtime reads the definition differently.
READ_OTHERWISE = {
    "length_resized is the whole number of pixels, not a fraction": [
        "resize_downsample_scales_cubic_align_corners",
        "resize_downsample_scales_linear_align_corners"],
    "indices count in output_shape, where it is given": ["maxunpool_export_with_output_shape"],
}


class Test:
    def __init__(self, folder):
        self.name = folder.removeprefix("test_")
        self.folder = os.path.join(NODES, folder)
        self.model = onnx.load(os.path.join(self.folder, "model.onnx"))
        graph = self.model.graph
        # Earlier versions lack operators of the rest of the model.
        self.opsets = tuple((o.domain, max(o.version, 7)) for o in self.model.opset_import)
        self.is_of_tensors = all(value.type.HasField("tensor_type")
                                 for value in [*graph.input, *graph.output])
        if self.is_of_tensors:
            self.inputs = self.read("input", graph.input)
            self.outputs = self.read("output", graph.output)

    def read(self, kind, values):
        found = []
        for number, value in enumerate(values):
            tensor = TensorProto()
            with open(f"{self.folder}/test_data_set_0/{kind}_{number}.pb", "rb") as file:
                tensor.ParseFromString(file.read())
            tensor.data_type = value.type.tensor_type.elem_type  # bfloat16 is stored as uint16
            found.append(tensor)
        return found

    def why_left_out(self):
        if not self.is_of_tensors:
            return "takes or gives sequences"
        if any(tensor.data_type == TensorProto.STRING for tensor in self.outputs):
            return "gives text"
        if any(domain != "" for domain, _ in self.opsets):
            return "trains"
        if re.match("(bernoulli|training_dropout)", self.name):
            return "gives what chance gives"
        if all(array_of(tensor).size == 0 for tensor in self.outputs):
            return "gives nothing"
        return ""

    def expected(self):
        return np.concatenate([comparable(array_of(tensor)) for tensor in self.outputs])

    def tolerance(self):
        is_rough = any(tensor.data_type in HALVES for tensor in self.inputs + self.outputs)
        return TOLERANCE_OF_HALVES if is_rough else TOLERANCE

    def stands_alone(self):
        """Returns whether it has branches or loops, in which names must not change."""
        return any(a.HasField("g") for node in self.model.graph.node for a in node.attribute)


def array_of(tensor):
    if tensor.data_type == TensorProto.BFLOAT16:
        bits = np.frombuffer(tensor.raw_data, np.uint16).astype(np.uint32) << 16
        return bits.view(np.float32).reshape(tuple(tensor.dims))
    return numpy_helper.to_array(tensor)


def is_finite(tensor):
    array = array_of(tensor)
    return array.dtype.kind != "f" or bool(np.isfinite(array).all())


def comparable(array):
    with np.errstate(over="ignore"):
        row = array.astype(np.float32).ravel()
    return np.nan_to_num(row, nan=NAN, posinf=LARGE, neginf=-LARGE)


def constant(tensor, name):
    given = TensorProto()
    given.CopyFrom(tensor)
    given.name = ""
    return helper.make_node("Constant", [], [name], value=given)


def known_with_the_image(tensor, name):
    """Returns a node that gives the tensor if the mean of the image is not negative."""
    def branch(kind):
        inner = f"{name}_{kind}"
        return helper.make_graph([constant(tensor, inner)], kind, [], [
            helper.make_tensor_value_info(inner, tensor.data_type, list(tensor.dims))])

    return helper.make_node("If", ["is_image"], [name], then_branch=branch("then"),
                            else_branch=branch("else"))


def as_row(value, is_finite, nodes):
    """Converts to float32, replacing nan and infinity; returns the expected values."""
    name = value.name
    steps = [("Cast", [name], {"to": TensorProto.FLOAT}), ("Reshape", ["{}", "flat"], {})]
    if not is_finite:
        steps += [("Clip", ["{}", "small", "large"], {}), ("IsNaN", [f"{name}_1"], {}),
                  ("Where", ["{}", "nan", f"{name}_2"], {})]
    for step, (kind, inputs, attributes) in enumerate(steps):
        inputs = [word.format(f"{name}_{step - 1}") for word in inputs]
        nodes.append(helper.make_node(kind, inputs, [f"{name}_{step}"], **attributes))
    return f"{name}_{len(steps) - 1}"


def model_of(tests):
    """Makes a model of one image that concatenates the results of all tests."""
    weights = [numpy_helper.from_array(np.array(value, kind), name) for name, value, kind in (
        ("flat", [-1], np.int64), ("row", [1, -1], np.int64), ("below", -1, np.float32),
        ("large", LARGE, np.float32), ("small", -LARGE, np.float32), ("nan", NAN, np.float32))]
    nodes = [helper.make_node("ReduceMean", ["image"], ["mean"], keepdims=0),
             helper.make_node("Greater", ["mean", "below"], ["is_image"])]
    rows = []
    for number, test in enumerate(tests):
        graph = test.model.graph
        if not test.stands_alone():
            graph = compose.add_prefix_graph(graph, f"test{number}_")
        for place, (value, tensor) in enumerate(zip(graph.input, test.inputs)):
            if place == 0:
                nodes.append(known_with_the_image(tensor, value.name))
                continue
            weights.append(TensorProto())
            weights[-1].CopyFrom(tensor)
            weights[-1].name = value.name
        nodes += graph.node
        weights += graph.initializer
        rows += [as_row(value, is_finite(tensor), nodes)
                 for value, tensor in zip(graph.output, test.outputs)]
    nodes.append(helper.make_node("Concat", rows, ["joined"], axis=0))
    nodes.append(helper.make_node("Reshape", ["joined", "row"], ["embedding"]))
    size = sum(len(test.expected()) for test in tests)
    graph = helper.make_graph(
        nodes, "nodes", [helper.make_tensor_value_info("image", TensorProto.FLOAT, [1, 3, 2, 2])],
        [helper.make_tensor_value_info("embedding", TensorProto.FLOAT, [1, size])], weights)
    opsets = [helper.make_opsetid(*opset) for opset in tests[0].opsets]
    model = helper.make_model(graph, opset_imports=opsets)
    model.ir_version = 7
    return model


def embed(spec, models, status=0):
    """Returns the messages of `etlc embed`, and the embeddings, if any."""
    lines = ["spec t;"]
    for name, model in models.items():
        onnx.save(model, f"{name}.onnx")
        lines += [f'encoder {name} = load("{name}.onnx");',
                  f'target of_{name} = images("pixels.png") by {name};']
    lines += ["input x : f32;", "monitor m = F x <= 1;", ""]
    with open(f"{spec}.etl", "w") as file:
        file.write("\n".join(lines))
    done = subprocess.run([ETLC, "embed", f"{spec}.etl"], capture_output=True, text=True)
    assert done.returncode == status, (models.keys(), done.stdout, done.stderr)
    if status != 0:
        return done.stderr
    file = np.load(f"{spec}.embedded.npz")
    said = json.loads(bytes(file["embedded.json"]))["entries"]
    return {entry["encoder"]: file[entry["array"]][0] for entry in said.values()}


def groups_of(tests):
    alike = collections.defaultdict(list)
    for test in tests:
        alike[(test.name if test.stands_alone() else "", test.opsets)].append(test)
    for some in alike.values():
        for begin in range(0, len(some), TOGETHER):
            yield some[begin : begin + TOGETHER]


def compare(tests, row):
    """Returns the names of tests with other numbers."""
    at, wrong = 0, []
    for test in tests:
        expected = test.expected()
        found = row[at : at + len(expected)]
        at += len(expected)
        if np.abs(found - expected).max() > test.tolerance() * np.abs(expected).max() + 1e-6:
            wrong.append((test.name, found[:8].tolist(), expected[:8].tolist()))
    assert at == len(row), (at, len(row))
    return wrong


def main():
    Image.fromarray(np.arange(12, dtype=np.uint8).reshape(2, 2, 3)).save("pixels.png")
    tests = [Test(folder) for folder in sorted(os.listdir(NODES))]
    left_out = collections.Counter(test.why_left_out() for test in tests)
    del left_out[""]
    assert dict(left_out) == LEFT_OUT, left_out
    refused = {name: why for why, names in REFUSED.items() for name in names}
    otherwise = {name for names in READ_OTHERWISE.values() for name in names}
    tests = [test for test in tests if not test.why_left_out()]
    assert len({test.name for test in tests} & (refused.keys() | otherwise)) == 14
    ours = tests[PART::PARTS]

    run = [test for test in ours if test.name not in refused]
    groups = {f"e{number}": group for number, group in enumerate(groups_of(run))}
    rows = embed("run", {name: model_of(group) for name, group in groups.items()})
    wrong = [one for name, group in groups.items() for one in compare(group, rows[name])]
    assert {name for name, _, _ in wrong} == otherwise & {test.name for test in run}, wrong
    for test in ours:
        if test.name in refused:
            said = embed("refused", {"e": model_of([test])}, status=1)
            assert refused[test.name] in said and "E1012" in said, (test.name, said)
    print(f"{len(run)} tests of {len(tests)} in {len(groups)} models")
    assert len(run) > 850 // PARTS


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
