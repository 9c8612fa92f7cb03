"""Small networks for tests, and their definitions: loops over pixels, tokens and heads in double
precision, which share no code with the tested program."""
import math

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

MEAN, DEVIATION = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)


class Graph:
    """Nodes in sequence, with float32 weights between them."""

    def __init__(self):
        self.nodes, self.weights = [], []

    def weight(self, values, kind=np.float32):
        name = f"w{len(self.weights)}"
        self.weights.append(numpy_helper.from_array(np.ascontiguousarray(values, kind), name))
        return name

    def node(self, kind, *inputs, **attributes):
        name = f"{kind.lower()}{len(self.nodes)}"
        self.nodes.append(helper.make_node(kind, list(inputs), [name], name, **attributes))
        return name

    def save(self, path, shape, result, dimension, inputs=("x",), element=TensorProto.FLOAT,
             opset=13, gives=TensorProto.FLOAT):
        graph = helper.make_graph(
            self.nodes, "net",
            [helper.make_tensor_value_info(name, element, shape) for name in inputs],
            [helper.make_tensor_value_info(result, gives, [1, dimension])],
            self.weights)
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", opset)])
        model.ir_version = 7 if opset < 15 else 8
        onnx.save(model, path)


def resized(image, rows, columns):
    """Resizes bilinearly, with pixel centres at half numbers."""
    result = np.zeros((rows, columns, 3))
    for r in range(rows):
        for c in range(columns):
            y = max((r + 0.5) * image.shape[0] / rows - 0.5, 0)
            x = max((c + 0.5) * image.shape[1] / columns - 0.5, 0)
            top, left = int(y), int(x)
            bottom, right = min(top + 1, image.shape[0] - 1), min(left + 1, image.shape[1] - 1)
            v, u = y - top, x - left
            result[r, c] = ((1 - v) * ((1 - u) * image[top, left] + u * image[top, right]) +
                            v * ((1 - u) * image[bottom, left] + u * image[bottom, right]))
    return result


def prepared(image, rows, columns):
    """Returns the input of a network for an image of rows x columns x 3."""
    return (resized(image.astype(float), rows, columns) / 255 - MEAN) / DEVIATION


class Convolutional:
    """A convolution, a rectifier, and a map to four numbers. All weights differ, so swapped
    colours, rows or columns are detected."""

    rows, columns, dimension = 8, 6, 4

    def __init__(self, path, random):
        self.kernel = random.normal(size=(5, 3, 3, 3)).astype(np.float32)
        self.final = random.normal(size=(5 * 8 * 6, 4)).astype(np.float32)
        g = Graph()
        maps = g.node("Relu", g.node("Conv", "x", g.weight(self.kernel), kernel_shape=[3, 3],
                                     pads=[1, 1, 1, 1]))
        z = g.node("Gemm", g.node("Flatten", maps), g.weight(self.final.T), transB=1)
        g.save(path, [1, 3, 8, 6], z, 4)

    def __call__(self, x):
        padded = np.pad(x, ((1, 1), (1, 1), (0, 0)))
        maps = np.zeros((5, 8, 6))
        for o, r, c in np.ndindex(maps.shape):
            window = padded[r : r + 3, c : c + 3].transpose(2, 0, 1)
            maps[o, r, c] = max((window * self.kernel[o]).sum(), 0)
        return maps.reshape(-1) @ self.final


class Transformer:
    """Patches of an image, two blocks of attention and a hidden layer, and the mean of the tokens:
    a vision transformer (Dosovitskiy et al. 2021) as older exporters write it. LayerNormalization
    and Gelu are arithmetic nodes."""

    rows = columns = 16
    patch, patches, dimension, heads, blocks = 4, 16, 24, 2, 2
    tokens, opset = patches, 13

    def __init__(self, path, random):
        self.random, self.g = random, Graph()
        self.w = [{} for _ in range(self.blocks + 2)]  # weights of the patches, of the blocks, of
                                                       # the last layer
        width = self.dimension
        kernel = self.make(0, "kernel", (width, 3, self.patch, self.patch), 0.1)
        x = self.g.node("Conv", "x", kernel, self.make(0, "bias", (width,), 0.1),
                        kernel_shape=[self.patch] * 2, strides=[self.patch] * 2)
        x = self.g.node("Transpose", self.shaped(x, 1, width, self.patches), perm=[0, 2, 1])
        x = self.g.node("Add", self.begun(x), self.make(0, "places", (1, self.tokens, width), 0.5))
        for block in range(1, self.blocks + 1):
            x = self.g.node("Add", x, self.attention(block, self.norm(block, "first", x)))
            x = self.g.node("Add", x, self.hidden(block, self.norm(block, "second", x)))
        x = self.norm(self.blocks + 1, "last", x)
        z = self.g.node("ReduceMean", x, axes=[1], keepdims=0)
        self.g.save(path, [1, 3, self.rows, self.columns], z, width, opset=self.opset)

    def begun(self, x):
        return x

    def masked(self, scores):
        return scores

    def make(self, block, name, shape, size, middle=0.0):
        values = (middle + self.random.normal(0, size, shape)).astype(np.float32)
        self.w[block][name] = values.astype(float)
        return self.g.weight(values)

    def shaped(self, x, *shape):
        return self.g.node("Reshape", x, self.g.weight(shape, np.int64))

    def of_tokens(self, block, name, width, size, middle=0.0):
        """Returns a weight for each element of a token."""
        values = (middle + self.random.normal(0, size, width)).astype(np.float32)
        self.w[block][name] = values.astype(float)
        return self.g.weight(np.broadcast_to(values, (1, self.tokens, width)))

    def norm(self, block, name, x):
        g = self.g
        centred = g.node("Sub", x, g.node("ReduceMean", x, axes=[-1], keepdims=1))
        variance = g.node("ReduceMean", g.node("Mul", centred, centred), axes=[-1], keepdims=1)
        deviation = g.node("Sqrt", g.node("Add", variance, g.weight(1e-5)))
        scaled = g.node("Mul", g.node("Div", centred, deviation),
                        self.of_tokens(block, name + " scale", self.dimension, 0.1, 1))
        return g.node("Add", scaled, self.of_tokens(block, name + " shift", self.dimension, 0.1))

    def linear(self, block, name, x, width, to):
        product = self.g.node("MatMul", x, self.make(block, name, (width, to), 0.3))
        return self.g.node("Add", product, self.of_tokens(block, name + " bias", to, 0.1))

    def attention(self, block, x):
        g, width, each = self.g, self.dimension, self.dimension // self.heads
        query, key, value = (
            g.node("Transpose", self.shaped(self.linear(block, name, x, width, width), 1,
                                            self.tokens, self.heads, each), perm=order)
            for name, order in (("query", [0, 2, 1, 3]), ("key", [0, 2, 3, 1]),
                                ("value", [0, 2, 1, 3])))
        scores = g.node("Mul", g.node("MatMul", query, key), g.weight(each**-0.5))
        mixed = g.node("MatMul", g.node("Softmax", self.masked(scores), axis=-1), value)
        joined = self.shaped(g.node("Transpose", mixed, perm=[0, 2, 1, 3]), 1, self.tokens, width)
        return self.linear(block, "out", joined, width, width)

    def hidden(self, block, x):
        g, wide = self.g, 2 * self.dimension
        h = self.linear(block, "wide", x, self.dimension, wide)
        bell = g.node("Add", g.node("Erf", g.node("Div", h, g.weight(math.sqrt(2)))), g.weight(1))
        active = g.node("Mul", g.node("Mul", h, bell), g.weight(0.5))
        return self.linear(block, "narrow", active, wide, self.dimension)

    def __call__(self, image):
        tokens = self.first_tokens()
        for t in range(self.patches):
            row, column = (self.patch * n for n in divmod(t, self.columns // self.patch))
            window = image[row : row + self.patch, column : column + self.patch].transpose(2, 0, 1)
            w = self.w[0]
            sums = [(window * w["kernel"][d]).sum() for d in range(self.dimension)]
            tokens.append(np.array(sums) + w["bias"])
        tokens = [t + place for t, place in zip(tokens, self.w[0]["places"][0])]
        for w in self.w[1 : self.blocks + 1]:
            mixed = self.attend(w, [self.normed(w, "first", t) for t in tokens])
            tokens = [t + m for t, m in zip(tokens, mixed)]
            tokens = [t + self.widened(w, self.normed(w, "second", t)) for t in tokens]
        return sum(self.normed(self.w[-1], "last", t) for t in tokens) / self.tokens

    def first_tokens(self):
        return []

    def sees(self, token, other):
        return True

    @staticmethod
    def normed(w, name, token):
        mean = sum(token) / len(token)
        variance = sum((value - mean) ** 2 for value in token) / len(token)
        return (token - mean) / math.sqrt(variance + 1e-5) * w[name + " scale"] + w[name + " shift"]

    @staticmethod
    def mapped(w, name, token):
        return token @ w[name] + w[name + " bias"]

    def attend(self, w, tokens):
        each = self.dimension // self.heads
        q, k, v = ([self.mapped(w, name, t) for t in tokens] for name in ("query", "key", "value"))
        mixed = [np.zeros(self.dimension) for _ in tokens]
        for head in range(self.heads):
            part = slice(head * each, (head + 1) * each)
            for t in range(self.tokens):
                seen = [u for u in range(self.tokens) if self.sees(t, u)]
                scores = [q[t][part] @ k[u][part] / math.sqrt(each) for u in seen]
                weights = [math.exp(score - max(scores)) for score in scores]
                for weight, u in zip(weights, seen):
                    mixed[t][part] += weight / sum(weights) * v[u][part]
        return [self.mapped(w, "out", m) for m in mixed]

    def widened(self, w, token):
        h = self.mapped(w, "wide", token)
        active = np.array([x * (1 + math.erf(x / math.sqrt(2))) / 2 for x in h])
        return self.mapped(w, "narrow", active)


class Exported(Transformer):
    """The same as newer exporters write it: LayerNormalization is one node, and weights have the
    shape of a token. A learned token precedes the patches, for which Expand adds a dimension
    twice, and Where masks attention from some tokens."""

    first, opset = 2, 17
    tokens = first + Transformer.patches

    def __init__(self, path, random):
        self.mask = random.random((self.tokens, self.tokens)) < 0.7
        np.fill_diagonal(self.mask, True)
        super().__init__(path, random)

    def begun(self, x):
        shape = self.g.weight((1, self.first, self.dimension), np.int64)
        learned = self.make(0, "learned", (1, 1, self.dimension), 0.5)
        return self.g.node("Concat", self.g.node("Expand", learned, shape), x, axis=1)

    def masked(self, scores):
        return self.g.node("Where", self.g.weight(self.mask, bool), scores, self.g.weight(-1e9))

    def of_tokens(self, block, name, width, size, middle=0.0):
        return self.make(block, name, (width,), size, middle)

    def norm(self, block, name, x):
        return self.g.node("LayerNormalization", x,
                           self.of_tokens(block, name + " scale", self.dimension, 0.1, 1),
                           self.of_tokens(block, name + " shift", self.dimension, 0.1),
                           axis=-1, epsilon=1e-5)

    def first_tokens(self):
        return [self.w[0]["learned"][0, 0]] * self.first

    def sees(self, token, other):
        return self.mask[token, other]
