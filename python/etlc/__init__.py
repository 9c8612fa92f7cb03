"""Monitors of Embedding Temporal Logic in Python.

    import etlc

    monitor = etlc.Monitor("dock.etl")
    verdicts = monitor.step(z=embedding, charge=0.3)
    if verdicts.returns.alarm:
        print(verdicts.returns.robustness, verdicts.returns.bounds)

The verdicts equal those of the class that etlc generates, bit for bit. docs/python.md has examples
of all functions.
"""

import sys as _sys

from ._library import library as _native
from .arrays import (
    BatchEpisode,
    BatchVerdicts,
    Episode,
    EpisodeVerdicts,
    RunVerdicts,
    VerdictArrays,
)
from .batch import Batch
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
from .encoding import Encoder
from .description import REFERENCE_FRAMES, Drift, Input, Measurement, Measurements
from .guard import Guard
from .judging import annotate, crossvalidate, evaluate, prove, report
from .labelling import Labelling, Watching, label, propose, watch
from .learning import calibrate, embed, fit, merge, suggest
from .monitor import Monitor
from .results import Checked, Evaluation, Proof, Run, Suggestions, Written
from .specs import check, compile
from .splitting import split
from .traces import explain, incident, run
from .verdicts import Explanation, Verdict, Verdicts

__version__: str = _native.etlc_version().decode()

__all__ = [
    "AmbiguousError",
    "Batch",
    "BatchEpisode",
    "BatchVerdicts",
    "BusyError",
    "Checked",
    "ClosedError",
    "Diagnostic",
    "Drift",
    "Episode",
    "EpisodeVerdicts",
    "Encoder",
    "Error",
    "EtlcWarning",
    "Evaluation",
    "Explanation",
    "Guard",
    "Input",
    "InputError",
    "Labelling",
    "Measurement",
    "Measurements",
    "Monitor",
    "NotKeptError",
    "Proof",
    "REFERENCE_FRAMES",
    "Run",
    "RunVerdicts",
    "SpecError",
    "Suggestions",
    "UndecidedError",
    "Verdict",
    "VerdictArrays",
    "Verdicts",
    "Watching",
    "Written",
    "annotate",
    "calibrate",
    "check",
    "compile",
    "crossvalidate",
    "embed",
    "evaluate",
    "explain",
    "fit",
    "incident",
    "label",
    "merge",
    "propose",
    "prove",
    "report",
    "run",
    "split",
    "suggest",
    "watch",
]

# Modules are no part of the interface: `etlc.batch` would look like a function.
for _name in [name for name, one in globals().items() if isinstance(one, type(_sys))]:
    if not _name.startswith("_"):
        del globals()[_name]


def __dir__() -> list[str]:
    return [*__all__, "__all__", "__doc__", "__version__"]
