#!/usr/bin/env python3
"""parquet_test.py ETLC: etlc-read-parquet returns the cells that were written, in every supported
form; it names unsupported and damaged parts."""
import itertools
import math
import os
import random
import struct
import subprocess
import sys
import tempfile

import numpy as np

import parquet_writer as parquet

READER = os.path.join(os.path.dirname(os.path.abspath(sys.argv[1])), "etlc-read-parquet")
ROWS = 257
NULL = 0xFFFFFFFF


def records(path, *words):
    done = subprocess.run([READER, "read", path, *words], capture_output=True)
    found, at = [], 0
    while at < len(done.stdout):
        tag, size = struct.unpack_from("<cI", done.stdout, at)
        found.append((tag, done.stdout[at + 5:at + 5 + size]))
        at += 5 + size
    return found


def refusal(path, *names):
    tag, text = records(path, "", "0", *names)[-1]
    assert tag == b"F", (tag, names)
    return text[1:].decode()


def read(path, names, key="", value=0):
    found = records(path, key, str(value), *names)
    assert found[0][0] == b"S" and found[-1][0] == b"E", found[-1]
    shapes = found[0][1].decode().splitlines()
    data, at, rows = b"".join(body for tag, body in found if tag == b"R"), 0, []
    while at < len(data):
        row = []
        for shape in shapes:
            if shape == "absent":
                continue
            count = struct.unpack_from("<I", data, at)[0]
            at += 4
            if count == NULL:
                row.append(None)
                continue
            cell = []
            for _ in range(count):
                if shape.startswith("text"):
                    size = struct.unpack_from("<I", data, at)[0]
                    cell.append(data[at + 4:at + 4 + size].decode(errors="surrogateescape"))
                    at += 4 + size
                else:
                    cell.append(struct.unpack_from("<d", data, at)[0])
                    at += 8
            row.append(cell if shape.endswith("list") else cell[0])
        rows.append(row)
    return shapes, rows


def columns():
    real = [float(np.float32(random.random())) for _ in range(ROWS)]
    return {
        "t": (parquet.TEXT, [f"task {i % 3}" if i % 11 else None for i in range(ROWS)]),
        "f": (parquet.FLOAT, [random.choice(real[:20]) for _ in range(ROWS)]),
        "d": (parquet.DOUBLE, [random.random() if i % 7 else None for i in range(ROWS)]),
        "i": (parquet.INT64, [i // 9 for i in range(ROWS)]),
        "k": (parquet.INT32, [-i for i in range(ROWS)]),
        "b": (parquet.BOOL, [i % 5 < 2 for i in range(ROWS)]),
        "l": (parquet.FLOAT, [random.sample(real, 6) for _ in range(ROWS)]),
        "v": (parquet.FLOAT, [None if i % 13 == 0 else [None if j == 2 else float(j)
                                                        for j in range(i % 5)]
                              for i in range(ROWS)]),
        "s": (parquet.TEXT, [[f"x{j}" for j in range(i % 3)] for i in range(ROWS)])}


def same(a, b):
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    return a == b or (a is None and isinstance(b, float) and math.isnan(b))


def forms_are_read():
    for codec, dictionary, version, page, group in itertools.product(
            (parquet.NONE, parquet.SNAPPY, parquet.ZSTD), (False, True), (1, 2), (1000, 50),
            (10**6, 100)):
        made = columns()
        parquet.write("t.parquet", made, codec=codec, dictionary=dictionary, version=version,
                      page_rows=page, group_rows=group, checksums=codec != parquet.NONE)
        shapes, rows = read("t.parquet", [*made, "absent"])
        assert shapes == ["text", "number", "number", "number", "number", "bool", "number list",
                          "number list", "text list", "absent"], shapes
        assert len(rows) == ROWS
        for place, (name, (_, values)) in enumerate(made.items()):
            found = [row[place] for row in rows]
            for wanted, cell in zip(values, found):
                assert (cell is None) == (wanted is None) and same(wanted, cell), \
                    (codec, dictionary, version, page, group, name, wanted, cell)
        _, some = read("t.parquet", ["i", "k"], "i", 7)
        assert some == [[7, -i] for i in range(63, 72)], some
        some_rows_are_read(made)


def some_rows_are_read(made):
    """Reads the rows of one key; others are skipped, in pages or row by row."""
    for key in range(ROWS // 9 + 1):
        _, some = read("t.parquet", ["l", "v", "s", "t"], "i", key)
        wanted = [i for i, value in enumerate(made["i"][1]) if value == key]
        assert len(some) == len(wanted)
        for row, i in zip(some, wanted):
            for cell, name in zip(row, ("l", "v", "s", "t")):
                value = made[name][1][i]
                assert (cell is None) == (value is None) and same(value, cell), (key, name, i)


def pages_of_nulls_are_read():
    """Some writers compress no bytes and write no dictionary for empty columns."""
    for codec, dictionary, version, bare in itertools.product(
            (parquet.NONE, parquet.SNAPPY, parquet.ZSTD), (False, True), (1, 2), (False, True)):
        made = {name: (kind, [None if row // 20 % 2 else value for row, value in enumerate(values)])
                for name, (kind, values) in columns().items()}
        made |= {f"no {name}": (kind, [None] * ROWS) for name, (kind, _) in made.items()}
        parquet.write("t.parquet", made, codec=codec, dictionary=dictionary, version=version,
                      page_rows=20, bare=bare)
        rows = read("t.parquet", list(made))[1]
        for place, (name, (_, values)) in enumerate(made.items()):
            for wanted, row in zip(values, rows, strict=True):
                assert (row[place] is None) == (wanted is None) and same(wanted, row[place]), \
                    (codec, dictionary, version, bare, name, wanted, row[place])


def rows_may_span_pages():
    for page in (1, 5, 64):
        made = columns()
        parquet.write("t.parquet", made, page_rows=page, cut_anywhere=True)
        _, rows = read("t.parquet", ["l", "v"])
        assert all(same(a, row[0]) and (b is None) == (row[1] is None) and same(b, row[1])
                   for a, b, row in zip(made["l"][1], made["v"][1], rows))
        some_rows_are_read(made)


def image_rows(optional, needed):
    """Rows of bytes that are not text, of any length, some equal; nulls where allowed."""
    rows = []
    for i in range(ROWS):
        row = {"bytes": bytes([0xFF, i % 40]) * (i % 40), "path": f"frame {i % 5}.png", "n": i / 4}
        for place, field in enumerate(row):
            if field not in needed and i % (7 + place) == 0:
                row[field] = None
        rows.append(None if optional and i % 11 == 0 else row)
    return rows


def structs_are_read():
    """A field by its path, with nulls at every level; names may contain dots."""
    fields = {"bytes": parquet.TEXT, "path": parquet.TEXT, "n": parquet.DOUBLE}
    for optional, needed, dictionary, version, codec, pages in itertools.product(
            (False, True), ((), ("bytes",), ("bytes", "path", "n")), (False, True), (1, 2),
            (parquet.NONE, parquet.ZSTD), ({}, {"page_rows": 20, "group_rows": 90})):
        rows = image_rows(optional, needed)
        kind = parquet.Struct(fields, optional, needed)
        made = {"before": (parquet.FLOAT, [[0.5] * (i % 3) for i in range(ROWS)]),
                "camera.top": (kind, rows), "key": (parquet.INT64, [i // 9 for i in range(ROWS)])}
        parquet.write("t.parquet", made, dictionary=dictionary, version=version, codec=codec,
                      **pages)
        names = ["camera.top.n", "key", "camera.top.bytes", "camera.top.path", "camera.bytes"]
        wanted = [[None if row is None else row["n"], i // 9,
                   None if row is None or row["bytes"] is None else
                   row["bytes"].decode(errors="surrogateescape"),
                   None if row is None else row["path"]] for i, row in enumerate(rows)]
        shapes, found = read("t.parquet", names)
        assert shapes == ["number", "number", "text", "text", "absent"], shapes
        assert found == wanted, (optional, needed, dictionary, version, codec, pages)
        assert read("t.parquet", names, "key", 11)[1] == wanted[99:108], (optional, needed, pages)


def lists_of_structs_are_read():
    """A field by its path, a list a row, with nulls at every level; nested lists are not read."""
    fields = {"style": parquet.TEXT, "time": parquet.DOUBLE, "camera": parquet.NULL,
              "tools": parquet.TEXTS}
    rows = [None if i % 11 == 0 else
            [None if (i + j) % 5 == 4 else
             {"style": None if j == 2 else f"s{j}", "time": None if j == 1 else i + j / 8,
              "camera": None, "tools": None} for j in range(i % 4)] for i in range(ROWS)]

    def found(row, field):
        return row if not row else [None if item is None else item[field] for item in row]

    for element, dictionary, version, pages in itertools.product(
            ("element", "item"), (False, True), (1, 2),
            ({}, {"page_rows": 20, "group_rows": 90}, {"page_rows": 7, "cut_anywhere": True})):
        made = {"a": (parquet.Structs(fields, element), rows),
                "key": (parquet.INT64, [i // 9 for i in range(ROWS)])}
        parquet.write("t.parquet", made, dictionary=dictionary, version=version, **pages)
        names = ["a.time", "key", "a.style", "a.camera", "a.list"]
        shapes, cells = read("t.parquet", names)
        assert shapes == ["number list", "number", "text list", "number list", "absent"], shapes
        wanted = [[found(row, "time"), i // 9,
                   row and [style or "" for style in found(row, "style")], found(row, "camera")]
                  for i, row in enumerate(rows)]
        for one, cell in zip(wanted, cells, strict=True):
            assert [x is None for x in one] == [x is None for x in cell], (one, cell)
            assert all(x is None or same(x, y) for x, y in zip(one, cell)), (one, cell)
        some = read("t.parquet", names, "key", 11)[1]
        assert all(same(x, y) or x is None for one, cell in zip(wanted[99:108], some, strict=True)
                   for x, y in zip(one, cell))
        assert refusal("t.parquet", "a.tools") == (
            "column 'a.tools' has lists or fields nested in it, expected a number or a text")
        assert refusal("t.parquet", "a") == ("column 'a' has 4 fields nested in it, expected a "
                                             "number, a text or a list of them")


def structs_that_are_not_read_are_named():
    fields = {"bytes": parquet.TEXT, "path": parquet.TEXT}
    rows = [{"bytes": b"\xff", "path": "a"}]
    words = "has lists or fields nested in it, expected a number or a text"
    parquet.write("t.parquet", {"a.b": (parquet.Struct(fields), rows)}, nested=("a.b",))
    assert refusal("t.parquet", "a.b.bytes") == f"column 'a.b.bytes' {words}"
    parquet.write("t.parquet", {"a": (parquet.Struct(fields, repeated=("path",)), rows)})
    assert refusal("t.parquet", "a.path") == f"column 'a.path' {words}"
    assert read("t.parquet", ["a.bytes"])[1] == [["\udcff"]]
    assert refusal("t.parquet", "a") == ("column 'a' has 2 fields nested in it, expected a number, "
                                         "a text or a list of them")
    parquet.write("t.parquet", {"a": (parquet.Struct(fields), rows),
                                "a.path": (parquet.INT64, [1])})
    assert "has two columns 'a.path'" in refusal("t.parquet", "a.path")


def images_may_be_large():
    """At most 16 MB; a record is full if the next row does not fit."""
    small, large, huge = b"s" * 200_000, b"l" * 16_000_000, b"h" * 16_000_001
    kind = parquet.Struct({"bytes": parquet.TEXT, "path": parquet.TEXT})
    for dictionary in (False, True):
        def write(*images):
            rows = [{"bytes": image, "path": "p" * 1000} for image in images]
            parquet.write("t.parquet", {"a": (kind, rows)}, dictionary=dictionary)
        write(small, large, small, large, large)
        lengths = [len(row[0]) for row in read("t.parquet", ["a.bytes", "a.path"])[1]]
        assert lengths == [200_000, 16_000_000, 200_000, 16_000_000, 16_000_000], lengths
        write(small, huge)
        assert refusal("t.parquet", "a.bytes") == (
            "column 'a.bytes' has a value of 16000001 bytes, at most 16000000 are read")
    parquet.write("t.parquet", {"t": (parquet.TEXT, [["x" * 9_000_000] * 2])})
    assert refusal("t.parquet", "t") == "has a row of more bytes than are read"


def signs_are_kept():
    column = {"a": (parquet.INT32, [-1, 5]), "b": (parquet.INT32, [-1, 5]),
              "c": (parquet.INT64, [-1, 5])}
    parquet.write("t.parquet", column, unsigned=("b", "c"))
    assert read("t.parquet", ["a", "b", "c"])[1] == [[-1, 2**32 - 1, 2.0**64], [5, 5, 5]]


def others_are_named():
    column = {"q": (parquet.FLOAT, [float(i % 4) for i in range(100)]),
              "l": (parquet.FLOAT, [[1.0, 2.0]] * 100)}
    for words, how in (
            ("column 'q' is packed by GZIP, expected UNCOMPRESSED, SNAPPY or ZSTD",
             {"codec": parquet.NONE, "codec_said": parquet.GZIP}),
            ("column 'q' is encoded as DELTA_BINARY_PACKED, expected PLAIN, RLE or a dictionary",
             {"encoding": parquet.DELTA}),
            ("place 3 in a dictionary of 3", {"dictionary": True, "bad_place": True}),
            ("fewer rows than its row group", {"claims": 40}),
            ("column 'q' ends in the", {"claims": 2**31 - 1})):
        made = dict(column)
        if "bad_place" in how:
            made["q"] = (parquet.FLOAT, [float(i % 3) for i in range(100)])
        parquet.write("t.parquet", made, **how)
        assert words in refusal("t.parquet", "q"), (words, refusal("t.parquet", "q"))
    parquet.write("t.parquet", column, nested=("l",))
    assert refusal("t.parquet", "l") == ("column 'l' has lists nested in lists, expected a number, "
                                         "a text or a list of them")
    assert read("t.parquet", ["q"])[1][5] == [1.0], "other columns are read"


def damage_is_named():
    whole = parquet.Writer(checksums=True).write({"q": (parquet.FLOAT, [0.5] * 100)})
    claim = whole[:-8] + struct.pack("<I", 2**31) + b"PAR1"
    turned = bytearray(whole)
    turned[60] ^= 1
    for bytes_, words in ((b"", "is empty"), (b"version 1", "does not begin with PAR1"),
                          (whole[:-3], "is cut"), (whole[:20], "is cut"),
                          (b"PARE" + whole[4:], "is encrypted"),
                          (whole[:-4] + b"PARE", "is encrypted"),
                          (claim, "has a footer of 2147483648 bytes"),
                          (bytes(turned), "checksum")):
        with open("t.parquet", "wb") as file:
            file.write(bytes_)
        assert words in refusal("t.parquet", "q"), (words, refusal("t.parquet", "q"))
    entries = [[{"style": f"s{j}", "time": j / 8} for j in range(i % 4)] for i in range(100)]
    kind = parquet.Structs({"style": parquet.TEXT, "time": parquet.DOUBLE})
    structs = parquet.Writer(codec=parquet.NONE).write({"q": (kind, entries)})
    for i in range(500):  # any other damage is reported too
        broken = bytearray(structs if i % 5 > 2 else whole)
        for _ in range(random.randrange(1, 4)):
            broken[random.randrange(len(broken))] = random.randrange(256)
        with open("t.parquet", "wb") as file:
            file.write(broken)
        names = ["q.style", "q.time"] if i % 5 > 2 else ["q"]
        assert records("t.parquet", "", "0", *names)[-1][0] in (b"E", b"F")


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    random.seed(3)
    forms_are_read()
    pages_of_nulls_are_read()
    rows_may_span_pages()
    structs_are_read()
    lists_of_structs_are_read()
    structs_that_are_not_read_are_named()
    images_may_be_large()
    signs_are_kept()
    others_are_named()
    damage_is_named()
    os.chdir("/")
