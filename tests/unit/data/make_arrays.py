#!/usr/bin/env python3
"""Writes the .npy and .npz files beside it, as numpy writes them. Needs numpy; runs in any folder.

Element (i, j) of every 3 x 4 array is 4 i + j, minus 2 for signed types, halved for floating-point
types: exact in float16, so every file holds the same numbers.
"""
import io
import pathlib
import zipfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
COUNT = np.arange(12).reshape(3, 4)
NUMBERS = (COUNT - 2) / 2


def npy(name, array, version=None):
    with open(HERE / name, "wb") as file:
        np.lib.format.write_array(file, np.asanyarray(array), version=version, allow_pickle=True)


def npz(name, compression, **arrays):
    """Like np.savez, with a fixed time stamp: the same bytes on every run."""
    with zipfile.ZipFile(HERE / name, "w", compression) as archive:
        for key, array in arrays.items():
            member = zipfile.ZipInfo(key + ".npy", (1980, 1, 1, 0, 0, 0))
            member.compress_type = compression
            data = io.BytesIO()
            np.lib.format.write_array(data, np.asanyarray(array))
            with archive.open(member, "w", force_zip64=True) as file:
                file.write(data.getvalue())


for kind in ("f2", "f4", "f8"):
    npy(f"{kind}_c.npy", NUMBERS.astype("<" + kind))
    npy(f"{kind}_fortran.npy", np.asfortranarray(NUMBERS.astype("<" + kind)))
for kind in ("i1", "i2", "i4", "i8"):
    npy(f"{kind}.npy", (COUNT - 2).astype("<" + kind))
for kind in ("u1", "u2", "u4", "u8"):
    npy(f"{kind}.npy", COUNT.astype("<" + kind))
npy("bool.npy", COUNT % 2 == 1)
npy("version2.npy", NUMBERS.astype("<f4"), version=(2, 0))
npy("version3.npy", NUMBERS.astype("<f4"), version=(3, 0))
npy("scalar.npy", np.float32(2.5))
npy("vector.npy", np.array([1, 2.5, -3], "<f4"))
npy("empty.npy", np.zeros((0, 4), "<f4"))
npy("rank3_fortran.npy", np.asfortranarray(np.arange(24, dtype="<f4").reshape(2, 3, 4)))
npy("special.npy", np.array([np.nan, np.inf, -np.inf, -0.0, 6e-8, 65504], "<f2"))

npy("big_endian.npy", NUMBERS.astype(">f4"))
npy("structured.npy", np.zeros(3, [("x", "<f4"), ("y", "<f4")]))
npy("object.npy", np.array([None, "x"], object))
npy("complex.npy", np.zeros(3, "<c8"))
npy("text.npy", np.array(["goal", "corner"]))
npy("time.npy", np.zeros(3, "<M8[s]"))

ARRAYS = {"goal": NUMBERS.astype("<f4"), "half": NUMBERS.astype("<f2"),
          "turned": np.asfortranarray(NUMBERS)}
npz("stored.npz", zipfile.ZIP_STORED, **ARRAYS)
npz("deflated.npz", zipfile.ZIP_DEFLATED, **ARRAYS)
npz("single.npz", zipfile.ZIP_DEFLATED, goal=ARRAYS["goal"])
npz("bzip2.npz", zipfile.ZIP_BZIP2, goal=ARRAYS["goal"])

STEPS = np.arange(7)
EMBEDDING = STEPS[:, None] + np.array([0, 0.25, 0.5])
TRACE = {
    "z": EMBEDDING.astype("<f4"),
    "z_turned": np.asfortranarray(EMBEDDING),
    "z_half": EMBEDDING.astype("<f2"),
    "gripper": (STEPS / 8).astype("<f4"),
    "column": (STEPS / 8).reshape(7, 1),
    "held": STEPS % 2 == 1,
    "held_int": (STEPS % 2).astype("i8"),
    "short": np.zeros(6, "<f4"),
    "gap": np.where(STEPS == 3, np.nan, STEPS).astype("<f4"),
    "big": EMBEDDING.astype(">f4"),
}
npz("trace_stored.npz", zipfile.ZIP_STORED, **TRACE)
npz("trace_deflated.npz", zipfile.ZIP_DEFLATED, **TRACE)
