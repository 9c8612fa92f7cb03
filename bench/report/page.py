#!/usr/bin/env python3
"""page.py ETLC DUBINS_RECORD [--json FILE]: measures the page of `etlc report` over 1000 drives of
300 steps: its size, the time to make it, and the time until headless Chromium shows its worst
episode.

The drives are those of examples/dubins/dubins.etl, 240 steps each, followed by the first 60 of the
next one. Times are medians over the rounds, with a new browser and profile for each.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/report"))
from browser import Browser  # noqa: E402

EPISODES, STEPS = 1000, 300


def make_drives(record, folder):
    """Writes EPISODES .csv files of STEPS rows."""
    subprocess.run([record, folder / "drives", *"1234"], check=True)
    drives = [path.read_text().splitlines() for path in sorted(folder.glob("drives/*/*/*.csv"))]
    (folder / "episodes").mkdir()
    for number, drive in enumerate(drives[:EPISODES]):
        after = drives[number + 1][1:]
        rows = (drive + after)[:1 + STEPS]
        (folder / "episodes" / f"{number:04}.csv").write_text("\n".join(rows) + "\n")


def seconds(action):
    begin = time.monotonic()
    action()
    return time.monotonic() - begin


def load(path):
    """Seconds from the navigation to numbers at the cursor; the browser is already running."""
    with Browser() as browser:
        begin = time.monotonic()
        page = browser.page(path)
        page.wait("document.querySelector('#readout td') !== null")
        taken = time.monotonic() - begin
        left_out = page.value("document.getElementById('left-out').textContent")
        rows = page.value("episodes.filter(of => of.series !== null).length")
        return taken, rows, left_out


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("etlc")
    parser.add_argument("dubins_record")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_drives(given.dubins_record, folder)
        page = folder / "page.html"
        make = [given.etlc, "report", ROOT / "examples/dubins/dubins.etl", "--data",
                folder / "episodes", "-o", page]
        made = [seconds(lambda: subprocess.run(make, check=True)) for _ in range(given.rounds)]
        loaded = [load(page) for _ in range(given.rounds)]
        row = {"page": f"{EPISODES} episodes of {STEPS} steps",
               "megabytes": page.stat().st_size / 1e6,
               "with timelines": loaded[0][1],
               "seconds to make": statistics.median(made),
               "seconds to load": statistics.median(taken for taken, *_ in loaded)}
        for figure, value in row.items():
            print(f"{figure:18}{value if isinstance(value, (str, int)) else format(value, '.2f')}")
        print(loaded[0][2])
    if given.json:
        given.json.write_text(json.dumps([row], indent=2))


main()
