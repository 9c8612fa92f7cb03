#!/usr/bin/env python3
"""incidents_test.py ETLC: whatever ends `etlc watch`, the incidents of the alarms that it has said
are in files, which `etlc incident` reads."""
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

from camera import DARK, LIGHT, RATE, Camera, Clock, Watch, at_rate, make_project, run

ETLC = sys.argv[1]
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
ALARM = r"step (\d+) \(\S+ s\): now violated.*: alarm$"


def incidents(folder):
    """Returns the steps and the step of the alarm of each incident, by file."""
    found = {}
    for path in sorted(pathlib.Path(folder, "kept").glob("look-incident-*")):
        said = run(ETLC, folder, "incident", str(path), "--spec", "look.etl", "--format", "csv")
        assert said.returncode == 0, (path, said)
        rows = [line.split(",") for line in said.stdout.splitlines()[1:]]
        alarm = [int(row[0]) for row in rows if row[-1]]
        found[path.name] = ([int(row[0]) for row in rows], alarm)
    return found


def levels_with(alarms, count):
    """Light frames, and five dark ones at each of these."""
    return [DARK if any(0 <= frame - alarm < 5 for alarm in alarms) else LIGHT
            for frame in range(count)]


def at_the_first_alarm(number):
    """Ends the program as soon as it has said an alarm."""
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        make_project(folder, ETLC)
        Camera(clock, folder, at_rate(levels_with([45], 300)))
        watch = Watch(clock, ETLC, folder, "--video", "camera", "--record", "kept", "--recorder",
                      "500ms,500ms,2")
        while not (said := re.match(ALARM, watch.line())):
            pass
        lines, errors, status = watch.stop(number)
        if number != signal.SIGKILL:
            assert status == 0 and not errors, (status, errors)
            assert lines[-1] == "1 incident in kept", lines
        kept = incidents(folder)
        alarm = int(said[1])
        assert list(kept) == ["look-incident-0"], kept
        steps, alarms = kept["look-incident-0"]
        assert alarms == [alarm] and steps[0] == alarm - RATE // 2, (alarm, kept)


def many_alarms():
    """Every incident has its file, also where the recorder has room for one alone; a second call
    replaces none."""
    alarms = [40, 100, 160, 220]
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        make_project(folder, ETLC)
        for call in (1, 2):
            camera = Camera(clock, folder, at_rate(levels_with(alarms, 240)))
            watch = Watch(clock, ETLC, folder, "--video", "camera", "--record", "kept",
                          "--recorder", "10,10,1")
            lines, errors, status = watch.end()
            assert status == 0 and not errors, (status, errors)
            assert lines[-1] == "4 incidents in kept", lines
            said = [int(found[1]) for found in (re.match(ALARM, line) for line in lines) if found]
            kept = incidents(folder)
            assert len(kept) == 4 * call, kept
            last = list(kept.values())[-4:]
            assert [alarm for _, alarm in last] == [[step] for step in said], (said, kept)
            assert all(len(steps) == 21 for steps, _ in last), kept
            pathlib.Path(camera.path).unlink()


def alarms_in_a_row():
    """A monitor that begins again may alarm at every step: each alarm is said, and has its file
    at once."""
    spec = "spec look; input x : f32; repeating monitor now = G x >= 0;"
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        pathlib.Path(folder, "look.etl").write_text(spec)
        watch = Watch(clock, ETLC, folder, "--trace", "-", "--record", "kept", "--recorder",
                      "1,9,3", stdin=subprocess.PIPE)
        for step, row in enumerate(["x\n1", "-1", "-2", "-3"]):
            watch.write(row + "\n")
            line = watch.line()
            assert line.startswith(f"step {step}: now "), line
            assert line.endswith(": alarm") == (step > 0), line
            kept = list(incidents(folder).values())
            assert len(kept) == step, (step, kept)
            assert all(number + 1 in alarms for number, (_, alarms) in enumerate(kept)), kept
        watch.write("-4\n")  # for which there is no room
        assert watch.line().endswith(": alarm")
        lines, errors, status = watch.stop()
        assert status == 0 and not errors, (status, errors)
        assert lines[-1] == "3 incidents in kept; 1 more alarm found no room", lines


def two_in_one_folder():
    """Two calls that began with the same files keep all incidents of both."""
    spec = "spec look; input x : f32; repeating monitor now = G x >= 0;"
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        pathlib.Path(folder, "look.etl").write_text(spec)
        both = [Watch(clock, ETLC, folder, "--trace", "-", "--record", "kept", "--recorder",
                      "1,1,4", stdin=subprocess.PIPE) for _ in range(2)]
        for watch in both:
            watch.write("x\n1\n")
            watch.line()
        for _ in range(3):
            for watch in both:
                watch.write("-1\n")
                assert watch.line().endswith(": alarm")
        for watch in both:
            lines, errors, status = watch.stop()
            assert status == 0 and not errors, (status, errors)
            assert lines[-1] == "3 incidents in kept", lines
        kept = incidents(folder)
        assert list(kept) == [f"look-incident-{number}" for number in range(6)], kept
        for step in (1, 2, 3):
            assert sum(step in alarms for _, alarms in kept.values()) >= 2, (step, kept)


def a_full_disk():
    """What cannot be written is said at once, and the rest goes on."""
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock:
        make_project(folder, ETLC)
        kept = pathlib.Path(folder, "kept")
        kept.mkdir()
        Camera(clock, folder, at_rate(levels_with([40], 240)))
        watch = Watch(clock, ETLC, folder, "--video", "camera", "--record", "kept")
        watch.lines_until("step 0")
        kept.rmdir()
        said = watch.lines_until("seen: ")
        assert any("incidents cannot be written: kept/look-incident-0: " in line
                   for line in said), said
        assert any(re.match(ALARM, line) for line in said), said
        lines, errors, status = watch.end()
        assert status == 1 and "kept/look-incident-0" in errors, (lines, errors, status)


def main():
    for number in SIGNALS:
        at_the_first_alarm(number)
    many_alarms()
    alarms_in_a_row()
    two_in_one_folder()
    a_full_disk()


main()
