#!/usr/bin/env python3
"""bad_input_test.py ETLC: sources, encoders and calls of `etlc watch` that are wrong."""
import io
import os
import pathlib
import signal
import socket
import sys
import tempfile

from PIL import Image

from camera import BY_COMMAND, DARK, LIGHT, RATE, SPEC, Camera, Clock, Watch, at_rate, \
    make_encoder, make_project, run, write_video

ETLC = sys.argv[1]


def refused(folder, status, *words, what, **more):
    """The call fails with this status, soon, and says all of `what`."""
    done = run(ETLC, folder, "watch", *words, **more)
    assert done.returncode == status, (words, done)
    for part in what:
        assert part in done.stderr, (words, part, done.stderr)
    return done


def sources(folder):
    path = pathlib.Path(folder)
    (path / "empty.mp4").write_bytes(b"")
    (path / "words.mp4").write_text("no video\n" * 100)
    (path / "folder").mkdir()
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        port = unused.getsockname()[1]
    for source, what in {
            "missing.mp4": ["missing.mp4", "[E1010]"],
            "/dev/video97": ["/dev/video97", "[E1010]"],
            "folder": ["folder", "[E1010]"],
            "empty.mp4": ["empty.mp4", "[E1010]"],
            "words.mp4": ["words.mp4", "is no video", "[E1010]"],
            "/dev/null": ["/dev/null", "cannot be opened as video", "[E1010]"],
            "file:///etc/passwd": ["cannot be opened as video", "[E1010]"],
            "nonsense://camera": ["cannot be opened as video", "[E1010]"],
            f"tcp://127.0.0.1:{port}": ["cannot be opened as video", "refused", "[E1010]"],
            }.items():
        refused(folder, 1, "look.etl", "--video", source, what=what)
    refused(folder, 1, "look.etl", "--video", "video.mp4", what=["[E1016]", "libavformat-dev"],
            env={**os.environ, "ETLC_EMBEDDER": "/nothing"})
    other = SPEC.replace("rate 30 Hz", "rate 7 Hz").replace("500 ms", "1")
    (path / "other.etl").write_text(other)
    refused(folder, 1, "other.etl", "--video", "video.mp4", "--embedded", "look.embedded.npz",
            what=["30 frames a second, expected a multiple of the 7 steps", "[E1011]"])


def another_size(folder, clock):
    """A stream whose frames change their size ends the call, after the summary."""
    def jpeg(size):
        file = io.BytesIO()
        Image.new("RGB", size, (200, 200, 200)).save(file, "jpeg")
        return file.getvalue()
    camera = Camera(clock, folder, at_rate([(64, 48)] * 40 + [(32, 24)] * 20), head=b"",
                    frame_of=jpeg)
    lines, errors, status = Watch(clock, ETLC, folder, "--video", "camera").end()
    os.unlink(camera.path)
    assert status == 1 and "from 64 x 48 to 32 x 24" in errors and "[E1010]" in errors, errors
    assert any(line.startswith("seen: satisfied for good") for line in lines), lines


def encoders(folder, clock):
    """What makes the embeddings is what made those of the spec, or nothing is watched."""
    path = pathlib.Path(folder)
    video = ("look.etl", "--video", "video.mp4")
    make_encoder(folder)
    refused(folder, 1, *video, *BY_COMMAND, what=["[E1017]"])  # a network made those of the spec
    model = (path / "net.onnx").read_bytes()
    (path / "net.onnx").write_bytes(model + b"\0")
    refused(folder, 1, *video, what=["net.onnx", "[E1004]"])
    (path / "net.onnx").write_bytes(model)
    make_project(folder, ETLC, SPEC, *BY_COMMAND)
    refused(folder, 1, *video, what=["[E1017]"])
    assert run(ETLC, folder, "watch", *video, *BY_COMMAND).returncode == 0
    make_encoder(folder, shift=0.01)
    refused(folder, 1, *video, *BY_COMMAND, what=["of reference frame 0 they differ by", "[E1017]"])
    make_encoder(folder, times=2)
    refused(folder, 1, *video, *BY_COMMAND, what=["wrote more than", "[E1013]"])
    refused(folder, 1, *video, "--encoder-cmd", "exit 3", what=["exit status 3", "[E1013]"])
    script = (path / "encode.py").read_text()
    (path / "encode.py").write_text(script.replace("time.sleep", "sys.exit"))
    ended = refused(folder, 1, *video, *BY_COMMAND, what=["ended too soon", "[E1013]"])
    assert "0 steps" in ended.stdout, ended
    # One that does not write what it has is waited for, and Ctrl-C ends that.
    (path / "encode.py").write_text(script.replace("embeddings.write(z", "bytes(z"))
    clock.hold()
    watch = Watch(clock, ETLC, folder, "--video", "video.mp4", *BY_COMMAND)
    clock.advance(1)
    _, errors, status = watch.stop(signal.SIGINT)
    assert status == 0 and not errors, (status, errors)
    watch = Watch(clock, ETLC, folder, *video[1:], *BY_COMMAND, "--encoder-timeout", "9")
    clock.advance(8.9)
    assert watch.process.poll() is None
    clock.advance(1.2)
    _, errors, status = watch.end()
    assert status == 1, status
    for part in "no embedding of a frame for 9 seconds", "flush", "[E1013]":
        assert part in errors, errors


def calls(folder):
    path = pathlib.Path(folder)
    (path / "more.etl").write_text(SPEC + "input charge : f32;\nmonitor full = G charge > 0.1;\n")
    (path / "bare.etl").write_text("spec bare; input x : f32; monitor m = G x > 0;\n")
    refused(folder, 1, "more.etl", "--video", "video.mp4", "--embedded", "look.embedded.npz",
            what=["'charge' is made by no encoder", "--trace -", "[E0804]"])
    (path / "two.etl").write_text(SPEC + "input y : f32[3] by net;\n"
                                  "monitor alike = G l2(y, bright) < 9;\n")
    refused(folder, 1, "two.etl", "--video", "video.mp4", "--embedded", "look.embedded.npz",
            what=["'y' is by the encoder of another input", "[E1002]"])
    refused(folder, 1, "look.etl", "--trace", "-", "-Werror", what=["[W1001]"], input="z[0]\n")
    refused(folder, 1, "bare.etl", "--video", "video.mp4", what=["'x' is made by no encoder"])
    video = ("look.etl", "--video", "video.mp4")
    refused(folder, 2, "look.etl", what=["--video SOURCE", "--trace -"])
    refused(folder, 2, *video, "--trace", "-", what=["--video excludes --trace"])
    refused(folder, 2, "look.etl", "--trace", "t.csv", what=["'t.csv'", "etlc run"])
    refused(folder, 2, *video, "--recorder", "1,1,1", what=["--recorder needs --record"])
    refused(folder, 2, *video, "--map", "z=y", what=["--map", "--video has none"])
    refused(folder, 2, "look.etl", "--trace", "-", *BY_COMMAND, what=["--encoder-cmd", "--video"])
    for port in ("0", "65536", "x"):
        refused(folder, 2, *video, "--page", port, what=[f"'{port}'", "from 1 to 65535"])
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        refused(folder, 1, *video, "--page", port, what=[f"port {port}", "another program"])
    (path / "file").write_text("")
    refused(folder, 1, *video, "--record", "file/x", what=["file/x", "cannot be made", "[E0901]"])


def a_reader_that_goes(folder, clock):
    """Nobody reads the lines any more: the call ends, as any other does."""
    Camera(clock, folder, at_rate([DARK, LIGHT] * 300))
    watch = Watch(clock, ETLC, folder, "--video", "camera")
    watch.line()
    watch.process.stdout.close()
    begun = clock.now
    assert watch.process.wait() != 0
    assert clock.now - begun < 100 / RATE, "it ends long before the source"
    watch.process.stderr.close()


def main():
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        write_video(folder, [DARK] * 5 + [LIGHT] * 5)
        make_project(folder, ETLC)
        sources(folder)
        another_size(folder, clock)
        calls(folder)
        a_reader_that_goes(folder, clock)
        encoders(folder, clock)


main()
