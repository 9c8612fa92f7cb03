"""A client of `etlc lsp` for tests and measurements.

It implements the protocol itself, so that it can also send invalid messages.
"""
import json
import os
import subprocess


class Client:
    """A server process. `capabilities`: of the client; None: no `initialize` is sent."""

    def __init__(self, etlc, capabilities={}, folder=None):
        self.process = subprocess.Popen(
            [etlc, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder)
        self.buffer = b""
        self.last_id = 0
        self.notes = []  # notifications not yet read
        if capabilities is not None:
            self.initialized = self.ask("initialize", {"capabilities": capabilities})
            self.tell("initialized", {})

    # ---- bytes

    def send_bytes(self, data):
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def send(self, message):
        content = json.dumps(message).encode()
        self.send_bytes(b"Content-Length: %d\r\n\r\n" % len(content) + content)

    def receive(self):
        """Returns the next message, or None at the end of the server's output."""
        while True:
            head, mark, rest = self.buffer.partition(b"\r\n\r\n")
            if mark:
                length = int(head.split(b":")[1])
                if len(rest) >= length:
                    self.buffer = rest[length:]
                    return json.loads(rest[:length])
            data = os.read(self.process.stdout.fileno(), 1 << 16)
            if not data:
                return None
            self.buffer += data

    # ---- messages

    def tell(self, method, params):
        self.send({"jsonrpc": "2.0", "method": method, "params": params})

    def response(self, wanted):
        """Returns the response with this id; keeps notifications before it."""
        while True:
            message = self.receive()
            assert message is not None, "the server has ended"
            if "id" in message:
                assert message["id"] == wanted, message
                return message
            self.notes.append(message)

    def try_to_ask(self, method, params):
        self.last_id += 1
        self.send({"jsonrpc": "2.0", "id": self.last_id, "method": method, "params": params})
        return self.response(self.last_id)

    def ask(self, method, params):
        answer = self.try_to_ask(method, params)
        assert "result" in answer, answer
        return answer["result"]

    def error(self, method, params):
        answer = self.try_to_ask(method, params)
        assert "error" in answer, answer
        return answer["error"]

    def note(self, method):
        """Returns the next notification of that kind."""
        while True:
            for i, message in enumerate(self.notes):
                if message["method"] == method:
                    return self.notes.pop(i)["params"]
            message = self.receive()
            assert message is not None and "id" not in message, message
            self.notes.append(message)

    # ---- documents

    def open(self, text, uri="file:///nowhere/a.etl"):
        self.tell("textDocument/didOpen", {"textDocument": {
            "uri": uri, "languageId": "etl", "version": 1, "text": text}})
        return Text(self, uri, text)

    def diagnostics(self):
        return self.note("textDocument/publishDiagnostics")["diagnostics"]

    def end(self):
        """Ends the session by the protocol; returns the exit status."""
        self.ask("shutdown", None)
        self.tell("exit", None)
        return self.wait()

    def wait(self):
        self.process.stdin.close()
        status = self.process.wait()
        self.process.stdout.close()
        return status


class Text:
    """A document that is open in a client."""

    def __init__(self, client, uri, text):
        self.client = client
        self.uri = uri
        self.text = text
        self.version = 1

    def at(self, words, offset=0):
        """Returns the position of the first `words`; the line is ASCII up to there."""
        index = self.text.index(words) + offset
        before = self.text[:index].split("\n")
        return {"line": len(before) - 1, "character": len(before[-1])}

    def change(self, changes):
        self.version += 1
        self.client.tell("textDocument/didChange", {
            "textDocument": {"uri": self.uri, "version": self.version},
            "contentChanges": changes})

    def replace(self, text):
        self.text = text
        self.change([{"text": text}])

    def params(self, position, **more):
        return {"textDocument": {"uri": self.uri}, "position": position, **more}

    def ask(self, method, words, offset=0, **more):
        return self.client.ask("textDocument/" + method,
                               self.params(self.at(words, offset), **more))

    def error(self, method, words, offset=0, **more):
        return self.client.error("textDocument/" + method,
                                 self.params(self.at(words, offset), **more))

    def close(self):
        self.client.tell("textDocument/didClose", {"textDocument": {"uri": self.uri}})


def offset_of(text, position):
    """Returns the index of a position in UTF-16 units."""
    kept = text.splitlines(keepends=True)
    if position["line"] >= len(kept):
        return len(text)
    start = sum(len(line) for line in kept[:position["line"]])
    units = 0
    for i, character in enumerate(kept[position["line"]]):
        if units >= position["character"]:
            return start + i
        units += 2 if ord(character) > 0xFFFF else 1
    return start + len(kept[position["line"]])


def applied(text, edits):
    """Returns the text after edits that do not overlap."""
    for edit in sorted(edits, key=lambda e: offset_of(text, e["range"]["start"]), reverse=True):
        begin = offset_of(text, edit["range"]["start"])
        end = offset_of(text, edit["range"]["end"])
        text = text[:begin] + edit["newText"] + text[end:]
    return text
