"""without_onnxruntime_test.py ETLC: where etlc was built without ONNX Runtime, models that it shall
run are refused by a line that says what to do, and nothing is written."""
import os
import subprocess
import sys
import tempfile

import numpy as np
from networks import Convolutional
from PIL import Image

ETLC = os.path.abspath(sys.argv[1])
SPEC = """spec t;
encoder net = load("net.onnx");
input z : f32[4] by net;
target bay = images("bay.png") by net;
monitor m = F min l2(z, bay) <= 1;
"""


def call(*words, status):
    done = subprocess.run([ETLC, "embed", "t.etl", *words], capture_output=True, text=True)
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stderr


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    random = np.random.default_rng(2)
    Convolutional("net.onnx", random)
    Image.fromarray(random.integers(0, 256, (8, 6, 3), dtype=np.uint8)).save("bay.png")
    open("t.etl", "w").write(SPEC)
    said = call("--runtime", "onnxruntime", "--data", "bay.png", "-o", "out", status=1)
    for words in ("net.onnx: error: is not run by ONNX Runtime", "-DCMAKE_PREFIX_PATH", "[E1016]"):
        assert words in said, (words, said)
    assert not os.path.exists("t.embedded.npz") and not os.listdir("out")
    call("--runtime", "opencv", status=0)
    os.chdir("/")
