#!/usr/bin/env python3
"""page_test.py ETLC BROWSER_FOLDER: somebody labels episodes on the page of `etlc label`, with the
keyboard alone, and the table on disk is right after each key; then all that may go wrong does."""
import pathlib
import resource
import sys
import tempfile

import numpy as np

from service import HOSTILE, STEPS, Service, make_episodes, rows, SPEC

sys.path.insert(0, sys.argv[2])
from browser import Browser  # noqa: E402

ETLC = sys.argv[1]


class Labeller:
    """Presses keys on a page, and compares the table with what they mean."""

    def __init__(self, browser, service):
        self.page = browser.page(service.address)
        self.table = service.table
        self.page.wait("store.version > 0")

    def key(self, key, times=1, shift=False):
        for _ in range(times):
            self.page.key(key, shift)
        self.page.wait("document.body.dataset.waiting === '0'")

    def go_to(self, step):
        self.key("Home")
        self.key("ArrowRight", step // 10, shift=True)
        self.key("ArrowRight", step % 10)
        assert self.value("view.step") == step, self.value("view.step")

    def value(self, expression):
        return self.page.value(expression)

    def trouble(self):
        return self.value("document.getElementById('trouble').textContent")

    def name(self):
        return self.value("data.episodes[view.episode].name")

    def expect(self, of_episode):
        """The rows of the selected episode are these."""
        found = [row[1:] for row in rows(self.table) if row[0] == self.name()]
        assert found == sorted(of_episode), (found, of_episode)


def label_one(labeller, before):
    """Labels both predicates of an episode; `before`: how many steps earlier than usual."""
    near, end, begin = 50 - before, 36 - before, 12
    labeller.key("1")
    labeller.go_to(near)
    labeller.key("b")
    labeller.expect([["near", str(near), ""]])
    labeller.key("p")
    labeller.go_to(begin)
    labeller.key("b")
    labeller.expect([["near", str(near), ""], ["passes", str(begin), ""]])
    labeller.go_to(end)
    labeller.key("e")
    labeller.expect([["near", str(near), ""], ["passes", str(begin), str(end + 1)]])


def label_three(labeller):
    assert labeller.value("list.rows.length") == 6
    for number in range(3):
        if number > 0:
            labeller.key("j")
        labeller.key("f")  # and undone at once
        labeller.expect([["!near" if number == 0 else "!passes", "", ""]])
        labeller.key("u")
        labeller.expect([])
        label_one(labeller, number)
    text = labeller.value("document.getElementById('progress').textContent")
    assert text.startswith("3 of 6 episodes labelled"), text


def accept_and_correct(labeller):
    labeller.page.wait("store.proposals.size === 3")
    first = labeller.value("Array.from(store.proposals.keys())[0]")
    labeller.key("n")
    assert labeller.value("view.episode") == first
    assert labeller.value("document.querySelectorAll('.strip.proposed').length") > 0
    labeller.expect([])
    proposed = labeller.value(f"store.proposals.get({first}).marks")
    labeller.key("a")
    said = [[name, str(start), "" if end == STEPS else str(end)]
            for name, marks in zip(("near", "passes"), proposed) for start, end, _ in marks]
    assert len(said) == 2, said
    labeller.expect(said)

    labeller.key("1")
    labeller.key("Home")
    labeller.key("]")
    assert labeller.value("view.step") == proposed[0][0][0]
    labeller.key("ArrowLeft", 2)
    labeller.key("b")
    corrected = [["near", str(proposed[0][0][0] - 2), ""], said[1]]
    labeller.expect(corrected)
    labeller.key("u")
    labeller.expect(said)
    labeller.key("U")
    labeller.expect(corrected)
    labeller.key("U")  # nothing is left
    labeller.expect(corrected)
    labeller.key("u")
    labeller.key("b")
    labeller.expect(corrected)
    labeller.key("U")  # a new key leaves nothing to redo
    labeller.expect(corrected)
    return first


def undo_elsewhere(labeller, episode):
    """Undo goes to the episode that it is about."""
    labeller.key("k" if episode > 0 else "j")
    labeller.key("u")
    assert labeller.value("view.episode") == episode


def reload(labeller):
    before = rows(labeller.table)
    episode = labeller.value("view.episode")
    labels = labeller.value("JSON.stringify(store.labels)")
    labeller.page.call("Page.reload")
    labeller.page.wait("typeof store !== 'undefined' && store.version > 0")
    assert labeller.value("view.episode") == episode
    assert labeller.value("JSON.stringify(store.labels)") == labels
    assert rows(labeller.table) == before
    labeller.page.wait("store.proposals.size >= 2")  # 2 once etlc has learned from the fourth


def frames_are_exact(labeller):
    for step in (0, 7, 59, 58, 20):
        labeller.go_to(step)
        labeller.page.wait("document.getElementById('frame').dataset.place === "
                           f"`${{view.episode}}/{step}`")
        grey = labeller.value("""(() => {
            const often = {willReadFrequently: true};
            const copy = document.createElement("canvas").getContext("2d", often);
            copy.drawImage(document.getElementById("frame"), 0, 0);
            return copy.getImageData(8, 6, 1, 1).data[0];
        })()""")
        assert grey == 4 * step, (grey, step)


def hostile_name(labeller):
    labeller.value("selectEpisode(0)")
    assert HOSTILE in labeller.value("document.getElementById('episode-name').textContent")
    assert labeller.value("document.querySelectorAll('#list img, #timelines img').length") == 0
    labeller.key("1")
    labeller.key("?")
    labeller.go_to(20)
    labeller.key("b")
    labeller.key("?")
    assert [HOSTILE, "?near", "20", ""] in rows(labeller.table), rows(labeller.table)
    labeller.key("x")
    assert [HOSTILE, "!near", "", ""] in rows(labeller.table), rows(labeller.table)


def play(labeller):
    labeller.key("Home")
    labeller.key(".", 3)
    # A clock of the test's own, so that a busy machine does not play to the end.
    labeller.value("performance.now = () => window.clock ?? 0; 0")
    labeller.key(" ")
    labeller.value("window.clock = 7500 * (data.spec.step_seconds || 0.1) / play.speed")
    labeller.page.wait("view.step > 5")
    labeller.key(" ")
    labeller.value("delete performance.now")
    step = labeller.value("view.step")
    assert step == 7, step
    labeller.key("ArrowLeft")
    assert labeller.value("view.step") == step - 1


def open_twice(browser, service, first):
    second = Labeller(browser, service)
    second.page.wait("document.getElementById('trouble').textContent.includes('elsewhere')")
    before = rows(service.table)
    second.key("2")
    second.page.key("f")
    second.page.wait("document.getElementById('trouble').textContent.includes('1 key')")
    assert rows(service.table) == before
    second.key("Escape")
    second.key("o")
    second.page.wait("document.getElementById('trouble').textContent === ''")
    second.key("f")
    assert rows(service.table) != before
    first.page.wait("document.getElementById('trouble').textContent.includes('elsewhere')")
    second.key("u")
    assert rows(service.table) == before
    second.page.call("Page.close")
    first.page.wait("document.getElementById('trouble').textContent === ''")


def changed_meanwhile(labeller):
    """Another program adds a row: it is not overwritten, and stays."""
    others = labeller.table.read_text() + "ep9,?near,3,4\n"
    np.savez(labeller.table.parent / "ep9.npz", z=np.zeros((9, 2), np.float32))
    labeller.table.write_text(others)
    labeller.page.wait("document.getElementById('trouble').textContent.includes('changed')")
    labeller.page.key("b")
    labeller.page.wait("document.getElementById('trouble').textContent.includes('1 key')")
    assert labeller.table.read_text() == others
    labeller.page.key("r")
    labeller.page.wait("document.body.dataset.waiting === '0'")
    assert ["ep9", "?near", "3", "4"] in rows(labeller.table)
    assert [labeller.name(), "near", "20", ""] in rows(labeller.table), rows(labeller.table)
    labeller.page.wait("document.getElementById('trouble').textContent === ''")


def full_disk(labeller, service):
    """A limit on the size of files stands for a full disk."""
    before = labeller.table.read_bytes()
    limit = resource.prlimit(service.process.pid, resource.RLIMIT_FSIZE)
    resource.prlimit(service.process.pid, resource.RLIMIT_FSIZE, (0, limit[1]))
    labeller.key("2")
    labeller.page.key("f")
    labeller.page.wait("document.getElementById('trouble').textContent.includes('1 key')")
    labeller.page.key("u")
    labeller.page.wait("document.body.dataset.waiting === '2'")
    assert labeller.table.read_bytes() == before
    resource.prlimit(service.process.pid, resource.RLIMIT_FSIZE, limit)
    labeller.page.wait("document.body.dataset.waiting === '0'")
    labeller.page.wait("document.getElementById('trouble').textContent === ''")
    assert rows(labeller.table) == sorted(line for line in rows(labeller.table))
    assert labeller.table.read_bytes() == before


def killed(browser, folder):
    """Killed right after a key, etlc leaves the table before it or after it, and goes on there."""
    for _ in range(5):
        with Service(ETLC, folder) as service:
            labeller = Labeller(browser, service)
            labeller.value("selectEpisode(3)")
            labeller.key("e")
            labeller.key("f")
            before = rows(service.table)
            labeller.go_to(30)
            labeller.page.key("b")
            service.kill()
            after = rows(service.table)
            name = labeller.name()
            written = [row for row in before if row != [name, "!near", "", ""]]
            written = sorted([*written, [name, "near", "30", ""]])
            assert after in (before, written), (before, after)
            labeller.page.key("e")
            labeller.page.wait("document.getElementById('trouble').textContent"
                               ".includes('does not answer')")
            labeller.page.call("Page.close")


def without_frames(browser, folder):
    """Frames that disappear are a message; labelling goes on."""
    films = folder / "films"
    films.mkdir()
    with Service(ETLC, folder, "--frames", "films/{episode}.mp4") as service:
        labeller = Labeller(browser, service)
        labeller.page.wait("document.getElementById('picture-step')?.textContent"
                           ".includes('No frame')")
        labeller.key("f")
        labeller.key("u")
        assert labeller.trouble() == ""
    with Service(ETLC, folder) as service:
        labeller = Labeller(browser, service)
        assert labeller.value("document.getElementById('frame') === null")
        assert labeller.value("document.querySelectorAll('.lane').length") == 2


def network(labeller, latency=0, offline=False):
    labeller.page.call("Network.emulateNetworkConditions", offline=offline, latency=latency,
                       downloadThroughput=-1, uploadThroughput=-1)


def at_speed(labeller, *keys):
    """Presses keys without waiting for answers, and then for all of them."""
    for key in keys:
        labeller.page.key(key)
    labeller.page.wait("document.body.dataset.waiting === '0'")


def go_on_at_once(labeller, before):
    """Each key is about the episode that was shown when it was pressed."""
    labeller.value("chooseEpisode(0)")
    labeller.value("choosePredicate(0)")
    count = labeller.value("data.episodes.length")
    keys, expected = [], []
    for episode in range(count):
        name = labeller.value(f"data.episodes[{episode}].name")
        keys += [*["ArrowRight"] * episode, "b", "p", "f", "p", "j"]
        expected += [[name, "near", str(episode or ""), ""], [name, "!passes", "", ""]]
    at_speed(labeller, *keys)
    assert labeller.value("view.episode") == count - 1, labeller.value("view.episode")
    assert rows(labeller.table) == sorted(expected), (rows(labeller.table), expected)
    at_speed(labeller, *"uu" * count)
    assert rows(labeller.table) == before, rows(labeller.table)


def accept_at_once(labeller, before):
    """`n` goes to the next episode that will not be labelled once all keys are written."""
    # Proposals that were begun before the last keys may still arrive.
    labeller.page.wait("refresh().then(() => !store.isBusy && store.proposals.size === 3)")
    at_speed(labeller, *"nanana")
    text = labeller.value("document.getElementById('progress').textContent")
    assert text.startswith("6 of 6 episodes labelled"), text
    assert labeller.trouble() == "", labeller.trouble()
    last = labeller.value("view.episode")
    at_speed(labeller, "u")
    assert labeller.value("view.episode") == last
    at_speed(labeller, *"uu")
    assert labeller.value("view.episode") != last, "undo goes to the episode that it is about"
    assert rows(labeller.table) == before, rows(labeller.table)


def undo_and_go_on(labeller, before):
    """The answer to undo does not take back an episode that was chosen since."""
    labeller.value("chooseEpisode(2)")
    at_speed(labeller, "c")
    labeller.value("chooseEpisode(4)")
    # In one task, so that no answer comes between the keys.
    labeller.value("""for (const key of ["u", "j"])
        document.dispatchEvent(new KeyboardEvent("keydown", { key }))""")
    at_speed(labeller)
    assert labeller.value("view.episode") == 5
    note = labeller.value("document.getElementById('note').textContent")
    assert note == f"undo in {labeller.value('data.episodes[2].name')}", note
    assert rows(labeller.table) == before, rows(labeller.table)


def late_frames(labeller):
    """A frame that arrives when another episode is shown is not drawn."""
    labeller.value("""drawn = [], places = new Map(), fetchFrame = ((fetchIt) => async (place) => {
        const image = await fetchIt(place);
        places.set(image, place);
        return image;
    })(fetchFrame), drawFrame = ((draw) => (image, caption) => {
        if (image) drawn.push([view.episode, places.get(image)]);
        draw(image, caption);
    })(drawFrame), chooseEpisode(1)""")
    for key in ("End", "j", "End", "k"):
        labeller.page.key(key)
    labeller.page.wait("document.getElementById('frame').dataset.place === '1/0'")
    labeller.page.wait("drawn.some(([, place]) => place === '1/0')")
    found = labeller.value("drawn.filter(([shown, place]) => !place.startsWith(`${shown}/`))")
    assert found == [], found


def pending_keys(labeller, before):
    """Keys that are not on disk are shown; Esc drops them, but not the one that is on its way."""
    labeller.value("chooseEpisode(0)")
    labeller.value("choosePredicate(0)")
    network(labeller, offline=True)
    labeller.page.key("f")
    labeller.page.key("j")
    labeller.page.key("c")
    labeller.page.wait("document.getElementById('trouble').textContent.includes('2 keys')")
    note = labeller.value("document.getElementById('note').textContent")
    names = [labeller.value(f"data.episodes[{episode}].name") for episode in range(2)]
    assert note == f"not written yet: f in {names[0]}, c in {names[1]}", note
    assert labeller.value("document.querySelectorAll('.row.waiting').length") == 2
    network(labeller)
    labeller.page.wait("document.body.dataset.waiting === '0'")
    labeller.page.wait("document.getElementById('trouble').textContent === ''")
    assert labeller.value("document.getElementById('note').hidden")
    assert [names[0], "!near", "", ""] in rows(labeller.table), rows(labeller.table)
    at_speed(labeller, *"uu")
    assert rows(labeller.table) == before, rows(labeller.table)

    labeller.value("chooseEpisode(0)")
    network(labeller, latency=500)
    labeller.page.key("f")
    labeller.page.key("b")
    labeller.page.key("Escape")
    labeller.page.key("x")
    labeller.page.wait("document.body.dataset.waiting === '0'")
    assert [names[0], "!near", "", ""] in rows(labeller.table), rows(labeller.table)
    network(labeller)
    at_speed(labeller, "u")
    assert rows(labeller.table) == before, rows(labeller.table)


def refused_key(labeller):
    """What a key was refused for stays on the page until the next one, whatever is answered."""
    labeller.value("chooseEpisode(0)")
    labeller.value("store.waiting.push({action: 'begin', episode: 0, predicate: 9, step: 0})")
    at_speed(labeller, "f")
    assert "b in" in labeller.trouble() and "no such key" in labeller.trouble(), labeller.trouble()
    at_speed(labeller, "u")
    assert labeller.trouble() == "", labeller.trouble()


def late_answers(browser, folder):
    (folder / "late").mkdir()
    (folder / "late" / "stack.etl").write_text(SPEC)
    make_episodes(folder / "late" / "demos")
    (folder / "late" / "demos" / "labels.csv").write_text("episode,predicate,start,end\n" + "".join(
        f"ep{number},near,50,\nep{number},passes,13,36\n" for number in range(3)))
    with Service(ETLC, folder / "late", "--frames", "camera") as service:
        labeller = Labeller(browser, service)
        before = rows(service.table)
        for latency in (0, 60, 150):
            network(labeller, latency)
            go_on_at_once(labeller, before)
            accept_at_once(labeller, before)
            undo_and_go_on(labeller, before)
            late_frames(labeller)
        pending_keys(labeller, before)
        refused_key(labeller)
        assert rows(service.table) == before, rows(service.table)


def main():
    with tempfile.TemporaryDirectory() as name, Browser() as browser:
        folder = pathlib.Path(name)
        (folder / "stack.etl").write_text(SPEC)
        make_episodes(folder / "demos")
        with Service(ETLC, folder, "--frames", "camera") as service:
            labeller = Labeller(browser, service)
            labeller.key("j")
            labeller.key("k")
            label_three(labeller)
            undo_elsewhere(labeller, accept_and_correct(labeller))
            reload(labeller)
            frames_are_exact(labeller)
            play(labeller)
            hostile_name(labeller)
            assert labeller.page.messages == [], labeller.page.messages
            outside = [address for address in labeller.page.requests
                       if not address.startswith(service.address)]
            assert outside == [], outside
            open_twice(browser, service, labeller)
            changed_meanwhile(labeller)
            full_disk(labeller, service)
        late_answers(browser, folder)
        killed(browser, folder)
        without_frames(browser, folder)


main()
