"""Converts samples to the types and shapes of libetlc, or refuses them.

A number is rounded at most once, as in `etlc run`. Conversions that lose more, or change the
meaning, are refused: integers for float32 embeddings, floats for int8, numbers for bools.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Iterable, Union

import numpy as np

from ._arguments import is_mapping
from ._types import Array, extremes, untyped
from .errors import InputError


def as_bool(what: str, value: Any) -> int:
    """Returns 0 or 1. `what`: how messages name the value, such as "input 'stop'"."""
    array = _array(what, value)
    if array.shape == () and array.dtype.kind in "biu" and (array == 0 or array == 1):
        return int(array)
    raise InputError(f"{what} is {_shown(array)}, expected a bool")


def as_number(what: str, value: Any) -> float:
    """Returns a scalar, rounded to float32."""
    if isinstance(value, int) and abs(value) >> 63:  # beyond numpy's integers
        return _rounded(value)
    array = _array(what, value)
    if array.shape == () and array.dtype.kind in "fiu":
        with np.errstate(over="ignore"):
            return float(array.astype("f4"))
    raise InputError(f"{what} is {_shown(array)}, expected a number")


def _rounded(value: int) -> float:
    """Returns the nearest float32. One extra sticky bit stands for the bits cut off."""
    cut = abs(value).bit_length() - 62
    kept = abs(value) >> cut
    kept |= kept << cut != abs(value)
    size = math.ldexp(np.float32(np.int64(kept)), cut) if cut < 128 else math.inf
    return size if value > 0 else -size


def as_elements(what: str, value: Any, dtype: np.dtype[Any], shape: tuple[int, ...]) -> Array:
    """Returns an embedding as an array of the type."""
    array = _array(what, value)
    if array.shape != shape:
        raise InputError(f"{what} is {_shown(array)}, expected the shape {shape}")
    return _converted(what, array, dtype, isinstance(value, (list, tuple)))


def chosen_of(which: Any, count: int) -> Array:
    """Returns a byte for each environment: 1 where `which` is true, or has its number.

    Integers are numbers. A mask of integers would be read as other environments, so what may be
    one is refused: one of three environments or more repeats a number.
    """
    kind = type(which).__name__
    if is_mapping(which) or isinstance(which, (str, bytes, np.ma.MaskedArray)):
        raise InputError(f"which is of {kind}, {_WHICH}")
    values = _items(which)
    array = _array("which", which if values is None else values)
    if array.dtype == np.bool_:
        if array.shape != (count,):
            raise InputError(
                f"which is {_shown(array)}, expected a bool for each environment: the shape "
                f"({count},)"
            )
        return np.ascontiguousarray(array).view("u1")
    is_row = array.ndim <= 1 or (values is None and array.shape[1:] == (1,))  # or of argwhere
    is_mixed = any(isinstance(one, (bool, np.bool_)) for one in values or ())
    if not is_row or is_mixed or (array.dtype.kind not in "iu" and array.size > 0):
        raise InputError(f"which is {_shown(array)}, {_WHICH}")
    return _of_numbers(array.ravel(), count, is_one=array.ndim == 0)


_WHICH = "expected a bool for each environment, or the numbers of some"


def _items(which: Any) -> list[Any] | None:
    """Returns the elements of an iterable; None for a number or an array."""
    if hasattr(which, "__array__") or not hasattr(which, "__iter__"):
        return None
    items: list[Any] = list(which)
    is_of_nonzero = len(items) == 1 and getattr(items[0], "ndim", 0) == 1
    return list(items[0]) if is_of_nonzero and isinstance(which, tuple) else items


def _of_numbers(numbers: Array, count: int, is_one: bool) -> Array:
    chosen: Array = np.zeros(count, "u1")
    beyond = numbers[(numbers < 0) | (numbers >= count)]
    if beyond.size > 0:
        raise InputError(f"there is no environment {beyond[0]}, only 0 to {count - 1}")
    found, times = np.unique(numbers.astype("i8"), return_counts=True)
    if found.size < numbers.size:
        raise InputError(
            f"which has environment {found[times > 1][0]} more than once: integers are numbers of "
            "environments; pass a mask as bools (mask != 0)"
        )
    if numbers.size == count <= 2 and not is_one:
        raise InputError(
            f"which is {numbers.tolist()}, which may be the numbers of all environments or a mask: "
            "pass bools (mask != 0), or None for all"
        )
    chosen[found] = 1
    return chosen


#: A leading axis of arrays: its length, or its name where any length will do.
Axis = Union[int, str]


@dataclass
class Rows:
    """The samples of an input at steps, the last axis but that of their elements.

    Attributes:
        lead: the lengths of the leading axes.
        data: the elements; those of a sample are contiguous and aligned.
        present: per sample whether it is there; None: all are.
    """

    lead: tuple[int, ...]
    data: Array
    present: Array | None


def as_rows(
    what: str, value: Any, dtype: np.dtype[Any], shape: tuple[int, ...], *leads: tuple[Axis, ...]
) -> Rows:
    """Returns samples at steps: the caller's array if possible.

    `leads` are the leading axes that it may have.
    """
    masked = isinstance(value, np.ma.MaskedArray)
    array = _array(what, value.data if masked else value)
    axes = array.ndim - len(shape)
    lead = next((lead for lead in leads if len(lead) == axes), None)
    if lead is None or array.shape[axes:] != shape:
        expected = " or ".join(_shape_text((*lead, *shape)) for lead in leads)
        raise InputError(f"{what} is {_shown(array)}, expected the shape {expected}")
    for found, axis in zip(array.shape, lead):
        if isinstance(axis, int) and found != axis:
            raise InputError(
                f"{what} is {_shown(array)}, expected {axis} environments: a batch neither "
                "grows nor shrinks"
            )
    present = None
    if masked:
        mask: Array = untyped.ma.getmaskarray(value)
        hidden: Array = mask.any(axis=tuple(range(axes, len(mask.shape))))
        present = np.ascontiguousarray(~hidden).view("u1")
    is_list = isinstance(value, (list, tuple))
    rows = array if array.dtype == dtype else _converted(what, array, dtype, is_list, present)
    is_packed = len(shape) == 0 or shape[0] == 1 or rows.strides[-1] == dtype.itemsize
    if not rows.flags.aligned or not is_packed or any(
        stride % dtype.itemsize != 0 for stride in rows.strides[:axes]
    ):
        rows = rows.copy(order="C")
    return Rows(array.shape[:axes], rows, present)


def as_embedding(value: Any) -> Array:
    """Returns what a model makes of an image as float32 (D,)."""
    array = _array("the embedding", value)
    if array.ndim == 2 and array.shape[0] == 1:
        array = array[0]
    if array.ndim != 1 or array.size == 0 or array.dtype.kind != "f":
        raise InputError(f"the encoder returned {_shown(array)}, expected floats of the shape (D,)")
    return np.ascontiguousarray(array.astype("f4"))


def as_images(value: Any) -> Array:
    """Returns one image or several as uint8 (N, rows, columns, 3)."""
    array = _array("the image", value)
    if array.dtype != np.uint8 or array.ndim not in (3, 4) or array.shape[-1] != 3:
        raise InputError(
            f"images are {_shown(array)}, expected uint8 of the shape (rows, columns, 3) or "
            "(N, rows, columns, 3), red first"
        )
    return np.ascontiguousarray(array if array.ndim == 4 else array[np.newaxis])


def _shape_text(shape: tuple[Axis, ...]) -> str:
    return f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"


def _array(what: str, value: Any) -> Array:
    """Converts to a numpy array. Refuses masked arrays, whose mask would be lost."""
    if isinstance(value, np.ma.MaskedArray):
        raise InputError(f"{what} is a masked array; one that is missing is None")
    if any(isinstance(one, np.ma.MaskedArray) for one in _listed(value)):
        raise InputError(f"{what} has masked arrays in a list; numpy.ma.stack joins them")
    try:
        return np.asarray(value)
    except (ValueError, TypeError, RuntimeError) as error:
        device = getattr(value, "device", None)
        if device is not None and str(device) != "cpu":
            raise InputError(
                f"{what} is on the device {device}, expected an array in the memory of "
                "this process: pass x.detach().cpu().numpy()"
            ) from None
        raise InputError(f"{what} is no array: {error}") from None


def _listed(value: Any) -> Iterable[Any]:
    is_list = isinstance(value, (list, tuple))
    values: Iterable[Any] = value
    return values if is_list else ()


def _converted(
    what: str, array: Array, dtype: np.dtype[Any], is_list: bool, present: Array | None = None
) -> Array:
    kind = array.dtype.kind
    if array.size == 0 and is_list:  # an empty list has no type
        return array.astype(dtype)
    if dtype == np.uint8:
        if kind == "b":
            return array.view("u1")
        least, most, expected = 0, 1, "bool"
    elif dtype == np.int8:
        least, most, expected = -128, 127, "int8"
    else:
        if kind == "f" or (kind in "iu" and is_list):
            with np.errstate(over="ignore"):
                return array.astype(dtype)
        raise InputError(f"{what} is {_shown(array)}, expected {dtype.name}")
    there = array if present is None else array[present != 0]
    low, high = extremes(there) if kind in "iu" else (0.0, 0.0)
    if kind not in "iu" or low < least or high > most:
        raise InputError(f"{what} is {_shown(array)}, expected {expected}")
    return array.astype(dtype)


def _shown(array: Array) -> str:
    if array.shape == () and array.dtype.kind != "V":
        text = f"{array.item()!r}"
        return text if len(text) <= 80 else f"{text[:80]}..."
    return f"an array of {array.dtype.name} and the shape {array.shape}"
