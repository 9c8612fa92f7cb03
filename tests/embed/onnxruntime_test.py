"""onnxruntime_test.py ETLC: ONNX Runtime is taken from the call, the environment, pip, npm or the
system, in this order; its version is part of fingerprints; a missing library, or a wrong one, is an
error, and nothing is written."""
import json
import os
import pathlib
import shutil
import stat
import subprocess
import sys
import tempfile

import numpy as np
from networks import Convolutional
from PIL import Image

ETLC = os.path.abspath(sys.argv[1])
EMBEDDER = os.path.join(os.path.dirname(ETLC), "etlc-embed")
GIVEN = os.environ.pop("ETLC_ONNXRUNTIME")
SPEC = """spec t;
encoder net = load("net.onnx");
input z : f32[4] by net;
target bay = images("bay.png") by net;
monitor m = F min l2(z, bay) <= 1;
"""


def library():
    """Returns the library file; the argument may be its folder."""
    found = [GIVEN] if os.path.isfile(GIVEN) else sorted(pathlib.Path(GIVEN).rglob(
        "libonnxruntime.so.*"))
    return os.path.realpath(found[-1])


LIBRARY = library()


def call(*words, status=0, **environment):
    done = subprocess.run([ETLC, "embed", "t.etl", *words], capture_output=True, text=True,
                          env={**os.environ, **environment})
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def found(**environment):
    """Returns the path of the library that etlc-embed loads."""
    done = subprocess.run([EMBEDDER, "onnxruntime"], capture_output=True, text=True,
                          env={**os.environ, **environment})
    assert done.returncode == 0, done.stderr
    version, path = done.stdout.splitlines()
    assert version.startswith("1."), version
    return path


def encoder():
    said = bytes(np.load("t.embedded.npz")["embedded.json"])
    return json.loads(said)["encoders"]["net"]


def placed(path):
    """Copies the library to another place."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    os.symlink(LIBRARY, path)
    return os.path.abspath(path)


def program(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    pathlib.Path(path).write_text("#!/bin/sh\n" + text)
    os.chmod(path, stat.S_IRWXU)


def it_is_found_where_it_is_put():
    own = placed("own/lib/libonnxruntime.so.1.99.0")
    older = placed("own/lib/libonnxruntime.so.1.9.0")
    for where in (own, "own", "own/lib"):
        call("--onnxruntime", where)
    first = encoder()
    assert first["kind"].startswith("ONNX Runtime 1."), first
    call(ETLC_ONNXRUNTIME=own)
    assert encoder() == first
    call("--onnxruntime", "own", ETLC_ONNXRUNTIME="/nowhere")
    assert found(ETLC_ONNXRUNTIME="own") == own, "the highest version"
    assert found(ETLC_ONNXRUNTIME=older) == older

    machine = {"x86_64": "x64", "aarch64": "arm64"}[os.uname().machine]
    of_npm = placed("node_modules/onnxruntime-node/bin/napi-v6/linux/" + machine +
                    "/libonnxruntime.so.1")
    no_python = {"PATH": os.path.abspath("empty") + ":/bin"}
    program("empty/python3", "exit 1\n")
    assert found(**no_python) == of_npm
    program("node/bin/node", "")
    os.mkdir("node/lib")
    os.makedirs("inner/folder", exist_ok=True)
    os.chdir("inner/folder")
    assert found(**no_python) == of_npm, "in a folder further up"
    os.chdir("../..")

    os.makedirs("site/onnxruntime")
    pathlib.Path("site/onnxruntime/__init__.py").write_text("raise ImportError('not imported')\n")
    of_pip = placed("site/onnxruntime/capi/libonnxruntime.so.1.30.0")
    assert found(PYTHONPATH=os.path.abspath("site")) == of_pip
    call(PYTHONPATH=os.path.abspath("site"))
    assert encoder() == first, "wherever it lies"
    os.rename("node_modules", "node/lib/node_modules")
    assert found(PATH="/nowhere:" + os.path.abspath("node/bin") + ":" + no_python["PATH"]) == (
        os.path.abspath(os.path.join("node/lib", os.path.relpath(of_npm))))
    shutil.rmtree("node")

    of_system = placed("system/libonnxruntime.so.1")
    assert found(**no_python, LD_LIBRARY_PATH=os.path.dirname(of_system)) == of_system
    call(**no_python, LD_LIBRARY_PATH=os.path.dirname(of_system))
    assert encoder() == first


def the_version_is_part_of_the_fingerprint():
    """A program in place of etlc-embed, which reports other versions; it encodes an image and the
    four reference frames, the first of them twice."""
    call("--data", "bay.png", "-o", "out", "--onnxruntime", LIBRARY)
    pathlib.Path("t.csv").write_text("")
    row = "\\000\\000\\200\\077" * 4
    fingerprints = set()
    for version in ("1.30.0", "1.30.1", "1.29.0"):
        program("fake/etlc-embed", f"""case $1 in
onnxruntime) printf '{version}\\n/a library\\n' ;;
images) exec {EMBEDDER} "$@" ;;
encode) [ "$3 $4" = "--onnxruntime /a library" ] || exit 9
    cat > /dev/null; printf '\\004\\000\\000\\000{6 * row}' ;;
esac
""")
        call(ETLC_EMBEDDER=os.path.abspath("fake/etlc-embed"))
        assert encoder()["kind"] == f"ONNX Runtime {version}"
        fingerprints.add(encoder()["fingerprint"])
    assert len(fingerprints) == 3, fingerprints
    done = subprocess.run([ETLC, "run", "t.etl", "--trace", "out/bay.npz"], capture_output=True,
                          text=True)
    kind = subprocess.run([EMBEDDER, "onnxruntime", "--onnxruntime", LIBRARY], capture_output=True,
                          text=True).stdout.splitlines()[0]
    assert done.returncode == 1 and "E1017" in done.stderr, done
    assert f"the same model run by ONNX Runtime {kind}" in done.stderr, done.stderr


def what_is_none_is_named():
    for path in ("t.embedded.npz", "out"):
        shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)
    whole = pathlib.Path(LIBRARY).read_bytes()
    pathlib.Path("text.so").write_text("no library\n")
    pathlib.Path("cut.so").write_bytes(whole[: len(whole) // 3])
    foreign = bytearray(whole[:4096])
    foreign[18] ^= 0xFF  # of the ELF head: the processor
    pathlib.Path("foreign.so").write_bytes(foreign)
    source = 'struct Base {{ const void* (*table)(unsigned); const char* (*version)(void); }};\n' \
        'static const void* none(unsigned v) {{ return 0; }}\n' \
        'static const char* version(void) {{ return "1.12.1"; }}\n' \
        'static const struct Base base = {{none, version}};\n' \
        'const struct Base* {}(void) {{ return &base; }}\n'
    for name, function in (("old.so", "OrtGetApiBase"), ("other.so", "another_function")):
        subprocess.run(["g++", "-x", "c", "-shared", "-fPIC", "-o", name, "-"], check=True,
                       input=source.format(function).encode())
    os.mkdir("nothing")
    expected = "expected ONNX Runtime 1.13 or later"
    for where, words in (("/nowhere", ["there is no '/nowhere'"]),
                         ("text.so", ["text.so' is no shared library", expected]),
                         ("foreign.so", ["foreign.so' is for another processor"]),
                         ("cut.so", ["cut.so' is cut"]),
                         ("old.so", ["old.so' is ONNX Runtime 1.12.1", expected]),
                         ("other.so", ["other.so' is another library", expected]),
                         ("nothing", ["'nothing' holds no libonnxruntime.so", expected])):
        for said in (call("--data", "bay.png", "-o", "out", "--onnxruntime", where, status=1),
                     call("--data", "bay.png", "-o", "out", status=1, ETLC_ONNXRUNTIME=where)):
            for word in ["net.onnx: error: is not run: ", "[E1016]", *words]:
                assert word in said, (where, word, said)
            assert not os.path.exists("t.embedded.npz") and not os.path.exists("out"), where
    no_python = {"PATH": os.path.abspath("empty") + ":/bin"}
    if subprocess.run([EMBEDDER, "onnxruntime"], capture_output=True,
                      env={**os.environ, **no_python}).returncode == 0:
        return  # the system has one
    said = call(status=1, **no_python)
    for word in ("pip install onnxruntime", "npm install onnxruntime-node", "--onnxruntime FOLDER",
                 "apt install", "[E1016]"):
        assert word in said, said


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    random = np.random.default_rng(2)
    Convolutional("net.onnx", random)
    Image.fromarray(random.integers(0, 256, (8, 6, 3), dtype=np.uint8)).save("bay.png")
    pathlib.Path("t.etl").write_text(SPEC)
    it_is_found_where_it_is_put()
    the_version_is_part_of_the_fingerprint()
    what_is_none_is_named()
    os.chdir("/")
