"""against_numpy_test.py ETLC: compares embeddings of `etlc embed` with ffmpeg's bytes and plain
loops over the pixels."""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import onnx
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


def transformed(image, _, filter, size, flips, channels, margins="even"):
    """Returns what a network sees: Pillow's resizing, then the centre of 8 x 6 pixels."""
    picture = Image.fromarray(image)
    for flip in flips:
        picture = picture.transpose(flip)
    height, width = size if len(size) == 2 else (
        int(size[0] * side / min(image.shape[:2])) for side in image.shape[:2])
    picture = picture.resize((width, height), filter)
    whole = int if margins == "down" else round  # as in transformers, or as in torchvision
    top, left = whole((height - 8) / 2), whole((width - 6) / 2)
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
         Image.BICUBIC, (9,), [Image.FLIP_TOP_BOTTOM], [2, 1, 0]),
        (["--filter", "bilinear", "--resize", "9", "--margins", "down"], Image.BILINEAR, (9,), [],
         [0, 1, 2], "down")]
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
    """Each setting may change embeddings, so each changes the fingerprint; a frame that 'resize'
    makes smaller than the image is an error."""
    prints = set()
    changes = ["", "resize bilinear,", "resize bicubic,", "resize bicubic [9],",
               "resize bicubic [9, 9],", "flip horizontal,", "flip both,", "margins down,",
               "channels bgr,"]
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


def outputs_are_chosen_and_pooled():
    graph = Graph()
    places = graph.node("Identity", "x")
    tokens = graph.node("Reshape", graph.node("Transpose", "x", perm=[0, 2, 3, 1]),
                        graph.weight([1, 24, 3], np.int64))
    flat = graph.node("Flatten", "x")
    graph.save("outputs.onnx", [1, 3, 4, 6], flat, 72)
    model = onnx.load("outputs.onnx")
    for name, shape in ((tokens, [1, 24, 3]), (places, [1, 3, 4, 6])):
        model.graph.output.append(
            onnx.helper.make_tensor_value_info(name, onnx.TensorProto.FLOAT, shape))
    onnx.save(model, "outputs.onnx")
    image = random.integers(0, 256, (4, 6, 3), dtype=np.uint8)
    Image.fromarray(image).save("whole.png")
    seen = image / 255
    asked = [(f'output "{flat}"', seen.transpose(2, 0, 1).ravel()),
             (f'output "{tokens}"', seen.ravel()),
             (f'output "{tokens}", pool cls', seen[0, 0]),
             (f'pool mean, output "{tokens}"', seen.mean((0, 1))),
             (f'output "{places}", pool mean', seen.mean((0, 1)))]
    refused = [("pool cls", f"say which in the spec, as output \"{flat}\""),
               ('output "none"', f"gives no output 'none', only '{flat}' (1 x 72), '{tokens}'"),
               (f'output "{flat}", pool mean', "gives 1 x 72, and pool mean takes"),
               (f'output "{places}", pool cls', "and pool cls takes 1 x tokens x numbers")]
    prints = set()
    for settings, expected in asked + refused:
        with open("o.etl", "w") as spec:
            spec.write(f"""spec o;
encoder net = load("outputs.onnx"), {settings};
input z : f32[{3 if isinstance(expected, str) else expected.size}] by net;
target bay = images("whole.png") by net;
monitor m = F min l2(z, bay) <= 1;
""")
        if isinstance(expected, str):
            done = call(ETLC, "embed", "o.etl", status=1)
            assert expected.encode() in done.stderr, (settings, done.stderr)
            continue
        call(ETLC, "embed", "o.etl")
        made = np.load("o.embedded.npz")
        prints.add(json.loads(bytes(made["embedded.json"]))["encoders"]["net"]["settings"])
        assert abs(made["rows-1"][0] - expected).max() < 1e-6, settings
    assert len(prints) == len(asked), prints


def preprocessors_of_hugging_face():
    """Files as they are on the hub, old and new, and files that must not be guessed at."""
    with open("p.etl", "w") as spec:
        spec.write("""spec p;
encoder net = load("any.onnx"), preprocessor load("p.json");
input z : f32[3] by net;
target bay = images("bay/0.png") by net;
monitor m = F min l2(z, bay) <= 1;
""")
    graph = Graph()
    graph.save("any.onnx", [1, 3, "rows", "columns"],
               graph.node("Flatten", graph.node("GlobalAveragePool", "x")), 3)
    half = {"image_mean": [0.5, 0.5, 0.5], "image_std": [0.5, 0.5, 0.5]}
    clip = {"image_processor_type": "CLIPImageProcessorFast",
            "crop_size": {"height": 4, "width": 6},
            "do_center_crop": True, "do_convert_rgb": True, "do_normalize": True,
            "do_rescale": True, "do_resize": True, "rescale_factor": 0.00392156862745098,
            "resample": 3, "size": {"shortest_edge": 8}, "device": None, "do_pad": None,
            "image_mean": [0.48145466, 0.4578275, 0.40821073],
            "image_std": [0.26862954, 0.26130258, 0.27577711]}
    vit = {"feature_extractor_type": "ViTFeatureExtractor", "do_normalize": True,
           "do_resize": True, "resample": 2, "size": 8, **half}
    convnext = {"image_processor_type": "ConvNextImageProcessor", "crop_pct": 0.875,
                "resample": 3, "size": {"shortest_edge": 7}, **half}
    halves = "mean [0.5, 0.5, 0.5], deviation [0.5, 0.5, 0.5]"
    good = [
        (clip, "resize bicubic [8], image [4, 6], margins down, mean [0.48145467, 0.4578275, "
               "0.40821072], deviation [0.26862955, 0.2613026, 0.2757771]"),
        ({**clip, "size": 8, "crop_size": 4, "do_normalize": False},
         "resize bicubic [8], image [4, 4], margins down, mean [0, 0, 0], deviation [1, 1, 1]"),
        (vit, f"resize bilinear, image [8, 8], {halves}"),
        ({**vit, "image_processor_type": "DeiTImageProcessor", "crop_size": 6},
         f"resize bilinear [8, 8], image [6, 6], margins down, {halves}"),
        ({**vit, "image_processor_type": "SiglipImageProcessor",
          "size": {"height": 6, "width": 8}, "do_center_crop": False},
         f"resize bilinear, image [6, 8], {halves}"),
        (convnext, f"resize bicubic [8], image [7, 7], margins down, {halves}"),
        ({**convnext, "size": {"shortest_edge": 384}},
         f"resize bicubic, image [384, 384], {halves}")]
    for config, settings in good:
        json.dump(config, open("p.json", "w"))
        call(ETLC, "embed", "p.etl")
        info = json.loads(bytes(np.load("p.embedded.npz")["embedded.json"]))["encoders"]["net"]
        assert info["settings"] == settings, (config, info)
        call(ETLC, "p.etl", "-o", "p.hpp")

    def without(config, key):
        return {k: value for k, value in config.items() if k != key}

    bad = [
        ([1], "is an array"), (without(vit, "feature_extractor_type"), "is missing"),
        ({**vit, "image_processor_type": "LevitImageProcessor"}, "Levit"),
        *((without(clip, key), f"no '{key}'")
          for key in ("size", "resample", "crop_size", "image_mean", "image_std")),
        (without(convnext, "crop_pct"), "no 'crop_pct'"), ({**convnext, "crop_pct": 0}, "crop_pct"),
        ({**convnext, "size": {"height": 8, "width": 8}}, "two sides"),
        ({**clip, "size": {"shortest_edge": 8, "longest_edge": 9}}, "longest_edge"),
        ({**clip, "size": 8.5}, "'size' is"), ({**clip, "size": {"shortest_edge": 0}}, "'size' is"),
        ({**clip, "do_center_crop": False}, "only the shorter side"),
        ({**clip, "do_center_crop": "no"}, "expected true or false"),
        ({**clip, "do_resize": False}, "do_resize"), ({**clip, "do_rescale": False}, "do_rescale"),
        ({**clip, "rescale_factor": 0.0078125}, "rescale_factor"),
        ({**clip, "resample": 1}, "resample"), ({**clip, "image_std": [1, 0, 1]}, "deviation"),
        ({**clip, "image_mean": 0.5}, "image_mean"), ({**clip, "image_mean": [0, 1]}, "image_mean"),
        ({**vit, "do_center_crop": True}, "do_center_crop"),
        ({**vit, "include_top": False}, "include_top"), ({**vit, "do_pad": True}, "do_pad")]
    for config, words in bad:
        json.dump(config, open("p.json", "w"))
        done = call(ETLC, "embed", "p.etl", status=1)
        assert b"p.json: error" in done.stderr and words.encode() in done.stderr, (config, done)
    os.remove("p.json")
    assert b"p.json" in call(ETLC, "embed", "p.etl", status=1).stderr
    text = open("p.etl").read()
    json.dump(clip, open("p.json", "w"))
    for settings, status in (("image [4, 6]", 0), ("margins even", 0), ("image [4, 4]", 1)):
        open("p.etl", "w").write(text.replace("preprocessor", settings + ", preprocessor"))
        call(ETLC, "embed", "p.etl", status=status)


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
    outputs_are_chosen_and_pooled()
    preprocessors_of_hugging_face()
    bad_images_are_refused()
    os.chdir("/")
