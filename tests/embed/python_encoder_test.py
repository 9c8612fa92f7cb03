#!/usr/bin/python3
"""python_encoder_test.py ETLC: in Python, the encoder of a spec gives the embeddings of `etlc
embed`, and models of the process are guarded as files of models are."""

import os
import subprocess
import sys
import tempfile
import textwrap
import unittest
import warnings
from pathlib import Path

import numpy as np
from networks import Graph
from PIL import Image

os.environ["ETLC_COMMAND"] = os.path.abspath(sys.argv.pop())
import etlc  # noqa: E402

try:
    import torch
except ImportError:
    torch = None

ONNX = """spec look;
encoder net = load("net.onnx"), image [6, 8], mean [0.5, 0.4, 0.3];
input z : f32[3] by net;
target bay = images("bay/*.png") by net;
monitor near = F l2(z, bay) <= 0.1;
"""
OWN = """spec look;
encoder mine = load("mine.model");
input z : f32[4] by mine;
target bay = images("bay/*.png") by mine;
monitor near = F l2(z, bay) <= 0.0001;
"""


class Mean:
    """A model without a framework: `weights` times the mean of the pixels."""

    def __init__(self, weights, scale=255):
        self.weights = np.asarray(weights, "f4")
        self.settings = {"scale": scale, "names": {"red", "green", "blue"}}

    def __call__(self, image):
        return self.weights @ (image / self.settings["scale"]).mean(axis=(0, 1)).astype("f4")


class Box(unittest.TestCase):
    def setUp(self):
        box = tempfile.TemporaryDirectory()
        self.addCleanup(box.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(box.name)
        random = np.random.default_rng(5)
        self.images = random.integers(0, 256, (5, 10, 12, 3), np.uint8)
        os.makedirs("drives/one")
        os.mkdir("bay")
        for n, image in enumerate(self.images):
            Image.fromarray(image).save(f"drives/one/{n}.png")
        Image.fromarray(self.images[2]).save("bay/1.png")
        self.weights = random.normal(size=(4, 3))

    def embedded(self, spec, **options):
        Path("look.etl").write_text(spec)
        return etlc.embed("look.etl", "drives/one", output="episodes", **options)

    def refused(self, code, call, words=""):
        with self.assertRaisesRegex(etlc.SpecError, words) as raised:
            call()
        self.assertIn(code, [one.code for one in raised.exception.diagnostics])
        return raised.exception


class OfTheSpec(Box):
    def setUp(self):
        super().setUp()
        self.write("net.onnx", 1)

    def write(self, path, scale):
        graph = Graph()
        scaled = graph.node("Mul", "x", graph.weight([scale]))
        pooled = graph.node("GlobalAveragePool", scaled)
        graph.save(path, [1, 3, 6, 8], graph.node("Flatten", pooled), 3)

    def test_has_the_bits_of_etlc_embed(self):
        self.embedded(ONNX)
        with etlc.Encoder("look.etl") as encoder:
            self.assertEqual(encoder.name, "net")
            together = encoder.encode(self.images)
            alone = encoder(self.images[1])
            turned = encoder(self.images[:, ::-1])
            self.assertEqual(encoder(self.images[:0]).shape, (0, 3))
            references = encoder(np.zeros((480, 640, 3), np.uint8))
        self.assertEqual(together.tobytes(), np.load("episodes/one.npz")["z"].tobytes())
        self.assertEqual(alone.tobytes(), together[1].tobytes())
        self.assertEqual((turned.shape, references.shape), ((5, 3), (3,)))
        with self.assertRaisesRegex(etlc.ClosedError, "the encoder is closed"):
            encoder(self.images)

    def test_refuses_images_that_are_none(self):
        self.embedded(ONNX)
        with etlc.Encoder("look.etl", "net") as encoder:
            for wrong in (self.images[0] / 255, self.images[0, :, :, 0], self.images[..., :2],
                          "image", None):  # fmt: skip
                with self.assertRaisesRegex(etlc.InputError, "image"):
                    encoder(wrong)
            self.assertEqual(encoder(self.images[0]).shape, (3,))

    def test_refuses_what_etlc_embed_did_not_make(self):
        Path("look.etl").write_text(ONNX)
        self.refused("E1003", lambda: etlc.Encoder("look.etl"))
        self.embedded(ONNX)
        self.write("net.onnx", 2)
        self.refused("E1004", lambda: etlc.Encoder("look.etl"))
        self.write("net.onnx", 1)
        Path("look.etl").write_text(ONNX.replace("0.4", "0.41"))
        self.refused("E1004", lambda: etlc.Encoder("look.etl"))
        Path("look.etl").write_text(ONNX)
        self.refused("E1017", lambda: etlc.Encoder("look.etl", encoder_command="cat"),
                     "the same model run by a command")  # fmt: skip
        with self.assertRaisesRegex(etlc.InputError, "no encoder 'nett'; did you mean 'net'"):
            etlc.Encoder("look.etl", "nett")

    def test_an_encoder_that_ends_early(self):
        Path("early.py").write_text(textwrap.dedent("""
            import struct, sys
            sys.stdout.buffer.write(struct.pack("<I", 3))
            for n in range(7):
                head = sys.stdin.buffer.read(8)
                if not head:
                    sys.exit()
                h, w = struct.unpack("<II", head)
                mean = sys.stdin.buffer.read(h * w * 3)[0]
                sys.stdout.buffer.write(struct.pack("<3f", mean, mean, mean))
                sys.stdout.buffer.flush()
            sys.exit("too many frames")
        """))  # fmt: skip
        command = f"{sys.executable} early.py"
        spec = ONNX.replace('load("net.onnx"), image [6, 8], mean [0.5, 0.4, 0.3]',
                            'load("early.py")')  # fmt: skip
        self.embedded(spec, encoder_command=command)
        encoder = etlc.Encoder("look.etl", encoder_command=command)
        self.assertEqual(encoder(self.images).shape, (5, 3))
        with self.assertRaisesRegex(etlc.SpecError, "too many frames"):
            encoder(self.images)
        with self.assertRaises(etlc.ClosedError):
            encoder(self.images)


class InProcess(Box):
    def test_encodes_as_the_model(self):
        model = Mean(self.weights)
        self.embedded(OWN, encoder=model)
        expected = np.stack([model(image) for image in self.images])
        self.assertEqual(np.load("episodes/one.npz")["z"].tobytes(), expected.tobytes())
        with etlc.Encoder("look.etl", encoder=model) as encoder:
            self.assertEqual(encoder(self.images).tobytes(), expected.tobytes())
        with etlc.Monitor("look.etl") as monitor:
            near = monitor.run(z=expected).near.satisfied.tolist()
        self.assertEqual(near, [False, False, True, True, True])
        again = self.embedded(OWN, encoder=Mean(self.weights))
        self.assertIn("with embeddings of an earlier call", again.report)

    def test_another_model_is_refused(self):
        self.embedded(OWN, encoder=Mean(self.weights))
        kept = {path: Path(path).read_bytes() for path in ("mine.model", "look.embedded.npz")}
        other = self.weights.copy()
        other[3, 2] = np.nextafter(np.float32(other[3, 2]), np.float32(9))

        class Own(Mean):
            def __call__(self, image):
                return super().__call__(image[:, ::-1])

        function = Mean(self.weights)
        for model in (Mean(other), Mean(self.weights, 256), Own(self.weights),
                      lambda image: function(image)):  # fmt: skip
            self.refused("E1017", lambda: self.embedded(OWN, encoder=model),
                         "mine.model: error: this model is not the one")  # fmt: skip
            self.refused("E1017", lambda: etlc.Encoder("look.etl", encoder=model))
        for path, content in kept.items():
            self.assertEqual(Path(path).read_bytes(), content)

    def test_a_missing_hash_is_refused(self):
        Path("look.etl").write_text(OWN)
        model = Mean(self.weights)
        self.refused("E1017", lambda: etlc.Encoder("look.etl", encoder=model), "etlc.embed makes")
        self.embedded(OWN, encoder=model)
        Path("look.embedded.npz").unlink()
        self.refused("E1003", lambda: etlc.Encoder("look.etl", encoder=model))
        Path("mine.model").write_text("something else")
        self.refused("E1017", lambda: self.embedded(OWN, encoder=model), "no hash of a model")

    def test_what_was_made_with_another_model_is_refused(self):
        self.embedded(OWN, encoder=Mean(self.weights))
        os.rename("episodes", "old")
        Path("mine.model").unlink()
        self.embedded(OWN, encoder=Mean(self.weights, 256))
        self.refused("E1017", lambda: etlc.run("look.etl", "old/one.npz"))
        self.assertEqual(len(etlc.run("look.etl", "episodes/one.npz").episode), 5)
        Path("mine.model").write_text(Path("mine.model").read_text() + " ")
        self.refused("E1004", lambda: etlc.Monitor("look.etl"))

    def test_thresholds_of_another_model_are_refused(self):
        random = np.random.default_rng(8)
        os.mkdir("recorded")
        for n in range(6):
            camera = random.integers(0, 256, (20, 4, 4, 3), np.uint8)
            np.savez(f"recorded/{n}.npz", camera=camera, x=camera.mean(axis=(1, 2, 3)))
        Path("look.etl").write_text(OWN.replace("<= 0.0001", "<= calibrated(f1)").replace(
            "monitor near = F", "predicate close =").replace("target", "input x : f32;\ntarget")
            + "truth close = x <= 127;\nmonitor near = F close;\n")  # fmt: skip
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            etlc.embed("look.etl", "recorded", output="all", encoder=Mean(self.weights))
            etlc.calibrate("look.etl", "all", allow_overlap="the frames are noise")
            etlc.Monitor("look.etl").close()
            Path("mine.model").unlink()
            etlc.embed("look.etl", "recorded", output="all", encoder=Mean(self.weights, 256))
            self.refused("E0652", lambda: etlc.Monitor("look.etl"),
                         "the model and settings of encoder mine changed")  # fmt: skip
            etlc.calibrate("look.etl", "all", allow_overlap="the frames are noise")
            etlc.Monitor("look.etl").close()

    def test_etlc_without_the_process_refuses(self):
        self.embedded(OWN, encoder=Mean(self.weights))
        self.refused("E1012", lambda: etlc.embed("look.etl"), "stands for a model in Python")
        with self.assertRaisesRegex(etlc.SpecError, "stands for a model in Python|E1017"):
            etlc.Encoder("look.etl")

    def test_mistakes_of_the_model(self):
        def fails(image):
            raise ZeroDivisionError("in the model")

        Path("look.etl").write_text(OWN)
        with self.assertRaisesRegex(ZeroDivisionError, "in the model"):
            self.embedded(OWN, encoder=fails)
        self.assertFalse(Path("mine.model").exists())
        for model, words in (
            (lambda image: image, "returned an array of uint8"),
            (lambda image: np.zeros((2, 4), "f4"), r"expected floats of the shape \(D,\)"),
            (lambda image: None, "returned"), (lambda image: "z", "returned"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words):
                self.embedded(OWN, encoder=model)
        with self.assertRaisesRegex(etlc.SpecError, "E1014|dimension"):
            self.embedded(OWN, encoder=lambda image: np.zeros(3, "f4"))
        with self.assertRaisesRegex(etlc.SpecError, "nan"):
            self.embedded(OWN, encoder=lambda image: np.full(4, np.nan, "f4"))

    def test_models_that_cannot_be_recognised(self):
        import threading

        model = Mean(self.weights)
        model.lock = threading.Lock()
        with self.assertRaisesRegex(etlc.InputError, r"\.lock is .*cannot pickle"):
            self.embedded(OWN, encoder=model)
        with self.assertRaisesRegex(etlc.InputError, "exclude each other"):
            self.embedded(OWN, encoder=Mean(self.weights), encoder_command="cat")
        with self.assertRaisesRegex(etlc.InputError, "is for other, the spec has mine"):
            self.embedded(OWN, encoder={"other": Mean(self.weights)})
        self.embedded(OWN, encoder={"mine": Mean(self.weights)})

    def test_the_hash_is_the_same_in_every_process(self):
        program = Path("program.py")
        program.write_text(textwrap.dedent(f"""
            import abc
            import dataclasses
            import functools
            import sys
            import numpy as np
            import own
            from etlc._models import identity_of
            sys.path.insert(0, {str(Path(__file__).parent)!r})
            class Model:
                def __init__(self):
                    self.words = {{"a", "b", "c", "d"}}
                    self.weights = np.arange(6.0)
                    self.itself = self
                def __call__(self, image):
                    '''Comments do not count.'''
                    return helper(image) * self.weights + cached(2)
            @functools.lru_cache
            def cached(x):
                return x + 1.5
            def helper(image):
                return image.mean() if "x" in {{"x", "y", "z"}} else LIMIT
            LIMIT = 3
            @dataclasses.dataclass
            class Settings(abc.ABC):
                "How it scales."
                scale: float = 2.0
                names: list = dataclasses.field(default_factory=list)
            def local(image):
                from beside import scaled
                import beside.deeper
                import no_such_module_at_all
                return beside.deeper.depth * scaled(image) * OTHER.scale
            OTHER = Settings(3.0)
            word = lambda image: "right"
            try:
                assert sys.argv[1:]
                import torch
                torch.manual_seed(3)
                net = torch.nn.Sequential(torch.nn.Conv2d(3, 4, 3), torch.nn.BatchNorm2d(4)).eval()
            except (AssertionError, ImportError):
                net = None
            print(identity_of([Model(), net, local, word, lambda: own.used()]))
        """))  # fmt: skip
        Path("own.py").write_text("def used():\n    return LEVEL + 1\nLEVEL = 4\nspare = 5\n")
        Path("beside").mkdir()
        Path("beside/__init__.py").write_text("from .deeper import scaled\n")
        Path("beside/deeper.py").write_text("depth = 3\ndef scaled(x):\n    return x * 2.5\n")
        found = set()
        for seed in ("1", "2", "3"):
            ran = subprocess.run([sys.executable, "-B", program, "torch"], capture_output=True,
                                 text=True, env={**os.environ, "PYTHONHASHSEED": seed})  # fmt: skip
            self.assertEqual(ran.returncode, 0, ran.stderr)
            found.add(ran.stdout)
        self.assertEqual(len(found), 1, found)
        found = {subprocess.check_output([sys.executable, "-B", program], text=True)}
        Path("own.py").write_text(Path("own.py").read_text().replace("spare = 5", "spare = 6"))
        for old, new in (("Comments do not", "Nothing does not"), ("# none", "")):
            text = program.read_text()
            program.write_text(text.replace(old, new))
            found.add(subprocess.check_output([sys.executable, "-B", program], text=True))
        self.assertEqual(len(found), 1, found)
        self.assertIn(f"numpy {np.__version__}\npython 3.", found.pop())
        changes = (("LIMIT = 3", "LIMIT = 4"), ("image.mean()", "image.max()"), ("6.0", "7.0"),
                   ("x + 1.5", "x + 2.5"), ("Settings(3.0)", "Settings(4.0)"),
                   ('"right"', '"left"'), ("scale: float = 2.0", "scale: float = 9.0"),
                   ('"d"', '"e"'), ('"z"', '"w"'))  # fmt: skip
        for old, new in changes:
            program.write_text(text.replace(old, new))
            found.add(subprocess.check_output([sys.executable, "-B", program], text=True))
        program.write_text(text)
        files = (("own.py", "4", "5"), ("own.py", "+ 1", "+ 2"), ("beside/deeper.py", "3", "4"),
                 ("beside/deeper.py", "2.5", "2.6"))  # fmt: skip
        for path, old, new in files:
            before = Path(path).read_text()
            Path(path).write_text(before.replace(old, new))
            found.add(subprocess.check_output([sys.executable, "-B", program], text=True))
            Path(path).write_text(before)
        self.assertEqual(len(found), len(changes) + len(files))

    @unittest.skipIf(torch is None, "torch is not installed")
    def test_a_model_of_torch(self):
        torch.manual_seed(3)
        net = torch.nn.Sequential(
            torch.nn.Conv2d(3, 4, 3, stride=2), torch.nn.BatchNorm2d(4), torch.nn.ReLU(),
            torch.nn.AdaptiveAvgPool2d(1), torch.nn.Flatten(),
        ).eval()  # fmt: skip

        def encode(image):
            with torch.no_grad():
                return net(torch.from_numpy(image).permute(2, 0, 1)[None] / 255)

        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.embedded(OWN, encoder=encode)
        with etlc.Encoder("look.etl", encoder=encode) as encoder:
            found = encoder(self.images)
        self.assertEqual(found.tobytes(), np.load("episodes/one.npz")["z"].tobytes())

        def changed(change):
            change()
            return self.refused("E1017", lambda: self.embedded(OWN, encoder=encode))

        state = {name: value.clone() for name, value in net.state_dict().items()}
        for name in state:  # every number counts, buffers too
            changed(lambda: net.state_dict()[name].view(-1)[-1:].add_(1))
            net.load_state_dict(state)
        changed(net.train)
        net.eval()
        changed(lambda: setattr(net[0], "stride", (1, 1)))
        net[0].stride = (2, 2)
        changed(lambda: net.register_forward_hook(lambda *_: None))
        net._forward_hooks.clear()
        self.embedded(OWN, encoder=encode)
        with_gradient = lambda image: net(torch.zeros(1, 3, 9, 9))  # noqa: E731
        Path("mine.model").unlink()
        with self.assertRaisesRegex(etlc.InputError, "requires grad"):
            self.embedded(OWN, encoder=with_gradient)


if __name__ == "__main__":
    unittest.main()
