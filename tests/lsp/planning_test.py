"""planning_test.py ETLC: the server answers while it plans, and plans only the newest text.

The monitors need a whole second of planning on any machine: none fits the limits, and rewritings
are tried. Times are only compared with each other.
"""
import sys
import time

from client import Client

ETLC = sys.argv[1]
PAUSE = 0.25  # until the server begins to plan


def spec(monitors=100):
    lines = ["spec heavy;", "input x, y : f32;"]
    lines += [f"monitor m{i} = G (x > {i} -> F[0, {300 + i}] (y > {i} && G[0, 200] x < {i}));"
              for i in range(monitors)]
    return "\n".join(lines) + "\n"


def published(client):
    return client.note("textDocument/publishDiagnostics")


def is_planned(found):
    """Whether the findings are those of planning, too: the limits are exceeded."""
    return any(d["code"].startswith("E07") for d in found["diagnostics"])


def at_peace(text):
    """Returns the findings of a server that is left in peace, and the seconds that it takes."""
    client = Client(ETLC)
    start = time.monotonic()
    client.open(text)
    first = published(client)
    assert not is_planned(first), first
    found = published(client)
    assert is_planned(found), found
    assert client.end() == 0
    return found["diagnostics"], time.monotonic() - start


def answers_meanwhile():
    expected, seconds = at_peace(spec())
    assert seconds > 2 * PAUSE, f"planning takes only {seconds} s, so this test would see nothing"
    client = Client(ETLC)
    text = client.open(spec())
    assert not is_planned(published(client))
    begun, longest, answers = time.monotonic(), 0, 0
    while client.notes == []:
        asked = time.monotonic()
        hover = text.ask("hover", "y : f32")
        assert "float32" in hover["contents"]["value"], hover
        longest = max(longest, time.monotonic() - asked)
        answers += 1
    waited = time.monotonic() - begun
    assert longest < waited / 2, f"of {waited} s, an answer took {longest} s"
    assert answers > 5, answers
    assert published(client)["diagnostics"] == expected
    assert client.end() == 0


def newest_text_wins():
    after = spec().replace("F[0, 399]", "F[0, 398]").replace("heavy", "heavier")
    expected, seconds = at_peace(after)
    client = Client(ETLC)
    text = client.open(spec())
    published(client)
    time.sleep(PAUSE + (seconds - PAUSE) / 4)
    text.replace(spec(99) + "monitor")  # it has an error, so that it has no plan
    time.sleep(seconds / 8)
    text.replace(after)
    versions = []
    while True:
        found = published(client)
        versions.append(found["version"])
        assert versions == sorted(versions), versions
        if is_planned(found) and found["version"] == 3:
            break
        # The first text may have been planned before the others came.
        assert not is_planned(found) or found["version"] == 1, found
    assert found["diagnostics"] == expected
    assert client.end() == 0


def ends_meanwhile():
    client = Client(ETLC)
    text = client.open(spec())
    published(client)
    # A monitor's budget waits for the plan, and the end does not.
    client.send({"jsonrpc": "2.0", "id": 50, "method": "textDocument/hover",
                 "params": text.params(text.at("m7 ="))})
    client.send({"jsonrpc": "2.0", "id": 51, "method": "shutdown"})
    assert "about the first step" in client.response(50)["result"]["contents"]["value"]
    assert client.response(51)["result"] is None
    assert client.notes == []
    client.tell("exit", None)
    assert client.wait() == 0


def budgets_wait():
    client = Client(ETLC)
    small = "spec a;\ninput x : f32;\nmonitor m = G x > 0;\nmonitor n = F x > 0;\n"
    text = client.open(small)
    for name in "m =", "n =", "m =":
        hover = text.ask("hover", name)["contents"]["value"]
        assert "bytes of state" in hover, hover
    # Of a text that is edited meanwhile, the budget may be unknown; nothing else is.
    for i in range(20):
        client.send({"jsonrpc": "2.0", "id": f"h{i}", "method": "textDocument/hover",
                     "params": text.params(text.at("m ="))})
        text.replace(small + "// edited\n" * i)
        hover = client.response(f"h{i}")["result"]["contents"]["value"]
        assert "Monitor: about the first step." in hover, hover
    # While another text is planned, and after it was closed.
    heavy = client.open(spec(), "file:///nowhere/heavy.etl")
    heavy.ask("hover", "y : f32")
    client.send({"jsonrpc": "2.0", "id": "heavy", "method": "textDocument/hover",
                 "params": heavy.params(heavy.at("m7 ="))})
    client.send({"jsonrpc": "2.0", "id": "small", "method": "textDocument/hover",
                 "params": text.params(text.at("m ="))})
    answers = {}
    while len(answers) < 2:
        message = client.receive()
        if "id" in message:
            answers[message["id"]] = message["result"]["contents"]["value"]
    assert "bytes of state" in answers["small"], answers
    assert "about the first step" in answers["heavy"], answers
    heavy.close()
    assert client.end() == 0


answers_meanwhile()
newest_text_wins()
ends_meanwhile()
budgets_wait()
print("the server answers while it plans")
