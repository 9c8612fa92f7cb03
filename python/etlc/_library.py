"""Wraps libetlc.so with ctypes: structs, functions, and exceptions in place of statuses."""

from __future__ import annotations

import ctypes
import importlib
import os
import re
from ctypes import POINTER, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint32
from ctypes import c_uint64, c_void_p
from pathlib import Path
from typing import Any, Callable

from .errors import BusyError, ClosedError, Error, InputError, NotKeptError, SpecError
from .errors import UndecidedError, diagnostics_of
from .names import is_text

API_VERSION = 6

F32, BOOL, F16, I8 = range(4)
INPUTS, MONITORS, PREDICATES, LETS = range(4)
SATISFIED, VIOLATED, DECIDED, FINAL = 1, 2, 4, 8
ALARM = VIOLATED | DECIDED | FINAL
FULFILLED = SATISFIED | DECIDED | FINAL


class Options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint32), ("api_version", c_uint32), ("path", c_char_p),
        ("text", c_char_p), ("thresholds", c_char_p), ("fitted", c_char_p),
        ("settings", POINTER(c_char_p)), ("setting_count", c_size_t), ("values", c_uint32),
        ("targets_as", c_uint32), ("lets", c_uint32), ("reserved", c_uint32),
        ("max_state", c_uint64), ("max_code", c_uint64), ("max_work", c_uint64),
        ("history", c_uint64), ("recorder", c_char_p), ("embedded", c_char_p),
    ]  # fmt: skip


class Description(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint32), ("inputs", c_uint32), ("monitors", c_uint32),
        ("predicates", c_uint32), ("lets", c_uint32), ("horizon", c_uint32),
        ("step_seconds", c_double), ("state_bytes", c_uint64), ("spec_hash", c_uint64),
        ("data_hash", c_uint64), ("thresholds_hash", c_uint64), ("name", c_char_p),
        ("warnings", c_char_p),
    ]  # fmt: skip


class InputDescription(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint32), ("type", c_uint32), ("dimension", c_uint32),
        ("hold", c_uint32), ("low", c_float), ("high", c_float), ("scale", c_float),
        ("is_embedding", c_uint32), ("is_used", c_uint32), ("stale_after", c_uint32),
        ("name", c_char_p),
    ]  # fmt: skip


class MonitorDescription(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint32), ("is_sliding", c_uint32), ("restarts", c_uint32),
        ("horizon", c_uint32), ("name", c_char_p), ("formula", c_char_p),
    ]  # fmt: skip


class PredicateDescription(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint32), ("is_measured", c_uint32), ("is_adaptive", c_uint32),
        ("has_nearest", c_uint32), ("name", c_char_p), ("text", c_char_p),
    ]  # fmt: skip


class Sample(ctypes.Structure):
    _fields_ = [("data", c_void_p), ("count", c_uint32), ("type", c_uint32)]


class Column(ctypes.Structure):
    _fields_ = [
        ("data", c_void_p), ("present", c_void_p), ("stride", c_int64), ("count", c_uint32),
        ("type", c_uint32),
    ]  # fmt: skip


def advance(columns: Any, steps: int) -> None:
    """Leads columns to the samples after these steps."""
    for column in columns:
        if column.data is not None:
            column.data += steps * column.stride
        if column.present is not None:
            column.present += steps


class Grid(ctypes.Structure):
    _fields_ = [
        ("data", c_void_p), ("present", c_void_p), ("stride", c_int64), ("step_stride", c_int64),
        ("count", c_uint32), ("type", c_uint32),
    ]  # fmt: skip


class VerdictStruct(ctypes.Structure):
    _fields_ = [
        ("robustness", c_float), ("lower", c_float), ("upper", c_float), ("status", c_uint32),
    ]  # fmt: skip


class Measured(ctypes.Structure):
    _fields_ = [("distance", c_float), ("threshold", c_float), ("nearest", c_uint32)]


class DriftStruct(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint32), ("is_alarm", c_uint32), ("episodes", c_uint32),
        ("wealth", c_float), ("limit", c_float), ("counts", c_uint32 * 8),
    ]  # fmt: skip


class Counts(ctypes.Structure):
    _fields_ = [("missing", c_uint64), ("out_of_range", c_uint64), ("held", c_uint64)]


_ARGUMENTS: dict[str, list[Any] | None] = {
    "etlc_open": [POINTER(Options), POINTER(c_uint64)],
    "etlc_close": [c_uint64],
    "etlc_describe": [c_uint64, POINTER(Description)],
    "etlc_describe_input": [c_uint64, c_uint32, POINTER(InputDescription)],
    "etlc_describe_monitor": [c_uint64, c_uint32, POINTER(MonitorDescription)],
    "etlc_describe_predicate": [c_uint64, c_uint32, POINTER(PredicateDescription)],
    "etlc_describe_let": [c_uint64, c_uint32, POINTER(c_char_p)],
    # No types: a step passes ctypes objects that already have the right types.
    "etlc_step": None,
    "etlc_run": [c_uint64, c_void_p, c_size_t, c_uint64, c_void_p, c_size_t],
    "etlc_finish": [c_uint64, c_void_p, c_size_t],
    "etlc_reset": [c_uint64],
    "etlc_restart": [c_uint64, c_uint32],
    "etlc_observe": [c_uint64, c_uint32, c_float, c_uint32],
    "etlc_steps": [c_uint64, POINTER(c_uint64)],
    "etlc_position": [c_uint64, c_uint32, POINTER(c_uint64)],
    "etlc_measure": [c_uint64, c_uint32, POINTER(Measured)],
    "etlc_inner_threshold": [c_uint64, c_uint32, POINTER(c_float)],
    "etlc_let": [c_uint64, c_uint32, c_void_p],
    "etlc_end_episode": [c_uint64],
    "etlc_drifted": [c_uint64, c_char_p, POINTER(DriftStruct)],
    "etlc_encoder_difference": [
        c_uint64, c_char_p, c_uint32, POINTER(c_float), c_size_t, POINTER(c_double)
    ],  # fmt: skip
    "etlc_count": [c_uint64, c_uint32, POINTER(Counts)],
    "etlc_incidents": [c_uint64, POINTER(c_uint32), POINTER(c_uint32)],
    "etlc_incident": [c_uint64, c_uint32, POINTER(c_void_p), POINTER(c_size_t)],
    "etlc_close_incidents": [c_uint64],
    "etlc_forget_incidents": [c_uint64],
    "etlc_copy": [c_uint64, POINTER(c_uint64)],
    "etlc_ahead": [
        c_uint64, c_void_p, c_size_t, c_uint64, c_uint64, c_uint32, c_void_p, c_size_t
    ],  # fmt: skip
    "etlc_save": [c_uint64, POINTER(c_void_p), POINTER(c_size_t)],
    "etlc_load": [c_uint64, c_char_p, c_size_t],
    "etlc_open_batch": [c_uint64, c_uint64, POINTER(c_uint64)],
    "etlc_run_batch": [c_uint64, c_void_p, c_size_t, c_uint64, c_uint32, c_void_p, c_size_t],
    "etlc_reset_batch": [c_uint64, c_void_p, c_uint64],
    "etlc_restart_batch": [c_uint64, c_uint32, c_void_p, c_uint64],
    "etlc_finish_batch": [c_uint64, c_void_p, c_uint64, c_void_p, c_size_t],
    "etlc_steps_batch": [c_uint64, c_void_p, c_uint64],
    "etlc_measure_batch": [c_uint64, c_uint32, c_void_p, c_uint64],
    "etlc_copy_environment": [c_uint64, c_uint64, POINTER(c_uint64)],
    "etlc_explain": [c_uint64, c_uint32, c_uint32, POINTER(c_char_p)],
}

_HERE = Path(__file__).resolve().parent
NATIVE = _HERE / "_native"


def own(name: str, in_wheel: str) -> Path | None:
    """Finds a file installed with this package: inside it for a wheel, else below its prefix."""
    places = [NATIVE / in_wheel]
    try:
        installed: Any = importlib.import_module("._installed", __package__)
    except ImportError:
        pass  # the source tree
    else:
        places.append(Path(os.path.normpath(_HERE / getattr(installed, name))))
    return next((place for place in places if place.exists()), None)


def _load() -> ctypes.CDLL:
    """Loads $ETLC_LIBRARY, the library installed with this package, or the system's."""
    path = os.environ.get("ETLC_LIBRARY") or own("LIBRARY", "lib/libetlc.so.1") or "libetlc.so.1"
    try:
        library = ctypes.CDLL(os.fspath(path))
    except OSError as error:
        raise ImportError(f"libetlc cannot be loaded: {error}") from None
    for name, arguments in _ARGUMENTS.items():
        function = getattr(library, name)
        function.restype = c_int32
        if arguments is not None:
            function.argtypes = arguments
    for name in ("etlc_message", "etlc_message_json", "etlc_version"):
        getattr(library, name).restype = c_char_p
    return library


library = _load()


def decoded(text: bytes | None) -> str:
    """Decodes a C string. File names in it may contain any bytes."""
    return (text or b"").decode(errors="replace")


_EXCEPTIONS: dict[int, type[Error]] = {
    3: ClosedError, 4: BusyError, 6: InputError, 7: InputError, 8: InputError, 9: InputError,
    10: NotKeptError, 11: UndecidedError, 12: ClosedError,
}  # fmt: skip


#: What messages call options and functions in C: options.history, etlc_finish_batch().
_C_WORDS = re.compile(r"\boptions\.(?=\w)|\betlc_(finish|reset)(?:_batch)?(?=\(\))")


def raise_for(status: int) -> None:
    """Raises the exception for the status of this thread's last call."""
    message = decoded(library.etlc_message())
    if status == 3:
        raise ClosedError("the monitor is closed")
    if status == 1:
        raise SpecError(message, diagnostics_of(library.etlc_message_json()))
    message = _C_WORDS.sub(r"\1", message)
    if status == 13:
        raise MemoryError(message)
    raise _EXCEPTIONS.get(status, Error)(message)


def encoded(what: str, text: str) -> bytes:
    """Encodes a text for C. Refuses a NUL, which would cut it off."""
    if not is_text(text):
        raise InputError(f"{what} is {text!r}, expected a str")
    return _checked(what, text, str.encode)


def encoded_path(what: str, path: str | bytes | os.PathLike[str]) -> bytes:
    """Encodes the name of a file, which may contain any bytes of the file system."""
    raw = _checked(what, path, os.fsencode)
    if not raw:
        raise InputError(f"{what} is {path!r}, expected a path")
    return raw


def _checked(what: str, text: Any, encode: Callable[[Any], bytes]) -> bytes:
    try:
        raw = encode(text)
    except UnicodeEncodeError as error:
        found = error.object[error.start]
        raise InputError(f"{what} {text!r} has {found!r} in it, which is no character") from None
    except TypeError as error:
        raise InputError(f"{what} is {text!r}: {error}") from None
    if b"\0" in raw:
        raise InputError(f"{what} {text!r} has a NUL in it")
    return raw


def call(function: Any, *arguments: Any) -> None:
    """Calls the function, and raises an exception if it fails."""
    status = function(*arguments)
    if status != 0:
        raise_for(status)
