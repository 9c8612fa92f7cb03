#!/usr/bin/env python3
"""page_test.py ETLC: the page of `etlc report` in a headless browser. It opens from disk without a
message or a request; mouse and keyboard select what is shown; its figures are those of
`etlc evaluate`; any name is shown correctly."""
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import numpy as np
from PIL import Image

from browser import Browser

HOSTILE = "<img src=x onerror=alert(1)>"
SPEC = """
// </script><script>alert("a comment")</script>
spec page;
rate 10 Hz;
input z : f32[2];
input x : f32;
target goal = [[0, 0], [1, 0]];
predicate near = min l2(z, goal) <= 1;
truth near = x < 1;
monitor arrives = F near;
monitor never_far = G near;
sliding monitor sooner = F[0, 2] near;
"""
# Labels of `seldom` are false in one demonstration only: too few to say where it is true.
OF_TWO = """
spec two;
input d : f32;
predicate near = d <= calibrated(conformal, alpha = 0.4, against = both);
predicate far = d >= calibrated(conformal, alpha = 0.4, against = both);
predicate seldom = d <= calibrated(conformal, alpha = 0.4, against = both);
predicate usual = d <= calibrated(risk, alpha = 0.5);
monitor arrives = F near;
sliding monitor now = near;
sliding monitor soon = F[0, 1] near;
monitor rest = F (far && seldom && usual);
"""
STEPS = 40
LONG = 100_000
MANY = 1200


def samples(random, steps):
    x = np.linspace(3, 0, steps)
    z = np.stack([np.where(x < 1, 0.5, 4), np.zeros(steps)], 1)
    z += 0.01 * random.normal(size=(steps, 2))
    return x, z.astype(np.float32)


def episode(random, error):
    """Writes 40 steps; at `error` of them the label and the distance disagree."""
    x, z = samples(random, STEPS)
    x[:error] = 0
    camera = np.zeros((STEPS, 6, 8, 3), np.uint8)
    camera += 6 * np.arange(STEPS, dtype=np.uint8)[:, None, None, None]
    return {"z": z, "x": x, "camera": camera}


def make_episodes(folder):
    random = np.random.default_rng(3)
    (folder / "episodes").mkdir()
    for number in range(12):
        np.savez(folder / "episodes" / f"{number:02}.npz", **episode(random, 0))
    np.savez(folder / "episodes" / f"{HOSTILE}.npz", **episode(random, 1))
    np.savez(folder / "episodes" / "worst.npz", **episode(random, 9))
    one = {name: values[:1] for name, values in episode(random, 0).items()}
    np.savez(folder / "episodes" / "one_step.npz", **one)
    gone = episode(random, 0)
    gone["z"][:] = np.nan
    np.savez(folder / "episodes" / "missing_throughout.npz", **gone)
    arrival = episode(random, 0)
    arrival["x"][:] = 3  # it is said to arrive, and never does
    np.savez(folder / "episodes" / "wrong_arrival.npz", **arrival)
    x, z = samples(random, LONG)
    np.savez(folder / "long.npz", x=x, z=z)


def make_files(folder):
    """Writes the camera's pictures: of the episodes [1] and 1, which must not be confused."""
    random = np.random.default_rng(4)
    (folder / "two").mkdir()
    for name, steps in (("[1]", 4), ("1", 6)):
        x, z = samples(random, steps)
        np.savez(folder / "two" / f"{name}.npz", x=x, z=z)
        (folder / "camera" / name).mkdir(parents=True)
        for step in range(steps):
            picture = Image.new("RGB", (4, 4), (40 * step, 0, 0))
            picture.save(folder / "camera" / name / f"{step}.png")


def same(page, judged):
    """The page contains the figures of evaluate, number by number."""
    shown = page.value("document.getElementById('figures').textContent")
    assert json.loads(shown) == judged, "figures differ"
    f1 = judged["predicates"]["near"]["f1"]
    table = page.value("document.getElementById('predicate-figures').textContent")
    assert f"{f1:.3f}" in table, (f1, table)


def shown_step(page):
    return page.value("view.step")


def follows(page, step):
    """Numbers, cursor and camera belong to this step."""
    assert shown_step(page) == step, (shown_step(page), step)
    head = page.value("document.querySelector('#readout .head th').textContent")
    assert head.startswith(f"step {step} "), head
    assert page.value("document.getElementById('frame').dataset.step") == str(step)
    page.wait("sheet !== null")
    grey = page.value("""(() => {
        movePictures();
        const copy = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
        copy.drawImage(document.getElementById("frame"), 0, 0);
        return copy.getImageData(4, 3, 1, 1).data[0];
    })()""")
    assert grey == 6 * step, (grey, step)


def begins_where_it_is_wrong(page):
    """The first thing on the page is an episode, at a step where its monitor is wrong: in words,
    with the picture of that step. What may still change is not called violated."""
    assert page.value("document.querySelector('main section').id") == "episodes"
    step, said, true = page.value("""(() => {
        const name = view.row.wrong[0] ?? view.row.firstError[1];
        const lane = view.timelines.lanes.find((of) => of.name === name);
        return [view.step, lane.said[view.step], lane.truth[view.step]];
    })()""")
    headline = page.value("document.getElementById('headline').textContent")
    assert headline.startswith(f"Wrong at step {step} "), headline
    assert {said % 4, true % 4} == {0, 1}, (said, true)
    assert page.value("document.getElementById('frame').dataset.step") == str(step)
    words = page.value("Array.from(document.querySelectorAll('td.said.monitor'), "
                       "(cell) => [cell.textContent, cell.className])")
    assert not any(text == "violated" and "final" not in of for text, of in words), words


def begins_where_its_monitor_is_wrong(page):
    """Where a monitor ends wrong, the page begins where it begins to stay so."""
    page.value("selectEpisode(episodes.find((of) => of.path.endsWith('wrong_arrival.npz')))")
    step = int(np.argmax(samples(np.random.default_rng(0), STEPS)[0] < 1))
    assert page.value("view.row.wrong[0]") == "arrives"
    assert shown_step(page) == step, (shown_step(page), step)
    headline = page.value("document.getElementById('headline').textContent")
    assert headline.endswith("arrives is called satisfied; in truth it is not yet satisfied."), (
        headline)
    assert page.value("document.getElementById('frame').dataset.step") == str(step)


def look(browser, path, width, height, judged):
    page = browser.page(path, width, height)
    page.wait("view.episode !== null")
    same(page, judged)
    assert page.value("document.documentElement.scrollWidth <= window.innerWidth"), "too wide"

    names = page.value("Array.from(document.querySelectorAll('#rows .name'), r => r.textContent)")
    # Wrong verdicts, no verdict, wrong frames.
    assert names[:3] == ["wrong_arrival.npz", "missing_throughout.npz", "worst.npz"], names
    assert f"{HOSTILE}.npz" in names, names
    page.click("#rows .row:nth-child(3)")
    page.wait("view.row === list.shown[2]")
    assert page.value("document.getElementById('episode-name').textContent").endswith("worst.npz")
    begins_where_it_is_wrong(page)
    begins_where_its_monitor_is_wrong(page)
    page.click("#rows .row:nth-child(3)")
    page.wait("view.row === list.shown[2]")

    page.key("Home")
    follows(page, 0)
    page.key("ArrowRight")
    follows(page, 1)
    page.key("ArrowRight", shift=True)
    follows(page, 11)
    x, y, wide, _ = page.place("#tracks .brush .background")
    page.mouse("mouseMoved", x + wide / 4, y)
    page.wait("view.step !== 11")
    step = shown_step(page)
    assert abs(step - 0.75 * (STEPS - 1)) <= 1, step
    follows(page, step)

    why = page.value("document.querySelector('#why pre').textContent")
    assert "near" in why, why
    page.click("#why .go")
    assert shown_step(page) == page.value("view.episode.why.find("
                                          "of => of.monitor === view.why)?.step"), "explained step"

    whole = page.value("unbroken('G (F[0, 0.5 s] p || q@2 > 3 steps)').filter(c => c.className)"
                       ".map(c => c.textContent).join('; ')")
    assert whole == "[0, 0.5 s]; 3 steps", whole
    kept = page.value("getComputedStyle(document.querySelector('.formula .whole')).whiteSpace")
    assert kept == "nowrap", kept

    page.value("chooseTheme(false)")
    light = page.value("getComputedStyle(document.body).backgroundColor")
    page.key("d")
    dark = page.value("getComputedStyle(document.body).backgroundColor")
    assert light != dark, light
    assert page.pdf().startswith(b"%PDF")
    for name in (f"{HOSTILE}.npz", "one_step.npz", "missing_throughout.npz"):
        of_name = f"(one => baseName(one.path) === {json.dumps(name)})"
        page.value(f"selectEpisode(episodes.find({of_name}))")
        page.wait(f"view.row && {of_name}(view.row)")
        assert page.value("document.getElementById('episode-name').textContent").endswith(name)
    assert page.messages == [], page.messages
    assert page.requests == [], page.requests


def look_at_a_long_one(browser, path):
    """Of 100,000 steps the page keeps the least and greatest of every few, and says so."""
    page = browser.page(path)
    page.wait("view.episode !== null")
    left_out = page.value("document.getElementById('left-out').textContent")
    assert "least and greatest" in left_out, left_out
    page.key("End")
    assert shown_step(page) == LONG - 1
    assert page.messages == [], page.messages


def make_many(folder):
    """More episodes than a page of 1 MB has rows for; one of them is wrong throughout."""
    (folder / "many").mkdir()
    for number in range(MANY):
        x = 0.5 if number == 700 else 3
        rows = "".join(f"4,{step},{x}\n" for step in range(3))
        (folder / "many" / f"{number:04}.csv").write_text("z[0],z[1],x\n" + rows)


def look_at_many(browser, path):
    """The worst is shown, and the page says how many are not."""
    page = browser.page(path)
    page.wait("view.episode !== null")
    shown = page.value("episodes.length")
    left_out = page.value("document.getElementById('left-out').textContent")
    assert 500 < shown < MANY and f"{MANY - shown} better episodes" in left_out, left_out
    assert page.value("document.getElementById('episode-name').textContent").endswith("0700.csv")
    assert path.stat().st_size < 1_000_000
    assert page.messages == [], page.messages


def pictures_of_a_trace(call, folder):
    """`etlc run` draws every predicate and monitor, whichever bound is their robustness."""
    trace = ["run", "page.etl", "--trace", "episodes/worst.npz"]
    call(*trace, "--svg", "one.svg", "--html", "one.html")
    drawn = xml.etree.ElementTree.parse(folder / "one.svg").getroot()
    texts = [text.text for text in drawn.iter("{http://www.w3.org/2000/svg}text")]
    paths = [path.get("d") for path in drawn.iter("{http://www.w3.org/2000/svg}path")]
    names = ("near", "arrives", "never_far", "sooner")
    assert all(name in " ".join(texts) for name in names), texts
    assert len(paths) >= 6 and "nan" not in "".join(paths), paths


def make_two(call, folder):
    (folder / "two.etl").write_text(OF_TWO)
    (folder / "demos").mkdir()
    for demo in range(5):
        near = np.array([True, False, True, False])
        np.savez(folder / "demos" / f"{demo}.npz", **{
            "d": np.array([0.2, 0.5 - 0.02 * demo, 1 + 0.02 * demo, 2], np.float32),
            "truth.near": near, "truth.far": ~near, "truth.usual": near,
            "truth.seldom": near if demo == 0 else near | True})
    call("calibrate", "two.etl", "--data", "demos")
    np.savez(folder / "band.npz", **{
        "d": np.array([2, 0.7, 0.2], np.float32), "truth.near": np.array([False, True, True])})
    call("report", "two.etl", "--data", "band.npz", "-o", "band.html")
    call("run", "two.etl", "--trace", "band.npz", "--svg", "band.svg")


def look_at_two(browser, folder):
    """Between its two thresholds a predicate is unknown: a band, hatched, and not wrong."""
    page = browser.page(folder / "band.html")
    page.wait("view.episode !== null")

    def codes(of, index):
        return page.value(f"Array.from(view.episode.tracks.{of}[{index}][0])")

    def of_lane(name, expression):
        return page.value(f"(lane => {expression})(document.querySelector('[data-lane={name}]'))")

    def count(name, selector):
        return of_lane(name, f"lane.querySelectorAll('{selector}').length")

    no, yes, unknown, final = 0, 1, 2, 4
    assert codes("holds", 0) == [no, unknown, yes], codes("holds", 0)
    assert codes("holds", 1) == [yes, unknown, no], codes("holds", 1)
    assert codes("status", 0) == [no, unknown, yes + final], codes("status", 0)
    assert codes("status", 1) == [no + final, unknown + final, yes + final], codes("status", 1)
    # Of a sliding monitor the worst position counts: the last is satisfied, the first unknown.
    said = page.value("document.getElementById('episode-summary').textContent")
    assert codes("status", 2)[-1] == yes + final and "soon: unknown" in said, said
    assert count("near", "line.threshold") == 2 and count("near", ".between") == 1
    ends = of_lane("near", "[+lane.querySelector('.between').getAttribute('y'), "
                   "...Array.from(lane.querySelectorAll('line.threshold'), l => +l.attributes.y1"
                   ".value)]")
    assert ends[0] == min(ends[1:]) and ends[1] != ends[2], ends
    # Where nothing is called true, the band goes on to the edge of the chart.
    assert count("seldom", "line.threshold") == 1 and unknown in codes("holds", 2)
    edge = of_lane("seldom", "['y', 'height'].reduce((sum, of) => sum + "
                   "+lane.querySelector('.between').getAttribute(of), 0)")
    assert edge == page.value("laneSize.predicate"), edge
    assert count("usual", "line.threshold") == 1 and count("usual", ".between") == 0
    for lane in ("near", "now", "arrives"):
        fill = of_lane(lane, "getComputedStyle(lane.querySelector('.strip.said.unknown')).fill")
        assert "#unknown" in fill, fill
    assert count("near", ".strip.wrong") == 0, "what is unknown is not wrong"
    hatched = page.value("getComputedStyle(document.querySelector('#timelines .swatch.unknown'))"
                         ".backgroundImage")
    assert "gradient" in hatched, hatched
    assert "unknown" in page.value("document.querySelector('#timelines .key').textContent")
    listed = page.value("document.querySelector('#rows .row').textContent")
    assert "33.3 % of frames unknown" in listed and "% of frames wrong" not in listed, listed

    for part in ("monitor", "predicate"):
        heads = page.value(f"document.querySelector('#{part}-figures thead').textContent")
        assert "unknownwrong when decided" in heads, heads
    table = page.value("document.getElementById('provenance').textContent")
    assert "true up to" in table and "never true (1 score, too few)" in table, table
    assert "score 0" not in table and "0.44 to 1.06" in table, table
    assert "nearunknownat 33.3 % of the steps" in table, table
    near = "document.querySelector('.card[data-predicate=near]')"
    assert page.value(near + ".querySelectorAll('circle.operating').length") == 4  # of two curves
    assert page.value(near + ".querySelectorAll('.between').length") == 3
    text = page.value(near + ".textContent")
    for part in ("0.44 to 1.06, unknown between", "unknown at 33.3 % of the steps",
                 "against misses: rank 4 of 5", "against false positives: rank 4 of 5"):
        assert part in text, (part, text)
    seldom = page.value("document.querySelector('.card[data-predicate=seldom]').textContent")
    assert "1 are too few" in seldom or "1 is too few" in seldom, seldom
    # Of `>=` the scores are distances too: the chosen one is at the threshold.
    chosen, line = page.value(
        "((card, at) => [+card.querySelector('.chosen').getAttribute('cx'), "
        "...Array.from(card.querySelector('.chosen').parentNode.querySelectorAll('line.threshold'),"
        " l => +l.getAttribute('x1'))])(document.querySelector('.card[data-predicate=far]'))")[:2]
    assert abs(chosen - line) < 1, (chosen, line)
    assert page.messages == [], page.messages

    drawn = (folder / "band.svg").read_text()
    xml.etree.ElementTree.fromstring(drawn)
    assert drawn.count('class="between"') == 3 and drawn.count('class="threshold"') == 10, drawn
    assert 'rect class="unknown"' in drawn and ">unknown</text>" in drawn and '="inf' not in drawn


def make_outcomes(call, folder):
    """Two failures and two successes; a monitor detects one and is wrong about a success."""
    (folder / "outcomes.etl").write_text(
        "spec outcomes; rate 10 Hz; input z : f32[2]; target origin = [[0, 0]];\n"
        "monitor calm = G l2(z, origin) <= 1;\n")
    for name, far in (("failure/a", 5), ("failure/b", 0), ("success/c", 0), ("success/d", 3)):
        z = np.zeros((8, 2), "f4")
        z[3] = far
        (folder / name).parent.mkdir(exist_ok=True)
        np.savez(folder / f"{name}.npz", z=z)
    call("report", "outcomes.etl", "--label-by", "folder", "--data", "failure", "success", "-o",
         "outcomes.html")


def look_at_outcomes(browser, path):
    page = browser.page(path)
    page.wait("view.episode !== null")
    text = page.value("document.getElementById('overview').textContent")
    assert "2 failures among 4 episodes" in text and "0.4 s" in text, text
    cells = page.value("Array.from(document.querySelectorAll('[data-outcomes=calm] td'), "
                       "cell => cell.firstChild.textContent)")
    assert cells == ["0.500", "0.500", "0.500", "0.625", "0.4 s"], cells
    assert page.value("document.querySelectorAll('#monitor-figures td').length") == 1
    wrong = page.value("Array.from(document.querySelectorAll('.row .error'), "
                       "row => row.textContent)")
    assert wrong == ["1 wrong: calm"] * 2, wrong
    assert page.messages == [], page.messages


def main(etlc):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "page.etl").write_text(SPEC)
        make_episodes(folder)

        def call(*words, status=0):
            done = subprocess.run([etlc, *words], cwd=folder, capture_output=True, text=True)
            assert done.returncode == status, (words, done.stderr)
            return done.stderr

        report = ["report", "page.etl", "--data", "episodes", "--frames", "camera", "-o"]
        call(*report, "page.html")
        call(*report, "again.html", "--jobs", "1")
        assert (folder / "page.html").read_bytes() == (folder / "again.html").read_bytes()
        call("evaluate", "page.etl", "--data", "episodes", "--json", "judged.json")
        judged = json.loads((folder / "judged.json").read_text())
        call("report", "page.etl", "--data", "long.npz", "-o", "long.html")
        refused = call("report", "page.etl", "--data", "long.npz", "-o", "no/folder.html", status=1)
        assert "no/folder.html" in refused, refused
        make_files(folder)
        said = call("report", "page.etl", "--data", "two", "--frames", "camera/{episode}/*.png",
                    "-o", "two.html")
        assert "W0840" not in said, said
        said = call("report", "page.etl", "--data", "two", "--frames", "camera/1/*.png", "-o",
                    "no.html", status=1)
        assert "expected {episode}" in said, said
        two = dict(np.load(folder / "episodes" / "worst.npz"))
        np.savez(folder / "short.npz", **{**two, "camera": two["camera"][1:]})
        said = call("report", "page.etl", "--data", "short.npz", "--frames", "camera", "-o",
                    "no.html", status=1)
        assert "found 39 pictures, expected 40" in said and not (folder / "no.html").exists(), said
        pictures_of_a_trace(call, folder)
        make_two(call, folder)
        make_outcomes(call, folder)
        make_many(folder)
        call("report", "page.etl", "--data", "many", "--size", "1", "-o", "many.html")
        with Browser() as browser:
            look_at_many(browser, folder / "many.html")
            one = browser.page(folder / "one.html")
            one.wait("view.episode !== null")
            assert one.value("getComputedStyle(document.getElementById('list')).display") == "none"
            tall = one.value("Math.max(...Array.from(document.querySelectorAll('path.bounds'), "
                             "path => path.getBBox().height))")
            assert 0 < tall <= one.value("laneSize.monitor"), tall
            assert one.messages == [], one.messages
            look_at_a_long_one(browser, folder / "long.html")
            look_at_two(browser, folder)
            look_at_outcomes(browser, folder / "outcomes.html")
            for width, height in ((1280, 720), (1920, 1080)):
                look(browser, folder / "page.html", width, height, judged)


main(sys.argv[1])
