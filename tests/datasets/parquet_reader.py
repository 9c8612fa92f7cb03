"""Reads flat columns of Parquet files by etlc-read-parquet: `read(program, path, names)` returns a
list of cells for each name, which are lists of numbers, or None where null."""
import struct
import subprocess

NULL = 0xFFFFFFFF


def records(program, *words):
    out = subprocess.run([program, *words], capture_output=True, check=True).stdout
    at = 0
    while at < len(out):
        size, = struct.unpack_from("<I", out, at + 1)
        yield out[at:at + 1], out[at + 5:at + 5 + size]
        at += 5 + size


def read(program, path, names):
    columns = [[] for _ in names]
    for tag, record in records(program, "read", path, "", "0", *names):
        assert tag in b"SRE", (tag, record)
        if tag == b"S":
            assert b"absent" not in record and b"text" not in record, record
        at, column = 0, 0
        while tag == b"R" and at < len(record):
            count, = struct.unpack_from("<I", record, at)
            at += 4
            cell = None if count == NULL else list(struct.unpack_from(f"<{count}d", record, at))
            at += 0 if cell is None else 8 * count
            columns[column].append(cell)
            column = (column + 1) % len(names)
    return columns
