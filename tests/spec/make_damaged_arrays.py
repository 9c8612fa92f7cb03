#!/usr/bin/env python3
"""Writes the damaged .npy and .npz files for the E04, E06 and E08 cases of error/. It needs only
Python."""
import pathlib
import struct
import zipfile

ERROR = pathlib.Path(__file__).resolve().parent / "error"
TWO = struct.pack("<2f", 1, 2)


def raw(dictionary, data=TWO, version=(1, 0)):
    header = dictionary.encode()
    header += b" " * (-(10 + len(header) + 1) % 64) + b"\n"
    return b"\x93NUMPY" + bytes(version) + struct.pack("<H", len(header)) + header + data


def npy(descr="<f4", shape="(1, 2)", data=TWO, fortran=False):
    return raw(f"{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}", data)


def zipped(members, method=zipfile.ZIP_STORED):
    """Like zipfile, but names may repeat, and the clock has no influence."""
    import io

    bytes_ = io.BytesIO()
    with zipfile.ZipFile(bytes_, "w") as archive:
        for name, data in members:
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), data, method)
    return bytes_.getvalue()


def write(name, content):
    (ERROR / name).write_bytes(content)


write("E0403_text.npy", b"1.0, 2.0\n")
write("E0403_version.npy", raw("{}", version=(9, 0)))
write("E0403_header.npy", raw("{'descr': '<f4', 'shape': (1, 2)}"))
write("E0404_cut_short.npy", npy(shape="(3, 2)"))
write("E0404_left_over.npy", npy(shape="(1, 1)"))
write("E0404_huge.npy", npy(shape="(100000000, 512)"))
write("E0404_disagrees.npz",
      zipped([("goal.npy", npy(shape="(100000000, 2)"))], zipfile.ZIP_DEFLATED))
write("E0405_big_endian.npy", npy(">f4"))
write("E0405_records.npy",
      raw("{'descr': [('x', '<f4'), ('y', '<f4')], 'fortran_order': False, 'shape': (1,)}"))
write("E0405_objects.npy", npy("|O"))
write("E0405_complex.npy", npy("<c8"))
write("E0406_overflow.npy", npy(shape="(4294967296, 4294967297)"))
whole = zipped([("goal.npy", npy())])
write("E0407_cut_short.npz", whole[:100])
write("E0407_checksum.npz", whole.replace(TWO, struct.pack("<2f", 1, 3)))
write("E0407_bzip2.npz", zipped([("goal.npy", npy())], zipfile.ZIP_BZIP2))
write("E0408_two.npz", zipped([("goal_a.npy", npy()), ("goal_b.npy", npy())]))
write("E0408_twice.npz",
      zipped([("goal_a.npy", npy()), ("goal_b.npy", npy())]).replace(b"goal_b", b"goal_a"))
write("E0409_plain.npy", npy())

STEPS = npy(shape="(2, 2)", data=struct.pack("<4f", 1, 2, 3, 4))
HALF = npy("<f4", "(2,)", struct.pack("<2f", 0.5, 1))
FLAGS = npy("|b1", "(2,)", b"\x00\x01")


def trace(name, **changed):
    members = dict({"z": STEPS, "grip": HALF, "held": FLAGS}, **changed)
    write(name, zipped([(key + ".npy", data) for key, data in members.items() if data is not None]))


trace("E0804_absent.npz", grip=None, gripp=HALF)
trace("E0806_cut_short.npz", z=STEPS[:-4])
trace("E0807_wide.npz", z=npy(shape="(2, 3)", data=bytes(24)))
trace("E0807_flat.npz", z=npy(shape="(4,)", data=bytes(16)))
trace("E0807_lengths.npz", held=npy("|b1", "(3,)", b"\x00\x01\x00"))
trace("E0808_bool.npz", grip=FLAGS)
trace("E0808_not_bool.npz", held=npy("<f4", "(2,)", struct.pack("<2f", 0, 0.5)))
trace("E0808_big_endian.npz", z=npy(">f4", "(2, 2)", bytes(16)))

FITTED = """{
  "format": %d,
  "spec": "t",
  "entries": {
    "g": {
      "declaration": "fitted(mean, of = z, where = true)",
      "reads": {},
      "array": "g",
      "frames": %s
    }
  },
  "episodes": [],
  "recordings": {},
  "etlc": "0.1.0"
}
"""
for name, description in (
    ("E0673_unknown_fitted_format", FITTED % (2, "3")),
    ("E0674_invalid_fitted", FITTED % (3, '"three"')),
):
    write(name + ".fitted.npz", zipped([("fitted.json", description), ("g.npy", npy())]))

EMBEDDED = """{
  "format": %s,
  "spec": "t",
  "encoders": {
    "net": {
      "declaration": "load(\\"net.onnx\\"), mean [0, 0, 0], deviation [1, 1, 1]",
      "model": "0123456789abcdef",
      "settings": "mean [0, 0, 0], deviation [1, 1, 1]",
      "kind": "command",
      "dimension": 2,
      "fingerprint": "%s",
      "references": "references-1"
    }
  },
  "entries": {},
  "etlc": "0.2.0"
}
"""
for name, version, fingerprint in (
    ("E1006_unknown_embedded_format", 2, "0" * 16),
    ("E1007_invalid_embedded", 1, "0" * 16),
):
    references = npy(shape="(4, 2)", data=bytes(32))
    write(name + ".embedded.npz", zipped([("embedded.json", EMBEDDED % (version, fingerprint)),
                                          ("references-1.npy", references)]))
