#!/usr/bin/env python3
"""watch_test.py ETLC: what `etlc watch` says of videos and of live sources, and when."""
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time

from camera import BY_COMMAND, DARK, LIGHT, RATE, SPEC, Camera, Clock, Watch, at_rate, blinking, \
    changes_of, make_encoder, make_project, run, write_video


ETLC = sys.argv[1]
NO_RATE = SPEC.replace("rate 30 Hz;\n", "").replace("500 ms", "15")


def expected_changes(levels):
    """Returns (frame, status) of the sliding monitor `now`."""
    said, before = [], None
    for frame, level in enumerate(levels):
        if level != before:
            said.append((frame, "satisfied" if level == LIGHT else "violated"))
        before = level
    return said


def first_frame_of(said, levels):
    """Returns the frame that was step 0: the decoder may take the first ones to learn what they
    are. The changes that follow tell."""
    wanted = expected_changes(levels)
    for first in range(RATE):
        shown = [(step + first, what) for step, what in said if what != "unknown"]
        if [one for one in shown if one[0] < len(levels)][-5:] == wanted[-5:]:
            return first
    raise AssertionError((said, wanted))


def a_file_is_as_embed_and_run():
    """A video is watched at its own speed, and its verdicts are those of `embed` and `run`."""
    levels = blinking(90)
    for spec in (SPEC, SPEC.replace("rate 30 Hz", "rate 10 Hz"), NO_RATE):
        with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
            write_video(folder, levels)
            make_project(folder, ETLC, spec, "--data", "video.mp4", "-o", "episodes")
            begun = clock.now
            lines, errors, status = Watch(clock, ETLC, folder, "--video", "video.mp4").end()
            assert 87 / RATE < clock.now - begun, clock.now - begun
            said = run(ETLC, folder, "run", "look.etl", "--trace", "episodes/video.npz",
                       "--changes", "--summary")
            assert status == said.returncode == 0, (errors, said)
            assert re.match(r"\d+ frames$", lines[-1]), lines[-1]
            assert lines[:-1] == said.stdout.splitlines(), (lines, said.stdout)
            if "rate 10" not in spec:
                assert changes_of(lines, "now") == expected_changes(levels), lines


def a_slow_encoder_loses_no_frame_of_a_file():
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        levels = blinking(30)
        write_video(folder, levels)
        make_encoder(folder, seconds=0.06)
        make_project(folder, ETLC, SPEC, *BY_COMMAND)
        begun = clock.now
        lines, errors, _ = Watch(clock, ETLC, folder, "--video", "video.mp4", *BY_COMMAND).end()
        assert clock.now - begun > 29 * 0.06, clock.now - begun
        assert changes_of(lines, "now") == expected_changes(levels), (lines, errors)
        assert lines[-1] == "30 frames", (lines, errors)


def a_camera_that_pauses():
    """Every change is said once, at its step, before the next frame; a pause is steps without
    samples."""
    levels, begin = blinking(90, 12), 5
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        make_project(folder, ETLC)
        clock.hold()
        camera = Camera(clock, folder, at_rate(levels) + at_rate(levels, begin=begin))
        watch = Watch(clock, ETLC, folder, "--video", "camera")
        lines, times = [], []
        while watch.process.poll() is None:
            clock.advance(1 / RATE)
            new = watch.lines_so_far()
            lines += new
            times += [clock.now] * len(new)
        _, errors, status = watch.end()
    assert status == 0 and not errors, (status, errors)
    assert len(set(lines)) == len(lines), lines
    said = changes_of(lines, "now")
    first = first_frame_of(said, levels)
    assert (len(levels) - first, "unknown") in said, said
    again = changes_of(lines, "input z")[-1]
    assert again[1] == "is there again" and abs(again[0] + first - begin * RATE) <= 1, again
    delays = [at - camera.begun - (int(re.match(r"step (\d+)", line)[1]) + first) / RATE
              for at, line in zip(times, lines) if re.match(r"step \d+ .*: now (viol|sat)", line)]
    assert max(delays) < 2 / RATE, delays


def a_camera_that_freezes():
    """It repeats its frame to the bit, and `stale after` counts that as missing."""
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        make_project(folder, ETLC, SPEC.replace("f32[3] by net", "f32[3] by net, stale after 5"))
        Camera(clock, folder, at_rate(blinking(30, 1) + [LIGHT] * 30 + blinking(30, 1)))
        lines, errors, status = Watch(clock, ETLC, folder, "--video", "camera").end()
    assert status == 0 and not errors, (status, errors)
    said = [what for _, what in changes_of(lines, "input z")][-2:]
    assert said == ["is stale", "is there again"], lines


def a_slow_encoder_shifts_nothing():
    """Frames that are left out are steps without samples: the others stay at their times."""
    light_from, frames = 60, 120
    levels = [DARK] * light_from + [LIGHT] * (frames - light_from)
    for spec in (SPEC, NO_RATE):
        with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
            make_encoder(folder, seconds=0.1)
            make_project(folder, ETLC, spec, *BY_COMMAND)
            Camera(clock, folder, at_rate(levels))
            watch = Watch(clock, ETLC, folder, "--video", "camera", *BY_COMMAND)
            lines, errors, status = watch.end()
        assert status == 0 and not errors, (status, errors)
        steps = int(re.match(r"(\d+) steps", lines[-3])[1])
        missing = int(re.match(r"input z: (\d+) missing", lines[-2])[1])
        came, dropped = map(int, re.match(
            r"(\d+) frames, (?:\d+ more than the steps need, )?(\d+) dropped", lines[-1]).groups())
        assert abs(steps - came) <= (3 if spec == SPEC else 0), lines[-3:]
        assert dropped > came / 2 and abs(missing - dropped) <= 3, lines[-3:]
        lost = frames - came  # at the beginning
        light = [step for step, what in changes_of(lines, "now") if what == "satisfied"][0]
        assert 0 <= light + lost - light_from <= 6, (light, lost)


def a_camera_of_another_rate():
    """A camera may be faster or slower than the steps of the spec: they are those of its times."""
    for rate in (60, 15):
        with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
            make_project(folder, ETLC)
            seconds = 3
            levels = [DARK] * rate + [LIGHT] * (seconds - 1) * rate
            Camera(clock, folder, at_rate(levels, rate), rate)
            lines, errors, status = Watch(clock, ETLC, folder, "--video", "camera").end()
        assert status == 0 and not errors, (status, errors)
        steps = int([line for line in lines if re.match(r"\d+ steps$", line)][0].split()[0])
        came = int(lines[-1].split()[0])
        assert abs(steps - came * RATE / rate) <= 4, lines
        lost = (len(levels) - came) * RATE / rate
        light = [step for step, what in changes_of(lines, "now") if what == "satisfied"][0]
        assert abs(light + lost - RATE) <= 3, (light, lost, lines)


def a_stream():
    """An address is watched as a pipe is, until the other side ends."""
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        make_project(folder, ETLC)
        levels = [DARK] * 60 + [LIGHT] * 60
        write_video(folder, levels)
        with socket.socket() as unused:
            unused.bind(("127.0.0.1", 0))
            port = unused.getsockname()[1]
        address = f"tcp://127.0.0.1:{port}"
        sender = clock.start("ffmpeg", "-v", "error", "-re", "-i", "video.mp4", "-c:v", "libx264",
                             "-tune", "zerolatency", "-f", "mpegts", address + "?listen=1",
                             cwd=folder)
        while f":{port:04X} 00000000:0000 0A" not in pathlib.Path("/proc/net/tcp").read_text():
            assert sender.poll() is None, "the sender has ended"
            time.sleep(0.01)  # it does not listen yet
        lines, errors, status = Watch(clock, ETLC, folder, "--video", address).end()
        sender.wait()
    assert status == 0 and not errors, (status, errors)
    light = [step for step, what in changes_of(lines, "now") if what == "satisfied"]
    came = int(re.match(r"(\d+) frames", lines[-1])[1])
    assert abs(light[0] - (60 - (len(levels) - came))) <= 3, (light, came, lines)


def a_trace_as_it_comes():
    """A row is judged when it comes; the end of input and Ctrl-C end it, and a cut row does not
    count."""
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        make_project(folder, ETLC)
        levels = blinking(40)
        rows = [",".join([str(level / 255)] * 3) for level in levels]
        head = "z[0],z[1],z[2]\n"
        (pathlib.Path(folder) / "trace.csv").write_text(head + "\n".join(rows) + "\n")
        said = run(ETLC, folder, "run", "look.etl", "--trace", "trace.csv", "--changes",
                   "--summary")
        text = (pathlib.Path(folder) / "trace.csv").read_text()
        watched = run(ETLC, folder, "watch", "look.etl", "--trace", "-", input=text)
        assert watched.stdout == said.stdout and watched.returncode == 0, (watched, said)
        assert "W1001" in watched.stderr, watched.stderr

        watch = Watch(clock, ETLC, folder, "--trace", "-", stdin=subprocess.PIPE)
        before = None
        for step, (row, level) in enumerate(zip(rows, levels)):
            watch.write((head if step == 0 else "") + row + "\n")
            if level != before:
                watch.lines_until(f"step {step} ({step / RATE:.6g} s): now ")
            before = level
        watch.write("0.9,0.9")
        clock.settle()
        lines, _, status = watch.stop(signal.SIGTERM)
        assert status == 0 and f"{len(rows)} steps" in lines, (status, lines)


def main():
    a_file_is_as_embed_and_run()
    a_slow_encoder_loses_no_frame_of_a_file()
    a_camera_that_pauses()
    a_camera_that_freezes()
    a_slow_encoder_shifts_nothing()
    a_camera_of_another_rate()
    a_stream()
    a_trace_as_it_comes()


main()
