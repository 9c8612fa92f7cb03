"""planning_test.py ETLC: monitors are planned once the client pauses, and for answers about them.

The monitors of spec() exceed the limits, which only planning finds.
"""
import sys

from client import Client

ETLC = sys.argv[1]


def spec(monitors=30):
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
    """Returns the findings of a server that is left in peace."""
    client = Client(ETLC)
    client.open(text)
    first = published(client)
    assert not is_planned(first), first
    found = published(client)
    assert is_planned(found), found
    assert client.end() == 0
    return found["diagnostics"]


def newest_text_wins():
    after = spec().replace("F[0, 309]", "F[0, 308]").replace("heavy", "heavier")
    expected = at_peace(after)
    client = Client(ETLC)
    text = client.open(spec())
    published(client)
    text.replace(spec(9) + "monitor")  # it has an error, so that it has no plan
    text.replace(after)
    while True:
        found = published(client)
        # The first text may have been planned before the others came.
        assert found["version"] != 2 or not is_planned(found), found
        if is_planned(found) and found["version"] == 3:
            break
    assert found["diagnostics"] == expected
    assert client.end() == 0


def ends_at_once():
    client = Client(ETLC)
    text = client.open(spec())
    published(client)
    client.send({"jsonrpc": "2.0", "id": 50, "method": "textDocument/hover",
                 "params": text.params(text.at("m7 ="))})
    client.send({"jsonrpc": "2.0", "id": 51, "method": "shutdown"})
    assert "about the first step" in client.response(50)["result"]["contents"]["value"]
    assert client.response(51)["result"] is None
    client.tell("exit", None)
    assert client.wait() == 0


def budgets_are_there():
    client = Client(ETLC)
    small = "spec a;\ninput x : f32;\nmonitor m = G x > 0;\nmonitor n = F x > 0;\n"
    text = client.open(small)
    for name in "m =", "n =", "m =":
        hover = text.ask("hover", name)["contents"]["value"]
        assert "bytes of state" in hover, hover
    for i in range(20):
        client.send({"jsonrpc": "2.0", "id": f"h{i}", "method": "textDocument/hover",
                     "params": text.params(text.at("m ="))})
        text.replace(small + "// edited\n" * i)
        hover = client.response(f"h{i}")["result"]["contents"]["value"]
        assert "bytes of state" in hover, hover
    heavy = client.open(spec(), "file:///nowhere/heavy.etl")
    assert "about the first step" in heavy.ask("hover", "m7 =")["contents"]["value"]
    heavy.close()
    assert "bytes of state" in text.ask("hover", "m =")["contents"]["value"]
    assert client.end() == 0


newest_text_wins()
ends_at_once()
budgets_are_there()
print("monitors are planned when the client pauses")
