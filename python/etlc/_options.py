from __future__ import annotations
from typing import Literal, NamedTuple
class Option(NamedTuple):
    name: str
    value: str
    manner: Literal["positional", "flag", "word", "one", "several", "any"]
OPTIONS: dict[str, tuple[Option, ...]] = {}
