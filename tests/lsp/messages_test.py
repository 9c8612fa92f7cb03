"""messages_test.py ETLC: valid and invalid messages of a client.

Every request gets its answer, bad messages get the error of the protocol, and the server ends with
the status of the protocol: 0 after `shutdown`, else 1.
"""
import subprocess
import sys

from client import Client

ETLC = sys.argv[1]
SPEC = "spec a;\ninput x : f32;\nmonitor m = G x > 0;\n"


def life():
    client = Client(ETLC, {"general": {"positionEncodings": ["utf-16", "utf-8"]}})
    offered = client.initialized["capabilities"]
    assert offered["positionEncoding"] == "utf-8", offered
    assert offered["textDocumentSync"]["change"] == 2
    client.open(SPEC)
    assert client.diagnostics() == []
    assert client.end() == 0

    client = Client(ETLC)
    assert client.initialized["capabilities"]["positionEncoding"] == "utf-16"
    client.tell("exit", None)  # without shutdown
    assert client.wait() == 1

    client = Client(ETLC)  # the input ends
    assert client.wait() == 1
    client = Client(ETLC)
    client.ask("shutdown", None)
    assert client.wait() == 0
    client = Client(ETLC, None)  # nothing at all
    assert client.wait() == 1

    def status(*arguments):
        return subprocess.run([ETLC, "lsp", *arguments], stdin=subprocess.DEVNULL,
                              capture_output=True).returncode

    assert status("--stdio") == 1 and status("--help") == 0
    assert status("a.etl") == 2 and status("--port", "3") == 2


def order():
    client = Client(ETLC, None)
    assert client.error("textDocument/hover", {})["code"] == -32002
    client.tell("textDocument/didOpen", {"textDocument": {"uri": "file:///a", "text": SPEC}})
    client.tell("initialized", {})
    client.ask("initialize", {"capabilities": {}})
    assert client.error("initialize", {"capabilities": {}})["code"] == -32600
    assert client.error("textDocument/unheardOf", {})["code"] == -32601
    assert client.error("$/unheardOf", {})["code"] == -32601
    client.tell("$/unheardOf", {})
    client.tell("unheardOf", {})
    # A document opened too early is not open.
    where = {"textDocument": {"uri": "file:///a"}, "position": {"line": 0, "character": 0}}
    assert client.error("textDocument/hover", where)["code"] == -32602
    client.ask("shutdown", None)
    assert client.error("textDocument/hover", where)["code"] == -32600
    assert client.error("shutdown", None)["code"] == -32600
    client.tell("exit", None)
    assert client.wait() == 0


def bad_frames():
    client = Client(ETLC)

    def refused(data, code):
        client.send_bytes(data)
        answer = client.receive()
        assert answer["id"] is None and answer["error"]["code"] == code, answer

    def frame(content):
        return b"Content-Length: %d\r\n\r\n" % len(content) + content

    for content, code in [
            (b"", -32700), (b"{", -32700), (b"\xff\xfe", -32700), (b'{"a": "\\ud800"}', -32700),
            (b"[" * 100000, -32700), (b"[]", -32600), (b"3", -32600), (b"null", -32600),
            (b'[{"jsonrpc": "2.0", "id": 1, "method": "shutdown"}]', -32600),
            (b'{"id": [1], "jsonrpc": "2.0", "method": "shutdown"}', -32600),
            (b'{"jsonrpc": "2.0", "method": 3}', -32600),
            (b'{"method": "shutdown"}', -32600)]:
        refused(frame(content), code)
    refused(b"Content-Type: x\r\n\r\n", -32700)
    refused(b"Content-Length: -3\r\n\r\n", -32700)
    refused(b"Content-Length: 1e3\r\n\r\n", -32700)
    refused(b"Content-Length: 99999999999999999999\r\n\r\n", -32700)
    refused(b"GET / HTTP/1.1\r\n\r\n", -32700)
    refused(b"x" * 100000 + b"\r\n\r\n", -32700)
    refused(b"Content-Type: x; charset=utf-16\r\nContent-Length: 1\r\n\r\n", -32700)
    refused(b"3", -32600)
    # The rest of a broken message ends where the next one begins, on the same line.
    refused(b'{"jsonrpc": "2.0"}Content-Length: 2\r\n\r\n', -32700)
    refused(b"{}", -32600)
    # Too long: skipped without storing it.
    refused(b"Content-Length: 20000000\r\n\r\n", -32700)
    client.send_bytes(b" " * 20000000)
    # A wrong version with a valid id.
    client.send({"jsonrpc": "1.0", "id": "x", "method": "shutdown"})
    assert client.receive()["id"] == "x"
    # Answers without a request.
    client.send({"jsonrpc": "2.0", "id": 7, "result": None})
    client.send({"jsonrpc": "2.0", "id": 7, "error": {"code": 1, "message": "no"}})
    assert client.end() == 0

    # Byte by byte, with other headers, in another case.
    client = Client(ETLC)
    content = b'{"jsonrpc": "2.0", "id": "one", "method": "shutdown"}'
    data = (b"content-type: application/vscode-jsonrpc; charset=utf8\r\n"
            b"CONTENT-LENGTH:%d\r\nX-Other: 1\r\n\r\n" % len(content) + content)
    for i in range(len(data)):
        client.send_bytes(data[i:i + 1])
    assert client.receive() == {"jsonrpc": "2.0", "id": "one", "result": None}
    client.tell("exit", None)
    assert client.wait() == 0

    # The input ends in a header, in content, in a message that is too long.
    for data in [b"Content-Le", b"Content-Length: 10\r\n\r\n{",
                 b"Content-Length: 99999999\r\n\r\n{"]:
        client = Client(ETLC)
        client.send_bytes(data)
        assert client.wait() == 1


def bad_params():
    client = Client(ETLC)
    text = client.open(SPEC)
    assert client.diagnostics() == []
    for params in [None, 3, [], {}, {"textDocument": 3}, {"textDocument": {"uri": 3}},
                   {"textDocument": {"uri": text.uri}},
                   text.params({"line": -1, "character": 0}),
                   text.params({"line": 0.5, "character": 0}),
                   text.params({"line": 1 << 40, "character": 0}),
                   text.params({"line": "0", "character": 0}),
                   {"textDocument": {"uri": "file:///other"},
                    "position": {"line": 0, "character": 0}}]:
        for method in ["hover", "definition", "references", "documentHighlight", "prepareRename",
                       "rename", "completion"]:
            assert client.error("textDocument/" + method, params)["code"] == -32602, params
    # A notification has no answer; it is logged.
    client.tell("textDocument/didChange", {"textDocument": {"uri": text.uri, "version": 2}})
    assert "contentChanges" in client.note("window/logMessage")["message"]
    client.tell("textDocument/didClose", {"textDocument": {"uri": "file:///other"}})
    assert "not open" in client.note("window/logMessage")["message"]
    client.tell("textDocument/didChange", {
        "textDocument": {"uri": "file:///other", "version": 2}, "contentChanges": []})
    assert "not open" in client.note("window/logMessage")["message"]
    # Positions beyond the text count as its end.
    far = {"line": 4000000000, "character": 4000000000}
    assert client.ask("textDocument/hover", text.params(far)) is None
    # Without any params.
    client.send({"jsonrpc": "2.0", "id": 99, "method": "textDocument/hover"})
    assert client.response(99)["error"]["code"] == -32602
    client.last_id = 99
    assert client.end() == 0


def edits():
    client = Client(ETLC)
    text = client.open("")
    assert client.diagnostics()[0]["message"].startswith("the file is empty")

    def edit(start, end, new):
        text.change([{"range": {"start": dict(zip(("line", "character"), start)),
                                "end": dict(zip(("line", "character"), end))}, "text": new}])

    edit((0, 0), (0, 0), "spec a;\ninput x : f32;\nmonitor m = G x > 0;\n")
    assert client.diagnostics() == []
    edit((1, 6), (1, 7), "y")
    found = client.diagnostics()
    assert [d["code"] for d in found] == ["E0204"] and found[0]["range"]["start"]["line"] == 2
    edit((1, 7), (1, 6), "x")  # backwards
    assert client.diagnostics() == []
    edit((99, 0), (99, 5), "// end")  # beyond the end
    edit((2, 900), (2, 900), " // behind the line")
    assert client.diagnostics() == []
    hover = client.ask("textDocument/hover", text.params({"line": 2, "character": 15}))
    assert "float32" in hover["contents"]["value"], hover
    # Several edits of one message apply in order; one may replace the whole text.
    text.change([{"text": "spec b;\n"},
                 {"range": {"start": {"line": 1, "character": 0},
                            "end": {"line": 1, "character": 0}},
                  "text": "input p : bool; monitor m = G p;"}])
    assert [d["code"] for d in client.diagnostics()] == []
    # After a burst of edits only the last state is checked.
    for i in range(200):
        edit((0, 5), (0, 6), "abc"[i % 3])
    client.ask("textDocument/documentSymbol", {"textDocument": {"uri": text.uri}})
    text.close()
    while client.diagnostics():
        pass
    assert client.end() == 0


def beyond_the_basic_plane():
    # The emoji takes two UTF-16 units and four bytes.
    spec = 'spec a;\ninput x : f32; /* \U0001F600 */ monitor m = G (x > 0 && q);\n'
    column_of_q = spec.split("\n")[1].index("q")
    for encodings, more in [(None, 1), (["utf-8", "utf-16"], 3), (["utf-32"], 1)]:
        column = column_of_q + more
        client = Client(ETLC, {"general": {"positionEncodings": encodings}} if encodings else {})
        text = client.open(spec)
        found, = client.diagnostics()
        assert found["range"]["start"] == {"line": 1, "character": column}, found
        assert found["range"]["end"] == {"line": 1, "character": column + 1}, found
        # An edit that begins in the middle of the emoji begins before it.
        face = spec.split("\n")[1].index("\U0001F600")
        text.change([{"range": {"start": {"line": 1, "character": face + more},
                                "end": {"line": 1, "character": face + more + 1}},
                      "text": "*/ /*"}])
        found, = client.diagnostics()
        assert found["range"]["start"]["character"] == column_of_q + 4, found
        assert client.end() == 0


life()
order()
bad_frames()
bad_params()
edits()
beyond_the_basic_plane()
print("all messages are answered")
