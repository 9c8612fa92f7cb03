"""onnx_encoder.py ROWS COLUMNS MEAN DEVIATION: an encoder command that runs ETLC_MODEL, node by
node, in float32 numpy. The last two are numbers separated by commas. Tests also import its
evaluator, for other number types."""
import math
import os
import struct
import sys

import numpy as np
import onnx
from onnx import numpy_helper


def conv(x, kernel, bias=0.0, strides=(1, 1), pads=(0, 0, 0, 0), group=1, **_):
    x = np.pad(x, ((0, 0), (0, 0), (pads[0], pads[2]), (pads[1], pads[3])))
    windows = np.lib.stride_tricks.sliding_window_view(x, kernel.shape[2:], axis=(2, 3))
    windows = windows[:, :, :: strides[0], :: strides[1]]
    parts = [np.einsum("nchwkl,ockl->nohw", *both) for both in
             zip(np.split(windows, group, 1), np.split(kernel, group, 0))]
    return np.concatenate(parts, 1) + np.reshape(bias, (1, -1, 1, 1))


def batch_norm(x, *weights, epsilon):
    scale, shift, mean, variance = (w.reshape(1, -1, 1, 1) for w in weights)
    return (x - mean) / np.sqrt(variance + epsilon) * scale + shift


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
    "Erf": lambda x: np.vectorize(math.erf)(x).astype(x.dtype),
    "Transpose": lambda x, perm: x.transpose(perm),
    "Reshape": lambda x, shape: x.reshape(shape),
    "Flatten": lambda x: x.reshape(len(x), -1),
    "Gemm": lambda x, w, transB: x @ w.T,
    "BatchNormalization": batch_norm, "Clip": np.clip, "Pow": np.power,
    "GlobalAveragePool": lambda x: x.mean((2, 3), keepdims=True),
    "Sigmoid": lambda x: 1 / (1 + np.exp(-x)),
    "Gather": lambda x, at, axis: np.take(x, at, axis),
    "Slice": lambda x, begin, end, axis: x[(slice(None),) * axis[0] + (slice(begin[0], end[0]),)],
    "ReduceMean": lambda x, axes, keepdims: x.mean(tuple(axes), keepdims=bool(keepdims)),
}


def run(graph, image):
    """Computes in the number type of the image."""
    values = {graph.input[0].name: image}
    for weight in graph.initializer:
        array = numpy_helper.to_array(weight)
        values[weight.name] = array.astype(image.dtype) if array.dtype.kind == "f" else array
    for node in graph.node:
        attributes = {a.name: onnx.helper.get_attribute_value(a) for a in node.attribute}
        values[node.output[0]] = OPERATORS[node.op_type](*(values[name] for name in node.input),
                                                         **attributes)
    return values[graph.output[0].name]


def weights_of(there, here):
    """Weights of bilinear interpolation along an axis: here x there."""
    at = np.maximum((np.arange(here) + 0.5) * there / here - 0.5, 0)
    low = at.astype(int)
    result = np.zeros((here, there), np.float32)
    result[np.arange(here), low] += 1 - (at - low)
    result[np.arange(here), np.minimum(low + 1, there - 1)] += at - low
    return result


def main():
    rows, columns = int(sys.argv[1]), int(sys.argv[2])
    mean, deviation = (np.array(word.split(","), np.float32) for word in sys.argv[3:5])
    graph = onnx.load(os.environ["ETLC_MODEL"]).graph
    frames, embeddings, begun = sys.stdin.buffer, sys.stdout.buffer, False
    while head := frames.read(8):
        height, width = struct.unpack("<II", head)
        pixels = np.frombuffer(frames.read(height * width * 3), np.uint8)
        image = np.einsum("rh,hwc,vw->rvc", weights_of(height, rows),
                          pixels.reshape(height, width, 3).astype(np.float32),
                          weights_of(width, columns))
        image = ((image / 255 - mean) / deviation).transpose(2, 0, 1)[None]
        z = run(graph, image.astype(np.float32)).astype("<f4")
        if not begun:
            embeddings.write(struct.pack("<I", z.size))
        begun = True
        embeddings.write(z.tobytes())


if __name__ == "__main__":
    main()
