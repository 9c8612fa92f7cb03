#!/usr/bin/env python3
"""crashes.py SOURCE FOLDER: crashes of a real mobile robot (README.md)."""

import json

import numpy as np

import failures

FAILED = {"E2": False, "E3": False, "N4": True, "N5": True}


def read(source, folder):
    seen = set()
    for kind, failed in FAILED.items():
        for file in sorted((source / kind).glob(f"*/{kind}_*.json")):
            frames = json.loads(file.read_text())["frames"]
            times = tuple(frame["timestamp"] for frame in frames)
            if times in seen:
                continue  # the mirror image of an earlier one
            seen.add(times)
            scan = np.array([[near for _, near in frame["scan"]] for frame in frames], "f4")
            motion = np.array([[*frame["lin_vel"], *frame["lin_acc"], frame["ang_vel"]]
                               for frame in frames], "f4")
            x, y = np.array([frame["obj_pos"] for frame in frames], "f4").T
            arrays = {"scan": scan, "motion": motion, "x": x, "y": y,
                      "ahead": scan[:, 56:72].max(1)}
            # What comes after the robot has lost half of its speed is no warning.
            speed = np.hypot(motion[:, 0], motion[:, 1])
            stops = np.flatnonzero(speed < np.maximum.accumulate(speed) / 2)
            end = stops[0] if len(stops) else len(frames)
            arrays = {name: array[:end] for name, array in arrays.items()}
            failures.write(folder, file.stem, failed, **arrays)


if __name__ == "__main__":
    failures.main(read, [("", ["crashes_seen", "crashes_near", "crashes_times"])], "seconds", 0.1)
