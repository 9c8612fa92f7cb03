"""against_numpy_test.py ETLC: compares embeddings of `etlc embed` with ffmpeg's bytes and plain
loops over the pixels."""
import os
import subprocess
import sys
import tempfile

import numpy as np
from networks import DEVIATION, MEAN, Convolutional, prepared
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
    bad_images_are_refused()
    os.chdir("/")
