#!/usr/bin/env python3
"""Writes trace.h5 and lzf.h5 (h5py) beside this file: datasets of every valid and invalid kind for
a trace."""
import pathlib

import h5py
import numpy as np

STEPS = 7
HERE = pathlib.Path(__file__).resolve().parent
with h5py.File(HERE / "trace.h5", "w", libver="earliest") as f:
    t = np.arange(STEPS)
    z = np.stack([t, t + 0.25, t + 0.5], axis=1).astype(np.float32)
    f["z"] = z
    f["z_half"] = z.astype(np.float16)
    f["z_big_endian"] = z.astype(">f8")
    f.create_dataset("z_packed", data=z, chunks=(3, 2), compression="gzip")
    f["gripper"] = t / 8
    f["column"] = (t / 8)[:, None]
    f["held"] = t % 2 == 1
    f["held_int"] = (t % 2).astype(np.int32)
    f["not_finite"] = np.where(t == 3, np.nan, np.where(t == 4, np.inf, t))
    f["text"] = np.array([b"a"] * STEPS)
    f["pairs"] = np.zeros(STEPS, dtype=[("a", "f4"), ("b", "f4")])
    f["short"] = t[:5]
    f["one"] = 1.0
    f["cube"] = np.zeros((STEPS, 3, 2), np.int8)
    f["none"] = np.zeros((0, 3), np.float32)
    f["soft"] = h5py.SoftLink("/z")
    f["external"] = h5py.ExternalLink("other.h5", "/z")
    f.create_dataset("elsewhere", shape=(STEPS,), dtype="f4",
                     external=[("other.bin", 0, 4 * STEPS)])
    layout = h5py.VirtualLayout(shape=(STEPS,), dtype="f4")
    layout[:] = h5py.VirtualSource("other.h5", "q", shape=(STEPS,))
    f.create_virtual_dataset("virtual", layout)
    for demo in (10, 2, 1):
        group = f.create_group(f"data/demo_{demo}")
        group["obs/z"] = z + demo
        group["truth.at_a"] = t > demo
    f["data/notes"] = 1.0
    f.create_group("data/other")
    f.create_group("data/demo_\x1b[31m")

with h5py.File(HERE / "lzf.h5", "w", libver="earliest") as f:
    f.create_dataset("z", data=z, chunks=(7, 3), compression="lzf")
