#!/usr/bin/env python3
"""server_test.py ETLC: what `etlc label` refuses, how fast a key is on disk, and what it proposes,
without a browser."""
import http.client
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np

from service import SPEC, STEPS, Service, make_episodes, rows

ETLC = sys.argv[1]


def request(service, path, method="GET", body=None, **headers):
    connection = http.client.HTTPConnection("127.0.0.1", service.port)
    connection.request(method, path, body, headers)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer.status, content


def act(service, **what):
    status, content = request(service, f"/{service.token}/act", "POST",
                              json.dumps({"page": "test", **what}))
    return status, json.loads(content)


def only_with_the_token(service):
    token = service.token
    for path in ("/", "/act", "/frame/0/0", "/favicon.ico", f"/{token}", f"/{token[:-1]}/",
                 f"/{token[:-1]}x/", f"/{token}x/", f"//{token}/", f"/x/{token}/", "/../etc/passwd",
                 f"/{'0' * 32}/act"):
        for method in ("GET", "POST", "HEAD", "PUT", "DELETE", "OPTIONS", "PATCH"):
            status, _ = request(service, path, method)
            assert status == 403, (method, path, status)
    inside = f"/{token}/"
    assert request(service, inside)[0] == 200
    for wrong in ({"Host": "evil.example"}, {"Host": f"evil.example:{service.port}"},
                  {"Host": "127.0.0.1:1"}, {"Origin": "http://evil.example"}, {"Origin": "null"},
                  {"Origin": f"https://127.0.0.1:{service.port}"}):
        status, _ = request(service, inside, **wrong)
        assert status == 403, (wrong, status)
    for right in ({"Host": f"localhost:{service.port}"},
                  {"Origin": f"http://127.0.0.1:{service.port}"}):
        assert request(service, inside, **right)[0] == 200, right
    for path in ("etc/passwd", "../labels.csv", "frame/0/60", "frame/9/0", "frame/0", "frame/-1/0",
                 "frame/0/x", "state", "labels.csv"):
        status, _ = request(service, inside + path)
        assert status in (400, 404), (path, status)


def only_on_the_loopback(service):
    """The port is one that other machines cannot reach."""
    lines = pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]
    listening = [line.split()[1] for line in lines if line.split()[3] == "0A"]
    ours = [address for address in listening if int(address.split(":")[1], 16) == service.port]
    assert ours == [f"0100007F:{service.port:04X}"], ours
    six = pathlib.Path("/proc/net/tcp6")
    lines = six.read_text().splitlines()[1:] if six.exists() else []
    assert not [line for line in lines if line.split()[1].endswith(f":{service.port:04X}")]


def nonsense(service):
    """Requests that no page makes change nothing, and end nothing."""
    for body in (b"", b"{", b"[]", b"null", b'{"page": 1}', b'{"page": "test", "action": "begin"}',
                 b'{"page": "test", "action": "begin", "episode": 99}', b"\xff" * 100,
                 b'{"page": "test", "action": "burn", "episode": 0, "predicate": 0, "step": 0}',
                 b'{"page": "test", "action": "end", "episode": 0, "predicate": 7, "step": 0}',
                 b'{"page": "test", "action": "end", "episode": 0, "predicate": 0, "step": 60}',
                 b'{"page": "test", "action": "accept", "episode": 0}'):
        for path in ("act", "state"):
            status, _ = request(service, f"/{service.token}/{path}", "POST", body)
            assert status in (200, 400) if path == "state" else status == 400, (body, status)
    with socket.create_connection(("127.0.0.1", service.port)) as raw:
        raw.sendall(b"\0\1\2 nonsense\r\n\r\n")
        raw.recv(1000)
    assert not service.table.exists()


def refused(folder, message, *words):
    done = subprocess.run([ETLC, "label", "stack.etl", "--data", "demos", *words], cwd=folder,
                          capture_output=True, text=True)
    assert done.returncode == 1 and message in done.stderr, done.stderr


def wrong_tables(folder):
    table = folder / "demos" / "labels.csv"
    for row, message in (("ep77,near,1,2", "[E0861]"), ("ep1,neer,1,2", "did you mean 'near'"),
                         ("ep1,near,2,1", "[E0860]"), ("ep1,near,5,61", "[E0861]"),
                         ("ep1,near,5,9\nep1,near,8,", "[E0862]")):
        table.write_text(f"episode,predicate,start,end\n{row}\n")
        refused(folder, message)
    table.write_text("episode,predicate,start_s,end_s\nep1,near,0.5,1.2\n")
    with Service(ETLC, folder) as service:
        status, _ = act(service, action="end", episode=1, predicate=0, step=9)
        assert status == 200
        # The hostile name is the first episode, so number 1 is ep0.
        assert rows(table) == [["ep0", "near", "0", "1"],
                               ["ep1", "near", "0.5", "1.2"]], rows(table)
    table.unlink()
    refused(folder, "expected {episode}", "--frames", "camera/*.png")
    array = np.zeros(STEPS, bool)
    np.savez(folder / "demos" / "ep7.npz", **{"truth.near": array}, z=np.zeros((STEPS, 2), "f4"))
    with Service(ETLC, folder) as service:
        status, said = act(service, action="begin", episode=6, predicate=0, step=0)
        assert status == 400 and "array" in said["error"], said
        assert act(service, action="begin", episode=6, predicate=1, step=0)[0] == 200
        taken = subprocess.run([ETLC, "label", "stack.etl", "--data", "demos", "--port",
                                str(service.port)], cwd=folder, capture_output=True, text=True)
        assert taken.returncode == 1 and "another program listens" in taken.stderr, taken.stderr
    table.unlink()
    (folder / "demos" / "ep7.npz").unlink()


def proposals(folder):
    call = [ETLC, "label", "stack.etl", "--data", "demos", "--proposals"]

    def proposed():
        done = subprocess.run(call, cwd=folder, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)

    table = folder / "demos" / "labels.csv"
    table.write_text("episode,predicate,start,end\n" + "".join(
        f"ep{number},near,50,\nep{number},passes,13,36\n" for number in range(2)))
    assert proposed() == {"labelled": 2, "why_none": "", "proposals": []}
    with table.open("a") as file:
        file.write("ep2,near,49,\nep2,passes,13,35\n")
    found = proposed()
    assert found["labelled"] == 3 and len(found["proposals"]) == 3, found
    doubts = [one["doubt"] for one in found["proposals"]]
    assert doubts == sorted(doubts, reverse=True), doubts
    for one in found["proposals"]:
        z = np.load(folder / "demos" / f"{one['name']}.npz")["z"]
        [[start, end, code]] = one["predicates"]["passes"]
        true = np.flatnonzero(np.abs(z[:, 0] - 3) <= 1)
        assert code == 1 and abs(start - true[0]) <= 1 and abs(end - 1 - true[-1]) <= 1, one
    table.write_text("episode,predicate\n" + "".join(
        f"ep{number},!near\nep{number},passes\n" for number in range(3)))
    done = subprocess.run(call, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0 and "no labelled step of 'near' is true" in done.stdout, done
    for one in json.loads(done.stdout)["proposals"]:
        assert list(one["predicates"]) == ["passes"], one
    table.unlink()


def late_encoders(folder):
    """What an encoder sees late, or ceases to see late, is proposed where the labels have it."""
    late = folder / "late"
    late.mkdir()
    starts = [20, 31, 17, 40, 25, 0]
    for number, start in enumerate(starts):
        seen = np.zeros(90)
        seen[start + 7 if start else 0:start + 33] = 1  # it holds from start to start + 30
        np.savez(late / f"ep{number}.npz", x=seen + 0.01 * number)
    (late / "labels.csv").write_text("episode,predicate,start,end\n" + "".join(
        f"ep{number},lit,{starts[number]},{starts[number] + 30}\n" for number in range(3)))
    (folder / "late.etl").write_text("spec late;\ninput x : f32;\n"
                                     "predicate lit = x >= calibrated(f1);\nmonitor m = F lit;\n")
    done = subprocess.run([ETLC, "label", "late.etl", "--data", "late", "--proposals"], cwd=folder,
                          capture_output=True, text=True, check=True)
    found = {one["name"]: one["predicates"]["lit"] for one in json.loads(done.stdout)["proposals"]}
    # The last one begins with the episode: nobody knows how long before it.
    assert found == {f"ep{number}": [[starts[number], starts[number] + 30, 1]]
                     for number in range(3, 6)}, found


def slow_connections(service):
    """Connections that send a byte now and then keep no page waiting."""
    slow = []
    is_over = threading.Event()

    def dribble():
        while not is_over.wait(0.2):
            for connection in slow:
                connection.send(b"x")

    for _ in range(200):
        slow.append(socket.create_connection(("127.0.0.1", service.port)))
        slow[-1].send(b"GET / HTTP/1.1\r\nX: ")
    dribbling = threading.Thread(target=dribble)
    dribbling.start()
    try:
        for _ in range(5):
            assert request(service, f"/{service.token}/")[0] == 200
    finally:
        is_over.set()
        dribbling.join()
        for connection in slow:
            connection.close()


def two_labellers(folder):
    """Two calls label one folder at a time, each its own episodes: no key that was acknowledged is
    lost, though each reads the table again whenever the other one has written."""
    count = 30
    (folder / "demos").rename(folder / "others")
    (folder / "demos").mkdir()
    for number in range(count):
        np.savez(folder / "demos" / f"run{number}.npz", z=np.zeros((STEPS, 2), np.float32))
    acknowledged, refusals = {}, []

    def label(service, episodes):
        for episode in episodes:
            name = service.names[episode]
            for predicate in range(2):
                step = (7 * episode + predicate) % (STEPS - 1) + 1
                while True:
                    status, _ = act(service, action="begin", episode=episode, predicate=predicate,
                                    step=step)
                    if status == 200:
                        break
                    assert status == 409, status
                    refusals.append(episode)
                    act(service, action="reload")
                acknowledged[name, ("near", "passes")[predicate]] = str(step)

    with Service(ETLC, folder) as one, Service(ETLC, folder) as two:
        threads = []
        for first, service in enumerate((one, two)):
            service.names = sorted(f"run{number}" for number in range(count))
            threads.append(threading.Thread(target=label,
                                            args=(service, range(first, count, 2))))
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        found = {(name, predicate): start for name, predicate, start, _ in rows(one.table)}
    assert len(acknowledged) == 2 * count, acknowledged
    assert found == acknowledged, sorted(set(acknowledged.items()) - set(found.items()))
    print(f"two labellers: {len(acknowledged)} keys, each refused {len(refusals)} times and "
          "pressed again, none lost")
    shutil.rmtree(folder / "demos")
    (folder / "others").rename(folder / "demos")


def sent_twice(service):
    """A page that got no answer to a key sends it again: it is done once."""
    table = service.table
    assert act(service, action="end", episode=1, predicate=0, step=9)[0] == 200
    first = act(service, action="unknown", episode=1, predicate=0, step=3, number=7)
    assert rows(table) == [["ep0", "?near", "0", "10"]], rows(table)
    assert act(service, action="unknown", episode=1, predicate=0, step=3, number=7) == first
    assert rows(table) == [["ep0", "?near", "0", "10"]], rows(table)
    assert act(service, action="unknown", episode=1, predicate=0, step=3, number=8)[0] == 200
    assert rows(table) == [["ep0", "near", "0", "10"]], rows(table)


def accepts_what_is_shown(service):
    """Key `a` carries the labels that the page shows, whatever is proposed by now."""
    for marks in ([[[5, 5, 1]]], [[[0, STEPS + 1, 1]]], [[[4, 9, 1], [8, 12, 1]]], [[["x", 3, 1]]],
                  [3], 3):
        status, said = act(service, action="accept", episode=2, marks=marks)
        assert status == 400, (marks, said)
    shown = [[[5, 9, 1], [20, STEPS, 2]], None]
    status, said = act(service, action="accept", episode=2, marks=shown)
    assert status == 200 and said["labels"] == shown, said
    assert act(service, action="undo")[0] == 200


def another_table(folder):
    with Service(ETLC, folder, "--labels", "mine.csv") as service:
        assert act(service, action="never", episode=1, predicate=1, step=0)[0] == 200
        assert rows(folder / "mine.csv") == [["ep0", "!passes", "", ""]]
        assert not service.table.exists()
    refused(folder, "[E0860]", "--labels", "stack.etl")


def without_a_server(folder):
    (folder / "bin").mkdir()
    alone = folder / "bin" / "etlc"
    shutil.copy(ETLC, alone)
    done = subprocess.run([alone, "label", "stack.etl", "--data", "demos"], cwd=folder,
                          capture_output=True, text=True)
    assert done.returncode == 1 and "libcpp-httplib-dev" in done.stderr, done.stderr


def ends_together(folder):
    """Whichever of the two processes is killed, the other one ends, and etlc says why."""
    with Service(ETLC, folder) as service:
        [listener] = children(service.process.pid)
        os.kill(listener, signal.SIGKILL)
        assert service.process.wait() == 1
        said = service.process.stderr.read()
        assert "etlc-serve was stopped by signal 9" in said, said
    with Service(ETLC, folder) as service:
        [listener] = children(service.process.pid)
        service.process.send_signal(signal.SIGINT)
        service.process.wait()
        while pathlib.Path(f"/proc/{listener}/exe").exists():  # a zombie has no program
            time.sleep(0.02)


def children(process):
    text = pathlib.Path(f"/proc/{process}/task/{process}/children").read_text()
    return [int(word) for word in text.split()]


def time_to_disk(service):
    times = []
    for step in range(60):
        begun = time.monotonic()
        assert act(service, action="begin", episode=0, predicate=0, step=step)[0] == 200
        times.append(time.monotonic() - begun)
        assert rows(service.table)[0][2] in (str(step), "") or step == 0
    status = pathlib.Path(f"/proc/{service.process.pid}/status").read_text()
    memory = [line.split()[1] for line in status.splitlines() if line.startswith("VmHWM")][0]
    print(f"a key is on disk after {1000 * np.median(times):.1f} ms, at most "
          f"{1000 * max(times):.1f} ms; memory {int(memory) / 1024:.0f} MiB")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "stack.etl").write_text(SPEC)
        make_episodes(folder / "demos")
        with Service(ETLC, folder, "--frames", "camera") as service:
            only_with_the_token(service)
            only_on_the_loopback(service)
            nonsense(service)
            slow_connections(service)
            sent_twice(service)
            accepts_what_is_shown(service)
            act(service, action="forget", episode=1, predicate=0, step=0)
            time_to_disk(service)
            service.table.unlink()
        wrong_tables(folder)
        two_labellers(folder)
        another_table(folder)
        without_a_server(folder)
        ends_together(folder)
        proposals(folder)
        late_encoders(folder)


main()
