"""against_numpy_test.py ETLC: compares embeddings of `etlc embed` with ffmpeg's bytes and plain
loops over the pixels."""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
from networks import DEVIATION, MEAN, Convolutional, Graph, prepared
from PIL import Image

ETLC = os.path.abspath(sys.argv[1])
EMBEDDER = os.path.join(os.path.dirname(ETLC), "etlc-embed")
random = np.random.default_rng(7)


def call(*words, status=0):
    done = subprocess.run(words, capture_output=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done


def decoded(path):
    """Returns the frames of etlc-embed, without their headers."""
    data, frames = call(EMBEDDER, "video", path).stdout, []
    while data:
        height, width = np.frombuffer(data[:8], "<u4")
        size = int(height) * int(width) * 3
        frames.append(data[8 : 8 + size])
        data = data[8 + size :]
    return frames


def frames_are_those_of_ffmpeg():
    for codec, options in (("libx264", []), ("mpeg4", []), ("libaom-av1", ["-cpu-used", "8"])):
        made = "testsrc2=size=70x50:rate=10:duration=1"
        call("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", made, "-pix_fmt", "yuv420p",
             "-c:v", codec, *options, "v.mp4")
        raw = call("ffmpeg", "-v", "error", "-i", "v.mp4", "-f", "rawvideo", "-pix_fmt", "rgb24",
                   "-").stdout
        frames = decoded("v.mp4")
        assert len(frames) == 10 and b"".join(frames) == raw, codec
    whole = open("v.mp4", "rb").read()
    open("cut.mp4", "wb").write(whole[: len(whole) // 2])
    assert b"damaged" in call(EMBEDDER, "video", "cut.mp4", status=65).stderr


def embeddings_are_those_of_loops():
    network = Convolutional("net.onnx", random)
    os.mkdir("bay")
    images = [random.integers(0, 256, size, dtype=np.uint8) for size in ((8, 6, 3), (13, 17, 3))]
    for i, image in enumerate(images):
        Image.fromarray(image).save(f"bay/{i}.png")
    Image.fromarray(images[1][:, :, 0]).save("bay/grey.png")
    images.append(images[1][:, :, [0, 0, 0]])
    turned = Image.fromarray(random.integers(0, 256, (24, 16, 3), dtype=np.uint8))
    exif = turned.getexif()
    exif[0x0112] = 6  # a quarter turn clockwise
    turned.save("bay/turned.jpg", quality=95, exif=exif, subsampling=0)
    images.append(np.rot90(np.asarray(Image.open("bay/turned.jpg")), -1))
    with open("t.etl", "w") as spec:
        spec.write(f"""spec t;
encoder net = load("net.onnx"), image [8, 6], mean {list(MEAN)}, deviation {list(DEVIATION)};
input z : f32[4] by net;
target bay = images("bay") by net;
monitor m = F min l2(z, bay) <= 1;
""")
    call(ETLC, "embed", "t.etl")
    rows = np.load("t.embedded.npz")["rows-1"]
    assert rows.shape == (4, 4)
    for row, image in zip(rows, images):
        expected = network(prepared(image, 8, 6))
        assert np.abs(row - expected).max() <= 1e-5 * np.abs(expected).max(), (row, expected)
    for wrong in (images[0][:, :, ::-1], images[0][::-1]):  # detects swapped channels
        assert np.abs(rows[0] - network(prepared(wrong, 8, 6))).max() > 1e-2


def transformed(image, _, filter, size, flips, channels):
    """Returns what a network sees: Pillow's resizing, then the centre of 8 x 6 pixels."""
    picture = Image.fromarray(image)
    for flip in flips:
        picture = picture.transpose(flip)
    height, width = size if len(size) == 2 else (
        int(size[0] * side / min(image.shape[:2])) for side in image.shape[:2])
    picture = picture.resize((width, height), filter)
    top, left = round((height - 8) / 2), round((width - 6) / 2)  # as in torchvision
    return np.asarray(picture)[top : top + 8, left : left + 6][:, :, channels]


def transforms_are_those_of_pillow():
    """10,000 images of random sizes through a network that gives what it sees."""
    graph = Graph()
    graph.save("same.onnx", [1, 3, 8, 6], graph.node("Flatten", "x"), 3 * 8 * 6)
    transforms = [
        (["--filter", "bilinear"], Image.BILINEAR, (8, 6), [], [0, 1, 2]),
        (["--filter", "bicubic"], Image.BICUBIC, (8, 6), [], [0, 1, 2]),
        (["--filter", "bicubic", "--resize", "13,9"], Image.BICUBIC, (13, 9), [], [0, 1, 2]),
        (["--filter", "bilinear", "--resize", "11", "--flip", "both"], Image.BILINEAR, (11,),
         [Image.FLIP_LEFT_RIGHT, Image.FLIP_TOP_BOTTOM], [0, 1, 2]),
        (["--filter", "bicubic", "--resize", "9", "--flip", "vertical", "--channels", "bgr"],
         Image.BICUBIC, (9,), [Image.FLIP_TOP_BOTTOM], [2, 1, 0])]
    for transform in transforms:
        images = [random.integers(0, 256, (*random.integers(1, 60, 2), 3), dtype=np.uint8)
                  for _ in range(2000)]
        frames = [np.array(i.shape[:2], "<u4").tobytes() + i.tobytes() for i in images]
        done = subprocess.run([EMBEDDER, "encode", "same.onnx", *transform[0]],
                              input=b"".join(frames), capture_output=True)
        assert done.returncode == 0, done.stderr
        seen = np.frombuffer(done.stdout[4:], "<f4").reshape(-1, 3, 8, 6) * 255
        for image, got in zip(images, seen):
            expected = transformed(image, *transform).transpose(2, 0, 1)
            assert (np.rint(got) == expected).all(), (transform, image.shape)


def the_transform_is_part_of_the_fingerprint():
    """Each setting changes embeddings, so each changes the fingerprint; a frame that 'resize'
    makes smaller than the image is an error."""
    prints = set()
    changes = ["", "resize bilinear,", "resize bicubic,", "resize bicubic [9],",
               "resize bicubic [9, 9],", "flip horizontal,", "flip both,", "channels bgr,"]
    for change in changes:
        with open("s.etl", "w") as spec:
            spec.write(f"""spec s;
encoder net = load("same.onnx"), {change} image [8, 6];
input z : f32[144] by net;
target bay = images("bay/0.png") by net;
monitor m = F min l2(z, bay) <= 1;
""")
        call(ETLC, "embed", "s.etl")
        info = json.loads(bytes(np.load("s.embedded.npz")["embedded.json"]))
        prints.add(json.dumps(info["encoders"]["net"]["settings"]))
    assert len(prints) == len(changes), prints
    text = open("s.etl").read().replace("channels bgr", "resize bicubic [5]")
    open("s.etl", "w").write(text)
    done = call(ETLC, "embed", "s.etl", status=1)
    assert b"makes a frame of 8 x 6 smaller: 6 x 5" in done.stderr, done.stderr


def bad_images_are_refused():
    deep = Image.fromarray(random.integers(0, 65536, (4, 4), dtype=np.uint16))
    deep.save("deep.png")
    clear = Image.fromarray(random.integers(0, 255, (4, 4, 4), dtype=np.uint8), "RGBA")
    clear.save("clear.png")
    Image.fromarray(random.integers(0, 256, (64, 64, 3), dtype=np.uint8)).save("whole.jpg")
    whole = open("whole.jpg", "rb").read()
    open("cut.jpg", "wb").write(whole[: len(whole) // 2])
    for name, words in (("deep.png", b"16 bits"), ("clear.png", b"transparent"),
                        ("cut.jpg", b"is cut")):
        done = call(EMBEDDER, "images", name, status=65)
        assert words in done.stderr and not done.stdout, done


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    frames_are_those_of_ffmpeg()
    embeddings_are_those_of_loops()
    transforms_are_those_of_pillow()
    the_transform_is_part_of_the_fingerprint()
    bad_images_are_refused()
    os.chdir("/")
