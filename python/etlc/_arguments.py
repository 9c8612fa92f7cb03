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


def recorder_text(given: Any) -> bytes | None:
    if given is None or isinstance(given, str):
        return None if given is None else encoded("recorder", given)
    try:
        return encoded("recorder", ",".join(map(str, given)))
    except TypeError:
        raise InputError(f"recorder is {given!r}, expected (before, after, alarms)") from None


def is_whole(value: Any) -> bool:
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)


def is_mapping(value: Any) -> bool:
    return isinstance(value, Mapping)


def flag(name: str, value: Any) -> bool:
    if not isinstance(value, bool):
        shown = repr(value) if len(repr(value)) < 80 else f"of {type(value).__name__}"
        raise InputError(f"{name} is {shown}, expected True or False")
    return value


def size(name: str, value: Any, least: int = 0, most: int = (1 << 63) - 1) -> int:
    if not is_whole(value) or not least <= value <= most:
        raise InputError(f"{name} is {value!r}, expected a whole number from {least} on")
    return int(value)


def count(name: str, value: Any) -> int:
    return size(name, value, 1, 0xFFFFFFFF)
