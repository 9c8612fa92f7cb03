"""A program that uses the package, for the type checker alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import etlc


def stops_at(monitor: etlc.Monitor, frames: NDArray[np.float32]) -> int:
    """Returns the step of the first alarm; -1 if there is none."""
    for step, frame in enumerate(frames):
        verdicts: etlc.Verdicts = monitor.step(z=frame)
        alarm: bool = verdicts["keeps"].alarm
        if alarm:
            return step
    return -1


def best_of(monitor: etlc.Monitor, plans: NDArray[np.float32]) -> int:
    """Returns the plan whose verdict has the greatest lower bound."""
    ahead = monitor.ahead(z=plans)
    return int(np.argmax(ahead["keeps"].lower[:, -1]))


def judged(spec: str, episodes: list[str]) -> dict[str, object]:
    """Calibrates, and returns the figures of the monitors."""
    made: etlc.Written = etlc.calibrate(spec, episodes[:-1], settings={"limit": 2}, jobs=2)
    found: etlc.Evaluation = etlc.evaluate(spec, episodes[-1:], thresholds=made.path)
    run: etlc.Run = etlc.run(spec, episodes[0], distances=True)
    distance: NDArray[np.float32] = run.episode.distances["near"]
    print(run.episode["keeps"].first_alarm, distance.shape, etlc.explain(spec, episodes[0]).text)
    return found.data


def encoded(spec: str, images: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Encodes images with a model of this process."""

    def mean(image: NDArray[np.uint8]) -> NDArray[np.float32]:
        pixel: NDArray[np.float32] = np.asarray(image, "f4")[0, 0]
        return pixel

    etlc.embed(spec, "drives", output="episodes", encoder=mean)
    with etlc.Encoder(spec, encoder=mean) as encoder:
        return encoder(images)


with etlc.Monitor(text="spec s; input z : f32[2]; monitor keeps = G true;") as opened:
    batch = opened.batch(3)
    print(batch.step(z=np.zeros((3, 2), "f4"))["keeps"].robustness.tolist(), opened.steps)
    print(stops_at(opened, np.zeros((4, 2), "f4")), best_of(opened, np.zeros((5, 4, 2), "f4")))
