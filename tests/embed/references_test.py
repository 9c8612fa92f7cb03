"""references_test.py ETLC SOURCE CXX: a robot encodes the reference frames that `etlc embed`
writes. The class, in any flavour of floating point and on a Cortex-M4F, and Python say that its
encoder agrees where only float32 is rounded otherwise, and that it does not where one step of the
preparation, or the model, is another one."""
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

import exports
import numpy as np
import onnx_encoder
from networks import DEVIATION, MEAN
from PIL import Image

import etlc

ETLC, SOURCE, CXX = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), sys.argv[3]
BOARDS = os.path.join(SOURCE, "examples/firmware_loop")
FRAMES = 4
SPEC = """spec t;
encoder net = load("{model}"), {changed} image [32, 32], mean {mean}, deviation {deviation};
input z : f32[40] by net;
target frames = images("frames/reference-*.png") by net;
monitor m = F min l2(z, frames) <= 1;
"""
ROBOT = """#include "board.hpp"
#include "rows.hpp"
#include "t.hpp"
int main() {
  for (const auto& way : rows)
    for (unsigned frame = 0; frame < 4; ++frame)
      board_write(t::Monitor::encoder_agrees(frame, etlmon::Vector<float, 40>(way[frame]))
                      ? "yes\\n" : "no\\n");
  const bool beyond = t::Monitor::encoder_agrees(4, etlmon::Vector<float, 40>(rows[0][0]));
  const bool missing = t::Monitor::encoder_agrees(0, etlmon::Vector<float, 40>());
  const bool strict = t::Monitor::encoder_agrees(0, etlmon::Vector<float, 40>(rows[0][0]), -1.0f);
  board_write(beyond || missing || strict ? "yes\\n" : "no\\n");
  board_exit(0);
}
"""
PORTABLE = "-std=c++17 -Wall -Wextra -Werror".split()
FLAVOURS = [["-O0"], ["-O2", "-march=native"], ["-O2", "-ffast-math"],
            ["-O3", "-Ofast", "-march=native"]]
CORTEX_M4 = ("arm-none-eabi-g++ -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -Os "
             "-ffreestanding -fno-exceptions -fno-rtti -fno-math-errno -fno-threadsafe-statics "
             "-nostartfiles").split()


def call(*words, **environment):
    done = subprocess.run(words, capture_output=True, text=True, env=os.environ | environment)
    assert done.returncode == 0, (words, done.stdout, done.stderr)
    return done.stdout


def embeddings_of_frames(name, *words, changed="", model="net.onnx", mean=MEAN):
    """What an encoder makes of the frames on disk: FRAMES x 40."""
    with open(f"{name}.etl", "w") as spec:
        spec.write(SPEC.format(changed=changed, model=model, mean=list(mean),
                               deviation=list(DEVIATION)))
    call(ETLC, "embed", f"{name}.etl", *words)
    return np.load(f"{name}.embedded.npz")["rows-1"]


def own_command():
    words = ["/usr/bin/python3", onnx_encoder.__file__, "32", "32"]
    return " ".join(words + [",".join(map(str, numbers)) for numbers in (MEAN, DEVIATION)])


def ways():
    """Returns the embeddings of robots with the same encoder, and of robots with another one."""
    same = {"again": embeddings_of_frames("again"),
            "numpy": embeddings_of_frames("own", "--encoder-cmd", own_command())}
    assert (same["again"] != same["numpy"]).any(), "another runtime rounds otherwise"
    exact = same["again"]
    broken = exact.copy()
    broken[:, 7] = np.nan
    infinite = exact.copy()
    infinite[:, 0] = np.inf
    exports.mobilenet("other.onnx", np.random.default_rng(8))
    other = {what: embeddings_of_frames("other", changed=changed)
             for what, changed in (("BGR", "channels bgr,"), ("mirrored", "flip horizontal,"),
                                   ("upside down", "flip vertical,"),
                                   ("bilinear", "resize bilinear,"),
                                   ("bicubic", "resize bicubic,"),
                                   ("crop", "resize bilinear [36],"),
                                   ("another crop", "resize bilinear [37],"))}
    other |= {"mean": embeddings_of_frames("other", mean=[m + 0.01 for m in MEAN]),
              "another model": embeddings_of_frames("other", model="other.onnx"),
              "another frame": np.roll(exact, 1, axis=0), "zero": 0 * exact, "nan": broken,
              "infinite": infinite, "reversed": exact[:, ::-1]}
    return same, other


def says_the_class(build, run, rows):
    with open("rows.hpp", "w") as header:
        header.write("#include <cmath>\n" + f"static const float rows[{len(rows)}][4][40] = {{")
        for way in rows:
            header.write("{" + ",".join("{" + ",".join(map(literal, row)) + "}" for row in way) +
                         "},\n")
        header.write("};\n")
    with open("robot.cpp", "w") as program:
        program.write(ROBOT)
    call(*build, "-I.", "-I" + BOARDS, f"-I{SOURCE}/runtime/include", "robot.cpp")
    return run().split()


def literal(number):
    if not np.isfinite(number):
        return "NAN" if np.isnan(number) else "INFINITY"
    return float(number).hex() + "f"


def on_this_machine():
    return call("./robot")


def on_cortex_m4():
    subprocess.run(["qemu-system-arm", "-M", "mps2-an386", "-nographic", "-monitor", "none",
                    "-serial", "none", "-chardev", "file,id=text,path=said.txt",
                    "-semihosting-config", "enable=on,target=native,chardev=text", "-kernel",
                    "robot"], check=True, timeout=60, stdin=subprocess.DEVNULL)
    with open("said.txt") as said:
        return said.read()


def damaged_references_are_refused(kept):
    """Every file has them, of the right shape and type."""
    with zipfile.ZipFile("t.embedded.npz") as archive:
        whole = {name: archive.read(name) for name in archive.namelist()}
    shape = "has the shape {} x {}, expected 4 x 40"
    nan = kept.copy()
    nan[2, 3] = np.nan

    def write(path, members):
        with zipfile.ZipFile(path, "w") as archive:
            for name, content in members.items():
                archive.writestr(name, content)

    for rows, fault in ((kept[:3], shape.format(3, 40)), (kept[:, 1:], shape.format(4, 39)),
                        (nan, "references-1"), (kept.astype("f8"), "references-1")):
        member = io.BytesIO()
        np.save(member, rows)
        write("damaged.npz", whole | {"references-1.npy": member.getvalue()})
        done = subprocess.run([ETLC, "t.etl", "--check", "--embedded", "damaged.npz"],
                              capture_output=True, text=True)
        assert done.returncode == 1 and fault in done.stderr, (fault, done.stderr)
    entries = json.loads(whole["embedded.json"])
    del entries["encoders"]["net"]["references"], whole["references-1.npy"]
    write("without.npz", whole | {"embedded.json": json.dumps(entries)})
    done = subprocess.run([ETLC, "t.etl", "--check", "--embedded", "without.npz"],
                          capture_output=True, text=True)
    assert "key 'encoders.net.references' is missing" in done.stderr, done.stderr


def shapes(*words):
    """The shape of a retargetable class, which says what parameters it takes."""
    return re.findall("kShape = (.*);", call(ETLC, "t.etl", "--retargetable", *words, "-o", "-"))


def main():
    exports.mobilenet("net.onnx", np.random.default_rng(7))
    os.mkdir("frames")
    Image.new("RGB", (32, 32)).save("frames/reference-0.png")  # the spec needs an image
    embeddings_of_frames("first", "--write-reference", "frames")
    frames = [np.asarray(Image.open(f"frames/reference-{i}.png")) for i in range(FRAMES)]
    assert all(frame.shape == (480, 640, 3) for frame in frames)
    kept = np.load("first.embedded.npz")["references-1"]
    embeddings_of_frames("t")
    same, other = ways()
    assert (kept == same["again"]).all(), "the files have the pixels that etlc encoded"
    call(ETLC, "t.etl", "-o", "t.hpp")

    assert shapes() == shapes("--embedded", "own.embedded.npz") != [], "other rounding, same class"
    damaged_references_are_refused(kept)

    rows = list(same.values()) + list(other.values())
    expected = ["yes"] * FRAMES * len(same) + ["no"] * (FRAMES * len(other) + 1)
    names = [f"{name}, frame {i}" for name in [*same, *other] for i in range(FRAMES)]
    builds = [(f, [CXX, *PORTABLE, *f, f"{BOARDS}/boards/host.cpp", "-o", "robot"],
               on_this_machine) for f in FLAVOURS]
    if shutil.which("arm-none-eabi-g++") and shutil.which("qemu-system-arm"):
        board = f"{BOARDS}/boards/cortex_m4"
        builds.append(("Cortex-M4F", CORTEX_M4 + PORTABLE + ["-T", f"{board}.ld", f"{board}.cpp",
                                                             "-lm", "-o", "robot"], on_cortex_m4))
    for flavour, build, run in builds:
        said = says_the_class(build, run, rows)
        assert said == expected, (flavour, [(n, s) for n, s, e in zip(names + ["arguments"], said,
                                                                      expected) if s != e])

    monitor = etlc.Monitor("t.etl")
    for name, way in (same | other).items():
        for frame, z in enumerate(way):
            agrees = monitor.encoder_agrees(frame, z)
            assert agrees is (name in same), (name, frame, monitor.encoder_difference(frame, z))
            estimate = monitor.encoder_difference(frame, z, "net")
            exact = np.linalg.norm(z.astype(float) - kept[frame]) / np.linalg.norm(
                kept[frame].astype(float))
            assert np.isclose(estimate, exact if np.isfinite(exact) else np.inf), (name, estimate)
    for arguments, fault in (((4, kept[0]), "expected 0 to 3"),
                             ((0, kept[0][:9]), "embedding has 9 elements, encoder 'net' makes 40"),
                             ((0, kept[0], "net2"), "no encoder 'net2'")):
        try:
            monitor.encoder_agrees(*arguments)
        except etlc.InputError as error:
            assert fault in str(error), error
        else:
            raise AssertionError(arguments)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
    os.chdir("/")
