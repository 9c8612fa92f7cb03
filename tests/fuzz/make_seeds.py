#!/usr/bin/env python3
"""Writes the seeds of the data targets and of fuzz_compile under corpus/, from the files of
tests/unit/data and from here."""
import pathlib
import random
import struct
import sys
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ARRAYS = HERE.parent / "unit" / "data"


def seed(target, name, content):
    folder = HERE / "corpus" / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content)


def npy(descr, shape, data, fortran=False):
    header = f"{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}".encode()
    header += b" " * (-(10 + len(header) + 1) % 16) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + data


for path in sorted(ARRAYS.glob("*.npy")):
    seed("fuzz_npy", path.name, path.read_bytes())
for name in ("stored.npz", "single.npz", "bzip2.npz"):
    seed("fuzz_npz", name, (ARRAYS / name).read_bytes())

MEMBERS = {
    "z.npy": npy("<f4", "(2, 2)", struct.pack("<4f", 1, 2, 3, 4)),
    "g.npy": npy("<f2", "(2,)", struct.pack("<2e", 0.5, 1)),
    "b.npy": npy("|b1", "(2, 1)", b"\x00\x01"),
}
TURNED = dict(MEMBERS, **{"z.npy": npy("<f8", "(2, 2)", struct.pack("<4d", 1, 2, 3, 4), True)})
for name, compression, members in (
    ("trace_stored.npz", zipfile.ZIP_STORED, MEMBERS),
    ("trace_deflated.npz", zipfile.ZIP_DEFLATED, MEMBERS),
    ("trace_turned.npz", zipfile.ZIP_STORED, TURNED),
):
    path = HERE / "corpus" / "fuzz_npz" / name
    with zipfile.ZipFile(path, "w", compression) as archive:
        for key, data in members.items():
            archive.writestr(zipfile.ZipInfo(key, (1980, 1, 1, 0, 0, 0)), data, compression)

for name, text in {
    "plain.csv": "z[0],z[1],g,b\n1,2,0.5,1\n-3e-4,.25,1e300,0\n",
    "crlf.csv": "\ufeffz[0],z[1],g,b\r\n1,2,0.5,1\r\n",
    "missing.csv": "t,b,g,z[1],z[0]\n0,,,1,\n1,nan,inf,-Infinity,NaN\n",
    "quoted.csv": '"z[0]",z[1],g,b,"a ""note"""\n"1",2,3,0,"two\nlines, and a comma"\n',
    "ragged.csv": "z[0],z[1],g,b\n1,2,0.5\n",
    "words.csv": "z[0],z[1],g,b\n1,two,0.5,1\n",
    "range.csv": "z[0],z[1],g,b\n1e999,1e-999,0,1\n",
}.items():
    seed("fuzz_csv", name, text.encode())

for name, text in {
    "steps.csv": "episode,start,end,predicate\nep1,3,9,docked\nep1,12,,?docked\nep2,,,!docked\n",
    "seconds.csv": "predicate,episode,start_s,end_s,group\n"
                   'docked,"pick:3",0.5,1.25,monday\n,pick:4,,,tuesday\n',
    "whole.csv": "episode,predicate\nruns/ep1.npz,docked\n",
    "empty_interval.csv": "episode,predicate,start,end\na,p,5,5\n",
}.items():
    seed("fuzz_labels", name, text.encode())

def incident(words, row_bytes, rows, alarm, size):
    """The head of an incident, and `size` bytes of rows; the target makes the checksum."""
    length = 96 + size + 8
    return (b"\x89ETLINC\n" + struct.pack("<II4Q12I", 1, length, 1, 2, 3, 4, words, row_bytes, 4, 0,
                                            0, 0, 0, rows, alarm, 0, 0, 0)
            + bytes(range(size)) + bytes(8))

for name, data in {
    "whole": incident(3, 2, 3, 2, 64),  # rows of 16 bytes, and what fills 32
    "long": incident(3, 2, 1000, 2, 64),
    "wide": incident(0xffffffff, 0xffffffff, 1, 0, 32),
    "late": incident(3, 2, 3, 3, 64),
    "empty": incident(1, 1, 0, 0, 0),
}.items():
    seed("fuzz_incident", name, data)

# Exclusive-or'ed with the right parameters: 320 bytes behind a byte that says where they lie (64:
# with a checksum that fits).
def params(place, size=320, **changed):
    data = bytearray(size)
    for at, value in changed.items():
        data[int(at[1:])] = value
    return bytes([place]) + bytes(data)

for name, data in {
    "right": params(0),
    "sealed": params(64),
    "misaligned": params(4),
    "truncated": params(0, 256),
    "longer": params(0, 384),
    "one_bit": params(0, _130=1),
    "other_shape": params(64, _16=1),
    "other_encoder": params(64, _24=1),
    "threshold": params(64, _67=0x80),  # -0.25
    "nan": params(64, _70=0x40, _71=0xc0),  # 0xbfc00000 becomes 0x7f800000: infinite
    "zero_row": params(64, _130=0x19, _131=0x3f, _128=0x9a, _129=0x99),
    "asymmetric": params(64, _196=1),
    "padding": params(64, _80=1),
}.items():
    seed("fuzz_params", name, data)

ENTRY = """"method": "conformal", "alpha": 0.10, "epsilon": 0.31, "n": 2, "k": 1, \
"scores": [0.1, "inf"],
 "reads": {"predicate p": "min l2(z, goal) <=", \
"target goal": "1 x 1, values #0123456789abcdef"}"""
for name, text in {
    "whole.json": f"""{{"format": 3, "spec": "s", "predicates": {{"p": {{{ENTRY}}}}}, \
"monitors": {{}},
 "episodes": ["0123456789abcdef"], "etlc": "0.1.0"}}""",
    "monitor.json": f"""{{"format": 3, "spec": "s", "predicates": {{}}, "monitors": {{"m": \
{{{ENTRY}, "against": "missed_alarm", "episodes": []}}}},
 "episodes": [], "etlc": "0.1.0"}}""",
    "f1.json": """{"format": 3, "spec": "s", "predicates": {"p": {"method": "f1", \
"epsilon": -0.0, "n": 1, "k": 0,
 "scores": [], "reads": {"truth p": "g > 0.5"}}}, "monitors": {}, \
"episodes": [], "etlc": "0.1.0"}""",
    "consistent.json": """{"format": 3, "spec": "s", "predicates": {"p": {"method": "conformal", \
"alpha": 0.5, "epsilon": 1, "n": 2,
 "k": 2, "scores": [0.5, 0.99999998], "reads": {"truth p": "g > 0.5"}}}, \
"monitors": {},
 "episodes": ["0000000000000001", "0000000000000002"], "etlc": "0.1.0"}""",
    "recordings.json": """{"format": 3, "spec": "s", "predicates": {}, "monitors": {},
 "episodes": ["0000000000000001"],
 "recordings": {"0000000000000001": {"g": "00112233445566aa:", \
"z": "0123456789abcdef:0000000a00ff00ff"}},
 "allowances": [{"reason": "few \\"places\\"", "overlapping": 2, "leaked": 0}], "etlc": "0.1.0"}""",
    "format2.json": '{"format": 2}',
    "nested.json": "[" * 40,
    "escapes.json":
        '{"format": 3, "spec": "\\u00fc\\ud83d\\ude00\\n", "predicates": {}, "monitors": {}, '
        '"episodes": [], "etlc": ""}',
}.items():
    seed("fuzz_thresholds", name, text.encode())

def frame(rows, columns, pixels):
    return struct.pack("<II", rows, columns) + pixels

def field(number, content):
    """Encodes a field of a protocol buffer: bytes, or a number."""
    if isinstance(content, int):
        return bytes([number << 3, content])
    return bytes([number << 3 | 2, len(content)]) + content

def value(name, shape):
    sizes = b"".join(field(1, field(1, n)) for n in shape)
    return field(1, name) + field(2, field(1, field(1, 1) + field(2, sizes)))

NODE = field(1, b"x") + field(1, b"w") + field(2, b"y") + field(3, b"n") + field(4, b"Mul")
CONSTANT = field(2, b"c") + field(4, b"Constant") + field(5, field(5, field(1, b"\x02\x03")))
MODEL = field(7, field(1, NODE) + field(1, CONSTANT) + field(5, field(1, 2) + field(8, b"w"))
              + field(11, value(b"x", (1, 3, 2, 2))) + field(12, value(b"y", (1, 4))))
ROWS = struct.pack("<6f", 1, 2, 3, 4, 5, 6)
for name, status, data in (
    ("frames", 0, frame(1, 2, b"rgbrgb") + frame(2, 1, b"rgbrgb")),
    ("refused", 65, frame(1, 1, b"rgb") + b"is cut"),
    ("out_of_step", 66, b"has 25 frames a second"),
    ("no_such_frame", 67, b""),
    ("dies", 139, frame(1, 1, b"r")),
    ("large", 0, frame(1 << 14, 1 << 14, b"")),
    ("embeddings", 0, struct.pack("<I", 2) + ROWS),
    ("too_many", 0, struct.pack("<I", 1) + ROWS),
    ("too_few", 0, struct.pack("<I", 3) + ROWS),
    ("not_finite", 0, struct.pack("<I", 2) + ROWS[:-4] + struct.pack("<f", float("nan"))),
    ("no_dimension", 0, struct.pack("<I", 0) + ROWS),
    ("wide", 0, struct.pack("<I", 1 << 21) + ROWS),
):
    seed("fuzz_worker", name, bytes([status]) + data)
seed("fuzz_worker", "marks",
     b'{"format": 1, "inputs": {"z": "0123456789abcdef", "y": "00112233445566aa"}}')
seed("fuzz_worker", "model", MODEL)

# For fuzz_compile: specs that are long as trees or large as state machines, and bytes that choose
# deep ones.
HEAD = "spec s;\ninput x : f32 in [-1, 1];\npredicate p = x > 0;\npredicate q = x < 0.5;\n"
for name, text in {
    "shared_since.etl": "let a0 = p;\n"
    + "".join(f"let a{i + 1} = a{i} S !a{i};\n" for i in range(40))
    + "sliding monitor m = a40;\n",
    "iff_chain.etl": "monitor m = " + " <-> ".join(f"x > {i}" for i in range(100)) + ";\n",
    "nested_refusals.etl": "let a0 = p;\n"
    + "".join(f"let a{i + 1} = F a{i} && !(G a{i});\n" for i in range(40))
    + "monitor m = a40;\n",
    "long_windows.etl": "monitor m = G F[1000, 100000] (p U q);\n",
    "earlier.etl": "rate 10 Hz;\ninput z : f16[3] hold 1 step;\ninput w : i8[3] scale 0.25;\n"
    "projection P = [[1, 0, 2], [0, 1, 0]] offset [1, 1, 0];\n"
    "target own = [[1, 2]] of P(z);\ntarget both = [[1, 0, 2, 1, 0, 2]];\n"
    "predicate still = l2(z, z@3s) <= 0.05;\n"
    "predicate apart = cosine(P(z@1s)@2, P(w)) > 0.2 missing false;\n"
    "predicate was = min l1([z, z@0.5s]@1, both) - min l2(P(z)@2 steps, own) <= 1;\n"
    "let calm = max(mean(x, 2 s), 20 steps)@1s - (x - x@3)@4 <= 1;\n"
    "repeating monitor m = F (still && apart U[0s, 1s] was);\n"
    "sliding monitor n = calm -> F[0s, 2s] l2([x, x@1], [x@2, x]) < 1;\n",
    "long_ago.etl": "input z : f32[1000];\nmonitor m = F (l2(z, z@16777216) < 1 && "
    "max(x@16777000, 200 steps)@16 < 1);\n",
}.items():
    seed("fuzz_compile", name, (HEAD + text).encode())
CHOICES = random.Random(15)
for n in range(12):
    seed("fuzz_compile", f"deep_{n}", CHOICES.randbytes(40 << (n // 2)))

# Parquet, as the tests of data sets write it.
sys.path.insert(0, str(HERE.parent / "datasets"))
import parquet_writer as parquet  # pylint: disable=wrong-import-position

COLUMNS = {
    "q": (parquet.FLOAT, [[0.5, None, 2.0], None, [], [1.0]] * 5),
    "k": (parquet.INT64, [i // 3 for i in range(20)]),
    "b": (parquet.BOOL, [i % 3 == 0 for i in range(20)]),
    "t": (parquet.TEXT, [None if i == 4 else f"t{i % 2}" for i in range(20)])}
for name, how in {
    "plain": {"codec": parquet.NONE, "page_rows": 8},
    "dictionary": {"codec": parquet.NONE, "dictionary": True, "group_rows": 9},
    "snappy": {"codec": parquet.SNAPPY},
    "zstd_v2": {"codec": parquet.ZSTD, "version": 2, "dictionary": True},
    "plain_v2": {"codec": parquet.NONE, "version": 2},
    "checksums": {"codec": parquet.NONE, "checksums": True},
    "gzip": {"codec": parquet.NONE, "codec_said": parquet.GZIP},
    "delta": {"codec": parquet.NONE, "encoding": parquet.DELTA},
    "claims": {"codec": parquet.NONE, "claims": 2**31 - 1},
}.items():
    seed("fuzz_parquet", f"{name}.parquet", parquet.Writer(**how).write(COLUMNS))
seed("fuzz_parquet", "nested.parquet",
     parquet.Writer(codec=parquet.NONE).write(COLUMNS, nested=("q",)))
IMAGES = parquet.Struct({"bytes": parquet.TEXT, "path": parquet.TEXT, "n": parquet.DOUBLE})
seed("fuzz_parquet", "struct.parquet", parquet.Writer(codec=parquet.NONE, page_rows=8).write({
    "k": COLUMNS["k"],
    "c.a": (IMAGES, [None if i == 3 else {"bytes": None if i == 5 else b"\xff" * i,
                                          "path": f"p{i}", "n": i / 2} for i in range(20)])}))
ENTRIES = parquet.Structs({"style": parquet.TEXT, "time": parquet.FLOAT, "camera": parquet.NULL,
                           "tools": parquet.TEXTS})
seed("fuzz_parquet", "structs.parquet", parquet.Writer(codec=parquet.NONE, page_rows=8).write({
    "k": COLUMNS["k"],
    "q": (ENTRIES, [None if i == 3 else [{"style": f"s{j}", "time": j / 2, "camera": None,
                                         "tools": None} for j in range(i % 4)]
                    for i in range(20)])}))
