"""Checks the arguments that a Monitor is opened with."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from ._library import encoded
from .errors import InputError


def choice(name: str, value: str, choices: tuple[str, ...]) -> int:
    if value not in choices:
        raise InputError(f"{name} is {value!r}, expected {' or '.join(choices)}")
    return choices.index(value)


def recorder_text(given: str | tuple[int | str, int | str, int] | None) -> bytes | None:
    if given is None:
        return None
    return encoded("recorder", given if isinstance(given, str) else ",".join(map(str, given)))


def is_whole(value: Any) -> bool:
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)


def is_mapping(value: Any) -> bool:
    return isinstance(value, Mapping)


def flag(name: str, value: Any) -> bool:
    if not isinstance(value, bool):
        shown = repr(value) if len(repr(value)) < 80 else f"of {type(value).__name__}"
        raise InputError(f"{name} is {shown}, expected True or False")
    return value


def size(name: str, value: Any) -> int:
    if not is_whole(value) or not 0 <= value < 1 << 63:
        raise InputError(f"{name} is {value!r}, expected a whole number from 0 on")
    return int(value)


def count(name: str, value: Any) -> int:
    if size(name, value) == 0 or value > 0xFFFFFFFF:
        raise InputError(f"{name} is {value!r}, expected a whole number from 1 on")
    return int(value)
