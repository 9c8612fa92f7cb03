#!/usr/bin/env python3
"""page_test.py ETLC BROWSER_FOLDER: the page of `etlc watch` in headless Chromium: the frame and
the verdict on it belong together at every moment; two pages, a pause of the source, its end."""
import os
import signal
import sys
import tempfile

from camera import Camera, Watch, at_rate, blinking, make_project

sys.path.insert(0, sys.argv[2])
from browser import Browser  # noqa: E402

ETLC = sys.argv[1]

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


def check(shown):
    """Returns whether a frame is shown; then all that is said is said of it."""
    if not shown["frame"]:
        return False
    assert shown["frame"] == shown["step"], shown
    grey = shown["grey"] / 255
    assert abs(float(shown["distance"]) - 3 ** 0.5 * (1 - grey)) < 0.02, shown
    is_light = shown["grey"] > 128
    assert shown["light"] == ("yes" if is_light else "no"), shown
    assert shown["now"] == ("satisfied" if is_light else "violated"), shown
    return True


def watch_together(page, moments):
    """Looks at the page at many moments; returns the steps and greys that were seen."""
    steps, greys = [], set()
    while len(steps) < moments:
        shown = page.value(SHOWN)
        if check(shown) and (not steps or shown["frame"] != steps[-1]):
            steps.append(shown["frame"])
            greys.add(shown["grey"] > 128)
    return steps, greys


def main():
    with tempfile.TemporaryDirectory() as folder, Browser() as browser:
        make_project(folder, ETLC)
        frames = at_rate(blinking(600)) + at_rate(blinking(900), begin=22)
        Camera(folder, frames)
        watch = Watch(ETLC, folder, "--video", "camera", "--page")
        address = watch.line()
        assert address.startswith("http://127.0.0.1:"), address
        page = browser.page(address)
        steps, greys = watch_together(page, 60)
        assert greys == {False, True}, greys
        page.wait("document.querySelectorAll('.lane').length === 4")
        page.wait("document.querySelectorAll('.lane.monitor .strip').length > 2")

        other = browser.page(address)  # both go on
        watch_together(other, 20)
        watch_together(page, 20)

        page.click("#hold")
        held = page.value(SHOWN)["step"]
        watch_together(other, 10)
        assert page.value(SHOWN)["step"] == held
        page.click("#hold")
        page.wait(f"Number(document.getElementById('readout').dataset.step) > {held}")

        # The source pauses for two seconds, and the steps go on without frames.
        page.wait("document.getElementById('picture-step').textContent.startsWith('no frame')")
        shown = page.value(SHOWN)
        assert shown["distance"] == "missing" and shown["now"] == "unknown", shown
        page.wait("document.getElementById('frame').dataset.step !== ''")
        watch_together(page, 20)

        os.kill(watch.child("etlc-serve"), signal.SIGKILL)
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
