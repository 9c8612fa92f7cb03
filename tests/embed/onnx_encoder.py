"""onnx_encoder.py ROWS COLUMNS MEAN DEVIATION: an encoder command that runs ETLC_MODEL, node by
node, in float32 numpy. The last two are numbers with commas between them."""
import math
import os
import struct
import sys

import numpy as np
import onnx
from onnx import numpy_helper

ROWS, COLUMNS = int(sys.argv[1]), int(sys.argv[2])
MEAN, DEVIATION = (np.array(word.split(","), np.float32) for word in sys.argv[3:5])
GRAPH = onnx.load(os.environ["ETLC_MODEL"]).graph
WEIGHTS = {weight.name: numpy_helper.to_array(weight) for weight in GRAPH.initializer}


def conv(x, kernel, bias=0.0, strides=(1, 1), pads=(0, 0, 0, 0), **_):
    x = np.pad(x, ((0, 0), (0, 0), (pads[0], pads[2]), (pads[1], pads[3])))
    windows = np.lib.stride_tricks.sliding_window_view(x, kernel.shape[2:], axis=(2, 3))
    windows = windows[:, :, :: strides[0], :: strides[1]]
    return np.einsum("nchwkl,ockl->nohw", windows, kernel) + np.reshape(bias, (1, -1, 1, 1))


def softmax(x, axis=-1):
    powers = np.exp(x - x.max(axis, keepdims=True))
    return powers / powers.sum(axis, keepdims=True)


def layer_norm(x, scale, shift, axis, epsilon):
    centred = x - x.mean(axis, keepdims=True)
    return centred / np.sqrt((centred**2).mean(axis, keepdims=True) + epsilon) * scale + shift


OPERATORS = {
    "Add": np.add, "Sub": np.subtract, "Mul": np.multiply, "Div": np.divide, "MatMul": np.matmul,
    "Where": np.where, "Expand": lambda x, shape: x * np.ones(shape, np.float32),
    "Concat": lambda *xs, axis: np.concatenate(xs, axis), "LayerNormalization": layer_norm,
    "Sqrt": np.sqrt, "Relu": lambda x: np.maximum(x, 0), "Softmax": softmax, "Conv": conv,
    "Erf": np.vectorize(math.erf, otypes=[np.float32]),
    "Transpose": lambda x, perm: x.transpose(perm),
    "Reshape": lambda x, shape: x.reshape(shape),
    "Flatten": lambda x: x.reshape(len(x), -1),
    "Gemm": lambda x, w, transB: x @ w.T,
    "ReduceMean": lambda x, axes, keepdims: x.mean(tuple(axes), keepdims=bool(keepdims)),
}


def run(image):
    values = {**WEIGHTS, GRAPH.input[0].name: image}
    for node in GRAPH.node:
        attributes = {a.name: onnx.helper.get_attribute_value(a) for a in node.attribute}
        values[node.output[0]] = OPERATORS[node.op_type](*(values[name] for name in node.input),
                                                         **attributes)
    return values[GRAPH.output[0].name].astype("<f4")


def weights_of(there, here):
    """Of bilinear interpolation along an axis: here x there."""
    at = np.maximum((np.arange(here) + 0.5) * there / here - 0.5, 0)
    low = at.astype(int)
    result = np.zeros((here, there), np.float32)
    result[np.arange(here), low] += 1 - (at - low)
    result[np.arange(here), np.minimum(low + 1, there - 1)] += at - low
    return result


frames, embeddings, begun = sys.stdin.buffer, sys.stdout.buffer, False
while head := frames.read(8):
    height, width = struct.unpack("<II", head)
    pixels = np.frombuffer(frames.read(height * width * 3), np.uint8).reshape(height, width, 3)
    image = np.einsum("rh,hwc,vw->rvc", weights_of(height, ROWS), pixels.astype(np.float32),
                      weights_of(width, COLUMNS))
    z = run(((image / 255 - MEAN) / DEVIATION).transpose(2, 0, 1)[None].astype(np.float32))
    if not begun:
        embeddings.write(struct.pack("<I", z.size))
    begun = True
    embeddings.write(z.tobytes())
