#!/usr/bin/env python3
"""pick_place.py SOURCE FOLDER: failures of a simulated pick and place (README.md)."""

import json

import numpy as np

import failures


def cells(images):
    """How red, green and blue 4 x 4 pixels are, in the part of the picture with the objects."""
    picture = images[:, 28:72, 48:80].astype("f4") / 255
    colours = [picture[..., c] - np.maximum(picture[..., c - 1], picture[..., c - 2])
               for c in range(3)]
    z = np.maximum(np.stack(colours, -1), 0)
    return z.reshape(len(z), 11, 4, 8, 4, 3).mean((2, 4)).reshape(len(z), -1)


def read(source, folder):
    for meta in sorted((source / "data/raw/mj_pick_place_v5").glob("*/meta.json")):
        facts = json.loads(meta.read_text())
        if "seed" not in facts:
            continue  # a piece of a task, not an attempt
        with np.load(meta.with_name("trajectory.npz")) as file:
            state = file["obs_state"]
            steps = len(file["actions"])  # the last state has no action
            arrays = {"z": cells(file["obs_rgb"]), "state": state, "hand": state[:, :3],
                      "grip": state[:, 3], "height": state[:, 6]}
            arrays = {name: array[:steps] for name, array in arrays.items()}
            arrays["action"] = file["actions"]
        failures.write(folder, meta.parent.name, not facts["success"],
                       group=f"scene {facts['episode']}", **arrays)


if __name__ == "__main__":
    failures.main(read, [("", ["pick_place_seen"]),
                         (" of states", ["pick_place_seen"], "--set=D=9", "--map=z=state"),
                         ("", ["pick_place_moves", "pick_place_times"])], "steps", 1)
