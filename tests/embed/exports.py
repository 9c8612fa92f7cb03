"""Small networks as exporters write them: blocks of MobileNetV2, ConvNeXt, CLIP and DINOv2, with
random weights. Each function saves a model of an image of SIDE x SIDE, and returns the dimension of
its embedding."""
import math

import numpy as np
from networks import Graph

SIDE = 32


class Export(Graph):
    def __init__(self, random):
        super().__init__()
        self.random = random

    def chance(self, *shape, size=None, middle=0.0):
        size = 1 / math.sqrt(np.prod(shape) / max(shape)) if size is None else size
        return self.weight(self.random.normal(middle, size, shape))

    def conv(self, x, channels, to, side, stride=1, group=1, bias=True):
        weights = [self.chance(to, channels // group, side, side)]
        weights += [self.chance(to, size=0.1)] if bias else []
        return self.node("Conv", x, *weights, kernel_shape=[side] * 2, strides=[stride] * 2,
                         pads=[(side // 2) * (stride < side)] * 4, group=group)

    def batch_norm(self, x, channels):
        return self.node("BatchNormalization", x, self.chance(channels, size=0.2, middle=1),
                         self.chance(channels, size=0.2), self.chance(channels, size=0.2),
                         self.weight(self.random.uniform(0.2, 1, channels)), epsilon=1e-5)

    def layer_norm(self, x, width):
        """Writes it as exporters did before it was an operator."""
        centred = self.node("Sub", x, self.node("ReduceMean", x, axes=[-1], keepdims=1))
        variance = self.node("ReduceMean", self.node("Pow", centred, self.weight(2)), axes=[-1],
                             keepdims=1)
        deviation = self.node("Sqrt", self.node("Add", variance, self.weight(1e-6)))
        scaled = self.node("Mul", self.node("Div", centred, deviation),
                           self.chance(width, size=0.2, middle=1))
        return self.node("Add", scaled, self.chance(width, size=0.2))

    def linear(self, x, width, to):
        return self.node("Add", self.node("MatMul", x, self.chance(width, to)),
                         self.chance(to, size=0.1))

    def gelu(self, x):
        bell = self.node("Add", self.node("Erf", self.node("Div", x, self.weight(math.sqrt(2)))),
                         self.weight(1))
        return self.node("Mul", self.node("Mul", x, bell), self.weight(0.5))

    def quick_gelu(self, x):
        return self.node("Mul", x, self.node("Sigmoid", self.node("Mul", x, self.weight(1.702))))

    def shaped(self, x, *shape):
        return self.node("Reshape", x, self.weight(shape, np.int64))

    def write(self, path, z, dimension):
        self.save(path, [1, 3, SIDE, SIDE], z, dimension)
        return dimension


def mobilenet(path, random):
    """Inverted residuals (Sandler et al. 2018), with batch norm and ReLU6 as nodes."""
    g = Export(random)

    def active(x, channels):
        return g.node("Clip", g.batch_norm(x, channels), g.weight(0), g.weight(6))

    def block(x, channels, to, stride):
        wide = 4 * channels
        y = active(g.conv(x, channels, wide, 1, bias=False), wide)
        y = active(g.conv(y, wide, wide, 3, stride, group=wide, bias=False), wide)
        y = g.batch_norm(g.conv(y, wide, to, 1, bias=False), to)
        return g.node("Add", x, y) if stride == 1 and channels == to else y

    x = active(g.conv("x", 3, 8, 3, 2, bias=False), 8)
    for channels, to, stride in ((8, 12, 2), (12, 12, 1), (12, 16, 2), (16, 16, 1)):
        x = block(x, channels, to, stride)
    x = active(g.conv(x, 16, 40, 1, bias=False), 40)
    return g.write(path, g.node("Flatten", g.node("GlobalAveragePool", x)), 40)


def convnext(path, random):
    """Blocks of a wide convolution of each channel (Liu et al. 2022), in images with the channels
    first and last."""
    g = Export(random)

    def last(x):
        return g.node("Transpose", x, perm=[0, 2, 3, 1])

    def first(x):
        return g.node("Transpose", x, perm=[0, 3, 1, 2])

    def block(x, channels):
        y = g.layer_norm(last(g.conv(x, channels, channels, 7, group=channels)), channels)
        y = g.linear(g.gelu(g.linear(y, channels, 4 * channels)), 4 * channels, channels)
        y = g.node("Mul", y, g.chance(channels, size=0.3))
        return g.node("Add", x, first(y))

    x = block(first(g.layer_norm(last(g.conv("x", 3, 12, 4, 4)), 12)), 12)
    x = g.conv(first(g.layer_norm(last(x), 12)), 12, 24, 2, 2)
    x = block(block(x, 24), 24)
    x = g.node("Flatten", g.node("GlobalAveragePool", x))
    return g.write(path, g.layer_norm(x, 24), 24)


def transformer(path, random, is_clip):
    """CLIP (Radford et al. 2021): the class token, through norms and a map, with the quick GELU.
    DINOv2 (Oquab et al. 2023): the mean of the patches, with scales of layers."""
    g = Export(random)
    width, heads, patch = 24, 3, 8
    patches = (SIDE // patch) ** 2
    tokens, each = patches + 1, width // heads

    def attention(x):
        parts = []
        for order in ([0, 2, 1, 3], [0, 2, 3, 1], [0, 2, 1, 3]):
            part = g.shaped(g.linear(x, width, width), 1, tokens, heads, each)
            parts.append(g.node("Transpose", part, perm=order))
        scores = g.node("Div", g.node("MatMul", parts[0], parts[1]), g.weight(math.sqrt(each)))
        mixed = g.node("MatMul", g.node("Softmax", scores, axis=-1), parts[2])
        joined = g.shaped(g.node("Transpose", mixed, perm=[0, 2, 1, 3]), 1, tokens, width)
        return g.linear(joined, width, width)

    def scaled(x):
        return x if is_clip else g.node("Mul", x, g.chance(width, size=0.3))

    x = g.conv("x", 3, width, patch, patch, bias=not is_clip)
    x = g.node("Transpose", g.shaped(x, 1, width, patches), perm=[0, 2, 1])
    x = g.node("Concat", g.chance(1, 1, width, size=0.5), x, axis=1)
    x = g.node("Add", x, g.chance(1, tokens, width, size=0.5))
    x = g.layer_norm(x, width) if is_clip else x
    for _ in range(2):
        x = g.node("Add", x, scaled(attention(g.layer_norm(x, width))))
        h = g.linear(g.layer_norm(x, width), width, 4 * width)
        h = g.quick_gelu(h) if is_clip else g.gelu(h)
        x = g.node("Add", x, scaled(g.linear(h, 4 * width, width)))
    x = g.layer_norm(x, width)
    if not is_clip:
        patches_alone = g.node("Slice", x, *(g.weight([n], np.int64) for n in (1, tokens, 1)))
        return g.write(path, g.node("ReduceMean", patches_alone, axes=[1], keepdims=0), width)
    token = g.node("Flatten", g.node("Gather", x, g.weight(0, np.int64), axis=1))
    return g.write(path, g.node("MatMul", token, g.chance(width, 16)), 16)


def clip(path, random):
    return transformer(path, random, True)


def dinov2(path, random):
    return transformer(path, random, False)
