"""Monitors of Embedding Temporal Logic in Python.

    import etlc

    monitor = etlc.Monitor("dock.etl")
    verdicts = monitor.step(z=embedding, charge=0.3)
    if verdicts.returns.alarm:
        print(verdicts.returns.robustness, verdicts.returns.bounds)

The verdicts equal those of the class that etlc generates, bit for bit. docs/python.md has examples
of all functions.
"""

from ._library import library as _native
from .batch import Batch
from .commands import Evaluation, Written, calibrate, embed, evaluate, fit, incident
from .errors import (
    AmbiguousError,
    BusyError,
    ClosedError,
    Diagnostic,
    Error,
    EtlcWarning,
    InputError,
    NotKeptError,
    SpecError,
    UndecidedError,
)
from .description import REFERENCE_FRAMES, Input, Measurement, Measurements
from .monitor import Monitor
from .verdicts import (
    BatchEpisode,
    BatchVerdicts,
    Episode,
    EpisodeVerdicts,
    Explanation,
    RunVerdicts,
    Verdict,
    VerdictArrays,
    Verdicts,
)

__version__: str = _native.etlc_version().decode()

__all__ = [
    "AmbiguousError",
    "Batch",
    "BatchEpisode",
    "BatchVerdicts",
    "BusyError",
    "ClosedError",
    "Diagnostic",
    "Episode",
    "EpisodeVerdicts",
    "Error",
    "EtlcWarning",
    "Evaluation",
    "Explanation",
    "Input",
    "InputError",
    "Measurement",
    "Measurements",
    "Monitor",
    "NotKeptError",
    "REFERENCE_FRAMES",
    "RunVerdicts",
    "SpecError",
    "UndecidedError",
    "Verdict",
    "VerdictArrays",
    "Verdicts",
    "Written",
    "calibrate",
    "embed",
    "evaluate",
    "fit",
    "incident",
]
