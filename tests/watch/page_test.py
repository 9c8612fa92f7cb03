#!/usr/bin/env python3
"""page_test.py ETLC BROWSER_FOLDER: the page of `etlc watch` in headless Chromium: the frame and
the verdict on it belong together at every moment; two pages, a pause of the source, its end."""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

from camera import RATE, Camera, Clock, Watch, at_rate, make_project

sys.path.insert(0, sys.argv[2])
from browser import Browser  # noqa: E402

ETLC = sys.argv[1]

# A page that shows a step is told of those that follow.
SHOWS_A_STEP = "document.getElementById('readout').dataset.step !== undefined"
# What the page shows at one moment: the grey of the frame, its step, and the table.
SHOWN = """(() => {
  const canvas = document.getElementById('frame');
  const table = document.getElementById('readout');
  const row = (name) => Array.from(document.querySelectorAll(name), (cell) => cell.textContent);
  return {
    frame: canvas.dataset.step ?? '', step: table.dataset.step,
    grey: canvas.width ? canvas.getContext('2d').getImageData(5, 5, 1, 1).data[0] : null,
    distance: row("[data-predicate='light'] td")[0], light: row("[data-predicate='light'] td")[2],
    now: row("[data-monitor='now'] td")[2], seen: row("[data-monitor='seen'] td")[2],
  };
})()"""


def grey(frame):
    """No two frames near each other are alike, and light ones follow dark ones."""
    return 20 + frame % 40 if frame % 2 == 0 else 200 - frame % 40


def check(shown, step):
    """All that is shown is of this step."""
    assert shown["frame"] == shown["step"] == str(step), (step, shown)
    light = shown["grey"] / 255
    assert abs(float(shown["distance"]) - 3 ** 0.5 * (1 - light)) < 0.02, shown
    is_light = shown["grey"] > 128
    assert shown["light"] == ("yes" if is_light else "no"), shown
    assert shown["now"] == ("satisfied" if is_light else "violated"), shown


class Film:
    """What is watched, frame by frame: every one changes a verdict, so that it has a line."""

    def __init__(self, clock, watch):
        self.clock, self.watch = clock, watch
        self.step = None

    def go_on(self, what="now (?:violated|satisfied)"):
        """Shows frames until a line says this; returns its step."""
        while not (found := [one for line in self.watch.lines_so_far()
                             if (one := re.match(rf"step (\d+) .*: {what}", line))]):
            self.clock.advance(1 / RATE)
        self.step = int(found[-1][1])
        return self.step

    def show(self, frames, *pages):
        """Shows frames one by one, and checks what each page shows of each."""
        greys = set()
        for _ in range(frames):
            step = self.go_on()
            for page in pages:
                page.wait(f"document.getElementById('readout').dataset.step === '{step}'")
                shown = page.value(SHOWN)
                check(shown, step)
                greys.add(shown["grey"])
        assert len(greys) > frames / 2, greys


# `seldom` has too few labels that say where it is false: nothing is called true.
OF_TWO = """spec two;
input d : f32;
predicate near = d <= calibrated(conformal, alpha = 0.4, against = both);
predicate seldom = d <= calibrated(conformal, alpha = 0.4, against = both);
monitor stays = G near;
monitor other = F seldom;
"""


def between_two_thresholds(browser):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "two.etl").write_text(OF_TWO)
        for demo in range(5):
            rows = [(0.2, 1, 1), (0.5 - 0.02 * demo, 0, 1), (1 + 0.02 * demo, 1, 1),
                    (2, 0, demo > 0)]
            (folder / f"{demo}.csv").write_text("d,truth.near,truth.seldom\n" + "".join(
                f"{d},{near:d},{seldom:d}\n" for d, near, seldom in rows))
        calibrated = subprocess.run([ETLC, "calibrate", "two.etl", "--data", "?.csv"],
                                    cwd=folder, capture_output=True, text=True)
        assert calibrated.returncode == 0, calibrated.stderr
        watch = subprocess.Popen([ETLC, "watch", "two.etl", "--trace", "-", "--page"], cwd=folder,
                                 stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        page = browser.page(watch.stdout.readline().strip())
        for step, (d, near, seldom, stays) in enumerate((
                ("d\n0.2", "yes", "unknown", "so far"),
                ("0.7", "unknown", "unknown", "unknown"),
                ("3", "no", "no", "violated"))):
            watch.stdin.write(d + "\n")
            watch.stdin.flush()
            page.wait(f"document.getElementById('readout').dataset.step === '{step}'")
            said = page.value("Array.from(document.querySelectorAll('#readout td.said'), "
                              "cell => cell.textContent)")
            assert said == [near, seldom, stays, "unknown"], (step, said)
        cells = page.value("Array.from(document.querySelectorAll('[data-predicate]'), "
                           "row => row.cells[2].textContent)")
        assert cells == ["<= 0.44 to 1.06", "<= −∞ to 2"], cells
        page.value("drawTimelines()")  # which the page does at the next step, or the one after
        assert page.value("document.querySelectorAll('[data-lane=near] .strip.said').length") == 3
        drawn = page.value("['line.threshold', '.between'].map(one => ['near', 'seldom'].map(lane "
                           "=> document.querySelectorAll(`[data-lane=${lane}] ${one}`).length))")
        assert drawn == [[2, 1], [1, 1]], drawn
        fill = page.value("getComputedStyle(document.querySelector('.strip.said.unknown')).fill")
        assert "#unknown" in fill, fill
        assert "unknown" in page.value("document.querySelector('#timelines .key').textContent")
        messages = [one for one in page.messages if "events" not in one and "ERR_" not in one]
        assert not messages, messages
        watch.communicate()
        assert watch.returncode == 0


def main():
    with Browser() as browser:
        between_two_thresholds(browser)
    with tempfile.TemporaryDirectory() as folder, Clock(folder) as clock, Browser() as browser:
        make_project(folder, ETLC)
        clock.hold()
        levels = [grey(frame) for frame in range(400)]
        Camera(clock, folder, at_rate(levels[:120]) + at_rate(levels[120:], begin=6))
        watch = Watch(clock, ETLC, folder, "--video", "camera", "--page")
        while not (lines := watch.lines_so_far()):
            clock.advance(1 / RATE)
        address = lines[0]
        assert address.startswith("http://127.0.0.1:"), address
        film = Film(clock, watch)
        film.go_on()
        page = browser.page(address)
        page.wait(SHOWS_A_STEP)
        film.show(60, page)
        page.wait("document.querySelectorAll('.lane').length === 4")
        page.wait("document.querySelectorAll('.lane.monitor .strip').length > 2")

        other = browser.page(address)  # both go on
        other.wait(SHOWS_A_STEP)
        film.show(20, page, other)

        page.click("#hold")
        held = film.step
        film.show(10, other)
        check(page.value(SHOWN), held)
        page.click("#hold")
        film.show(1, page, other)

        # The source pauses for two seconds, and the steps go on without frames.
        step = film.go_on("now unknown")
        page.wait("document.getElementById('picture-step').textContent.startsWith('no frame')")
        shown = page.value(SHOWN)
        assert shown["step"] == str(step) and shown["frame"] == "", shown
        assert shown["distance"] == "missing" and shown["now"] == "unknown", shown
        film.show(20, page)

        os.kill(watch.child("etlc-serve"), signal.SIGKILL)
        clock.advance(1)
        watch.lines_containing("the page has ended: etlc-serve was stopped by signal 9")
        lines, errors, status = watch.stop()
        assert status == 0 and not errors, (status, errors)
        page.wait("document.getElementById('trouble').textContent.includes('has ended')")
        assert not page.value("document.getElementById('trouble').hidden")
        messages = [one for one in page.messages + other.messages
                    if not any(word in one for word in ("events", "ERR_", "Canvas2D"))]
        assert not messages, messages
        assert all(one.startswith(address) or one.startswith("data:") for one in page.requests)


main()
