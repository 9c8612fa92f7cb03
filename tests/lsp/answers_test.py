"""answers_test.py ETLC CASES: tests the answers of the server about specs.

CASES: the folder tests/spec, whose specs get the diagnostics of `etlc SPEC --check`.
"""
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

from client import Client, applied

ETLC = os.path.abspath(sys.argv[1])
CASES = pathlib.Path(sys.argv[2]).resolve()

DOCK = """spec dock;
rate 20 Hz;
const limit = 0.25;
const patience = 0.5 s;
input z    : f32[2] hold 3 steps;  // the camera
input grip : f32 in [0, 1];
input stop : bool;
target bay = [[1, 0], [0, 1]];
predicate at_bay = min cosine(z, bay) <= limit;
predicate closed = grip >= 0.75;
let carrying = closed && !at_bay;
monitor arrive = F at_bay;
sliding monitor steady = G[0, patience] (carrying -> closed || stop);
"""


def checked(path):
    """Returns the messages of `etlc SPEC --check`, as code, line and message."""
    called = subprocess.run([ETLC, path.name, "--check", "--diagnostics", "json"], cwd=path.parent,
                            stderr=subprocess.PIPE)
    found = json.loads(called.stderr)["diagnostics"]
    return [(d["code"], d["severity"], d["line"] if d["file"] == path.name else None, d["message"])
            for d in found]


def shown(diagnostics):
    severities = {1: "error", 2: "warning", 3: "note"}
    return [(d["code"], severities[d["severity"]], d["range"]["start"]["line"] + 1, d["message"])
            for d in diagnostics]


def same_as_check():
    """Diagnoses every spec with a mistake, and every good one."""
    client = Client(ETLC)
    compared = 0
    for path in sorted(CASES.glob("error/*.etl")) + sorted(CASES.glob("ok/*.etl")):
        data = path.read_bytes()
        try:
            text = data.decode()
        except UnicodeDecodeError:
            continue
        if path.with_suffix(".args").exists() or len(data) > 100000:
            continue
        expected = checked(path)
        document = client.open(text, path.as_uri())
        found = shown(client.diagnostics())
        # Findings of the planner arrive when the client is quiet.
        if len(found) < len(expected):
            found = shown(client.diagnostics())
        document.close()
        assert client.diagnostics() == []
        assert len(found) == len(expected), (path, found, expected)
        kinds = sorted(f[:2] for f in found), sorted(e[:2] for e in expected)
        assert kinds[0] == kinds[1], (path, found, expected)
        known = [(code, line, message.split("\n")[0]) for code, _, line, message in found]
        for code, _, line, message in expected:
            assert line is None or (code, line, message.split("\n")[0]) in known, (path, message)
        compared += 1
    assert compared > 120, compared
    assert client.end() == 0


def hovers():
    client = Client(ETLC)
    text = client.open(DOCK)
    assert client.diagnostics() == []

    def hover(words, offset=0):
        return text.ask("hover", words, offset)["contents"]["value"]

    assert "embedding of dimension 2 in float32" in hover("z    :")
    assert "3 missing" in hover("(z,", 1)
    assert "[0, 1]" in hover("grip >=", 4)  # after the last letter
    assert "2 rows of dimension 2, written in the spec" in hover("bay)")
    predicate = hover("at_bay;")
    assert "min cosine(z, bay) <= 0.25" in predicate and "no guarantee" in predicate, predicate
    assert "0.5 s" in hover("patience]")
    assert "Let: closed && !at_bay." in hover("carrying ->")
    steady = hover("steady")
    assert "10 steps late" in steady and "bytes of state" in steady, steady
    assert "operations a step" in hover("arrive")
    assert "at some time" in hover("F at_bay")
    assert "cosine of the angle" in hover("cosine")
    assert "spec dock;" in hover("dock")
    assert text.ask("hover", "= limit") is None
    # Hover works in spite of a mistake elsewhere, for names that the mistake does not affect.
    text.replace(DOCK.replace("let carrying = closed", "let carrying = closd"))
    assert "2 rows" in hover("bay)") and "carrying" in hover("carrying ->")
    text.replace(DOCK.replace("limit;", "limit"))
    assert "2 rows" in hover("bay = ")
    assert client.end() == 0
    # As plain text or as Markdown.
    client = Client(ETLC, {"textDocument": {"hover": {"contentFormat": ["markdown"]}}})
    text = client.open(DOCK)
    assert text.ask("hover", "at_bay")["contents"] == {"kind": "markdown", "value": (
        "```etl\npredicate at_bay = min cosine(z, bay) <= limit;\n```\n\n"
        "Predicate: min cosine(z, bay) \\<= 0.25.\n\n"
        "Threshold 0.25: written in the spec; no guarantee.\n\nRobustness in \\[-1.75, 0.25\\].")}
    assert client.end() == 0


def words():
    """Every word of the specs of this project has a hover, but names that another file declares."""
    client, seen = Client(ETLC), set()
    for path in sorted((CASES / "ok").glob("*.etl")) + sorted(
            (CASES.parent.parent / "examples").glob("*/*.etl")):
        spec = path.read_text()
        text = client.open(spec, path.as_uri())
        blank = re.sub(r'//[^\n]*|/\*.*?\*/|"[^"\n]*"|\b\d[\w.]*',
                       lambda found: re.sub(r"[^\n]", " ", found[0]), spec, flags=re.S)
        for word in re.finditer(r"[A-Za-z_]\w*", blank):
            if word[0] in seen or not spec.isascii():
                continue
            seen.add(word[0])
            line = spec.count("\n", 0, word.start())
            column = word.start() - spec.rfind("\n", 0, word.start()) - 1
            place = {"position": {"line": line, "character": column}}
            shown = client.ask("textDocument/hover", {"textDocument": {"uri": text.uri}, **place})
            assert shown is not None, (path.name, line + 1, word[0])
        text.close()
    assert len(seen) > 300, len(seen)
    assert client.end() == 0


def thresholds():
    """Calibrated and fitted entries, with their origin and guarantee."""
    client = Client(ETLC)

    def hovers(name, *facts):
        path = CASES / "ok" / f"{name}.etl"
        text = client.open(path.read_text(), path.as_uri())
        for words, fact in facts:
            shown = text.ask("hover", words, len(words))["contents"]["value"]
            assert fact in shown, (fact, shown)

    hovers("language",
           ("predicate at_a", "Threshold 0.35: conformal, alpha = 0.10; score 9 of 9"),
           ("target goal_a", "3 rows of dimension 2, from goal_a.npy"),
           ("monitor reach", "P(some verdict of a new episode misses a success) <= 0.1"),
           ("monitor avoid", "No guarantee: 'near_c' has a threshold that was not calibrated"),
           ("monitor steady", "20 steps late"))
    hovers("drift", ("drift camera_moved", "without reason ever with probability <= 0.01"),
           ("of calm", "P(a false alarm in a new normal episode) <= 0.5"))
    hovers("adaptive",
           ("predicate low", "in [0.5, 2]; starts at conformal score 3 of 3"),
           ("predicate low", "misses at most 0.25 T + 4.0 + 0.75 H"),
           ("predicate high", "Robustness in [-3, 3]"),
           ("monitor both", "Budget: 32 bytes of state"))
    hovers("projections",
           ("projection P", "from dimension 3 to 2, written in the spec"),
           ("target centre", "2 rows of dimension 2, fitted"),
           ("target known", "in the space of P(z)"))
    assert client.end() == 0


def places():
    client = Client(ETLC)
    text = client.open(DOCK)

    def line(words, offset=0):
        found = text.ask("definition", words, offset)
        return None if found is None else found["range"]["start"]["line"]

    assert line("limit;") == 2 and line("z, bay") == 4 and line("at_bay;") == 8
    assert line("patience]") == 3 and line("carrying ->") == 10 and line("min cosine") is None
    assert len(text.ask("references", "at_bay =", context={"includeDeclaration": True})) == 3
    assert len(text.ask("references", "at_bay =", context={"includeDeclaration": False})) == 2
    kinds = [h["kind"] for h in text.ask("documentHighlight", "at_bay;")]
    assert sorted(kinds) == [2, 2, 3]
    # Also for and in a declaration that cannot be read.
    text.replace(DOCK.replace("closed && !at_bay;", "closed && && !at_bay;"))
    assert line("carrying ->") == 10 and line("at_bay;\nmonitor") == 8
    symbols = client.ask("textDocument/documentSymbol", {"textDocument": {"uri": text.uri}})
    assert [s["name"] for s in symbols] == [
        "dock", "limit", "patience", "z", "grip", "stop", "bay", "at_bay", "closed", "carrying",
        "arrive", "steady"]
    assert client.end() == 0
    client = Client(ETLC, {"textDocument": {"documentSymbol": {
        "hierarchicalDocumentSymbolSupport": True}}})
    text = client.open(DOCK)
    first = client.ask("textDocument/documentSymbol", {"textDocument": {"uri": text.uri}})[0]
    assert first["range"]["start"]["character"] == 0 and first["detail"] == "spec"
    assert first["selectionRange"]["start"]["character"] == 5
    assert client.end() == 0


def renames():
    client = Client(ETLC)
    text = client.open(DOCK)

    def renamed(words, name):
        edit = text.ask("rename", words, newName=name)
        return applied(text.text, edit["changes"][text.uri])

    assert text.ask("prepareRename", "at_bay;")["placeholder"] == "at_bay"
    assert renamed("at_bay;", "near") == DOCK.replace("at_bay", "near")
    assert renamed("limit;", "most") == DOCK.replace("limit", "most")
    assert renamed("patience]", "wait") == DOCK.replace("patience", "wait")
    assert renamed("dock", "harbour") == DOCK.replace("spec dock", "spec harbour")
    # Rename refuses an existing name.
    assert renamed("dock", "bay") == DOCK.replace("spec dock", "spec bay")
    # A contextual word is a name where names are allowed.
    assert renamed("grip :", "hold") == DOCK.replace("grip", "hold")
    for words, name, why in [
            ("at_bay;", "closed", "declared already, on line 10"),
            ("at_bay;", "monitor", "not a name"), ("at_bay;", "G", "not a name"),
            ("at_bay;", "2x", "not a name"), ("at_bay;", "a b", "not a name"),
            ("at_bay;", "", "not a name"), ("at_bay;", "a//b", "not a name"),
            ("at_bay;", "int", "C++ keyword"), ("at_bay;", "a__b", "underscore"),
            ("dock", "signal", "C library")]:
        error = text.error("rename", words, newName=name)
        assert error["code"] == -32803 and why in error["message"], error
    assert "no name" in text.error("prepareRename", "min cosine")["message"]
    assert "no name" in text.error("prepareRename", "predicate")["message"]
    # Contextual words are names wherever they cannot be keywords.
    text.replace("spec a;\ninput p, q : bool;\nmonitor m = rise p && q;\n"
                 "monitor n = G (p && rise (q));\n")
    client.ask("textDocument/documentSymbol", {"textDocument": {"uri": text.uri}})
    assert renamed("p,", "rise") == ("spec a;\ninput rise, q : bool;\nmonitor m = rise rise && q;\n"
                                     "monitor n = G (rise && rise (q));\n")
    assert renamed("q :", "fall") == text.text.replace("q", "fall")
    # In a declaration that cannot be read, the role of a word is unknown.
    text.replace("spec a;\ninput p, q : bool;\nlet x = p p;\nmonitor n = G (p && q);\n")
    assert "cannot be read" in text.error("rename", "p,", newName="r")["message"]
    assert renamed("q :", "r") == text.text.replace("q", "r")
    assert client.end() == 0


def completions():
    client = Client(ETLC)
    text = client.open(DOCK)

    def labels(line):
        """Returns the completions at the mark | of a line after the spec."""
        text.replace(DOCK + line.replace("|", ""))
        position = {"line": DOCK.count("\n"), "character": line.index("|")}
        items = client.ask("textDocument/completion", text.params(position))["items"]
        return [item["label"] for item in items]

    start = labels("|")
    assert "monitor" in start and "predicate" in start and "at_bay" not in start
    assert labels("mon|") == start  # the client filters
    operands = labels("let l = |")
    for word in ["at_bay", "closed", "carrying", "stop", "grip", "limit", "F", "always", "!",
                 "min", "cosine", "true", "rise", "held"]:
        assert word in operands, (word, operands)
    for word in ["z", "bay", "patience", "arrive", "monitor", "up", "Hz", "iff"]:
        assert word not in operands, (word, operands)
    operators = labels("let l = at_bay |")
    assert "&&" in operators and "until" in operators and "->" in operators
    assert "at_bay" not in operators and "!" not in operators
    assert labels("predicate p = min |")[:7] == [
        "l2", "l2sq", "l1", "linf", "cosine", "angular", "mahalanobis"]
    assert labels("predicate p = min l2(|") == ["z"]
    assert set(labels("predicate p = min l2(z, |")) == {"bay", "z"}  # a target, or another point
    assert set(labels("predicate p = l2([|")) == {"grip", "z"}
    numbers = labels("predicate p = grip <= |")
    assert "limit" in numbers and "calibrated" in numbers and "at_bay" not in numbers
    assert labels("predicate p = grip <= calibrated(|")[0] == "conformal"
    assert labels("predicate p = grip <= calibrated(conformal, |")[0] == "alpha"
    assert "medoids" in labels("target t = fitted(|")
    arguments = labels("target t = fitted(medoids, |")
    assert {"k", "away", "of", "where"} <= set(arguments), arguments
    assert labels("target t = fitted(medoids, of = |") == ["z"]
    assert labels("truth |") == ["at_bay", "closed"]
    assert labels("input i : |") == ["f32", "f16", "i8", "bool"]
    assert "hold" in labels("input i : f32[2] |") and "in" in labels("input i : f32[2] |")
    assert labels("rate 10 |") == ["Hz"]
    # Durations that are whole numbers of steps of 50 ms.
    bounds = labels("monitor n = G[0, |")
    assert "100 ms" in bounds and "1 s" in bounds and "20 ms" not in bounds, bounds
    assert "inf" in bounds and "patience" in bounds and "limit" in bounds
    units = labels("monitor n = G[0, 0.12|")
    assert "0.1 s" in units and "0.15 s" in units and "0.12 min" in units, units
    assert "0.12 s" not in units
    # No completions in comments and strings, or after text that cannot be read.
    for line in ["// |", "let l = /* |", 'target t = load("|', "let l = a b c |", "let l = 1 |= 2"]:
        assert "at_bay" not in labels(line), line
    assert client.end() == 0


def actions():
    client = Client(ETLC)
    text = client.open("")

    def mended(spec, title):
        text.replace(spec)
        whole = {"start": {"line": 0, "character": 0}, "end": {"line": 1000, "character": 0}}
        found = client.ask("textDocument/codeAction", {
            "textDocument": {"uri": text.uri}, "range": whole, "context": {"diagnostics": []}})
        assert title in [a["title"] for a in found], found
        action = next(a for a in found if a["title"] == title)
        return applied(spec, action["edit"]["changes"][text.uri])

    good = DOCK.replace("min cosine", "min l2")
    for wrong, right, title in [
            ("F at_bay", "F at_bay", None),
            ("F at_bai", "F at_bay", "Change 'at_bai' to 'at_bay'"),
            ("monitr arrive", "monitor arrive", "Change 'monitr' to 'monitor'"),
            ("closed & !", "closed && !", "Change '&' to '&&'"),
            ("20 hz", "20 Hz", "Change 'hz' to 'Hz'")]:
        if title is not None:
            assert mended(good.replace(right, wrong), title) == good, title
    assert mended(good.replace("hold 3 steps;", "hold 3 steps"), "Insert ';'") == good
    assert mended(good.replace("min l2", "min l22"), "Change 'l22' to 'l2'") == good
    # A name that C++ does not allow, everywhere.
    assert mended(good.replace("closed", "int"), "Change 'int' to 'int_predicate'") == \
        good.replace("closed", "int_predicate")
    assert client.end() == 0


def row_of(columns):
    """A .npy file of one row of zeros."""
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': (1, {columns}), }}"
    header = header.ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", 118) + header.encode() + bytes(4 * columns)


def files():
    """Errors in loaded files appear where the spec names the files."""
    client = Client(ETLC, {"textDocument": {"publishDiagnostics": {"relatedInformation": True}}})
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "a spec.etl")
        spec = ('spec a;\ninput z : f32[2];\ntarget t = load("t.npy");\ninput y : f32;\n'
                'predicate p = y <= calibrated(conformal, alpha = 0.1);\n'
                'monitor m = G (p && min l2(z, t) < 1);\n')
        text = client.open(spec, path.as_uri())
        found = client.diagnostics()
        # A missing file is information.
        places = [(d["severity"], d["range"]["start"]["line"]) for d in found]
        assert places == [(3, 2), (3, 4)], found
        assert text.ask("definition", '"t.npy"', 2) is None
        hover = text.ask("hover", "p =")["contents"]["value"]
        assert "not there yet" in hover, hover
        pathlib.Path(folder, "t.npy").write_bytes(b"no array")
        pathlib.Path(folder, "a spec.thresholds.json").write_text("{\n  oh")
        client.tell("workspace/didChangeWatchedFiles", {"changes": []})
        found = client.diagnostics()
        places = [(d["severity"], d["range"]["start"]["line"]) for d in found]
        assert places == [(1, 2), (1, 4)], found
        assert found[0]["message"].startswith("t.npy: ")
        assert found[1]["message"].startswith("a spec.thresholds.json:2:")
        place = found[1]["relatedInformation"][0]["location"]
        assert place["uri"].endswith("/a%20spec.thresholds.json"), place
        assert place["range"]["start"]["line"] == 1
        there = text.ask("definition", '"t.npy"', 2)
        assert there["uri"] == pathlib.Path(folder, "t.npy").as_uri()
        # The contents of a file are cached while the file is the same.
        pathlib.Path(folder, "a spec.thresholds.json").unlink()
        for columns, codes in [(2, ["E0650"]), (3, ["E0650", "E0307"]), (2, ["E0650"])]:
            pathlib.Path(folder, "t.npy").write_bytes(row_of(columns))
            client.tell("workspace/didChangeWatchedFiles", {"changes": []})
            for edit in " ", "":
                found = client.diagnostics()
                assert [d["code"] for d in found] == codes, (columns, found)
                text.change([{"text": spec + edit}])
            client.diagnostics()
        os.remove(pathlib.Path(folder, "t.npy"))
        client.tell("textDocument/didSave", {"textDocument": {"uri": text.uri}})
        assert [d["severity"] for d in client.diagnostics()] == [3, 3]
    # A text that was never saved.
    client.open('spec a;\ntarget t = load("t.npy");\nmonitor m = true;\n', "untitled:Untitled-1")
    assert any("t.npy" in d["message"] for d in client.diagnostics())
    assert client.end() == 0


same_as_check()
hovers()
words()
thresholds()
places()
renames()
completions()
actions()
files()
print("all answers are right")
