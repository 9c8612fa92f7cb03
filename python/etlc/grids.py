"""Samples of all inputs for the calls that take rows of steps."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

import ctypes
from typing import Any, Mapping

from . import _library, conversion
from ._arguments import is_mapping
from ._types import Array
from .description import Described
from .errors import EtlcWarning, InputError, warn
from .names import no_such


class Grids:
    """The samples of all inputs, as libetlc takes them.

    Attributes:
        lead: the lengths of the leading axes, the same for all inputs.
    """

    def __init__(
        self, spec: Described, given: Mapping[str, Any], *leads: tuple[conversion.Axis, ...]
    ) -> None:
        self._columns = (_library.Grid * len(spec.inputs))()
        self._kept: list[Array] = []  # what the grids point into
        lead: tuple[int, ...] | None = None
        for name in given:
            if name not in spec.inputs:
                raise InputError(no_such("input", name, tuple(spec.inputs)))
        for at, one in enumerate(spec.inputs.values()):
            value = given.get(one.name)
            if value is None:
                continue
            what = f"input {one.name!r}"
            rows = conversion.as_rows(what, value, spec._elements_of[at], one.shape, *leads)
            if lead is not None and rows.lead != lead:
                raise InputError(
                    f"{what} has {_counts(rows.lead)}, others have {_counts(lead)}"
                )
            lead = rows.lead
            grid = self._columns[at]
            grid.count, grid.type = spec._counts[at], spec._types[at]
            self._point(grid, rows, len(leads[0]) == 1 and isinstance(leads[0][0], int))
        if lead is None:
            raise InputError("no input is given: pass an array of one at least")
        self.lead = lead

    def _point(self, grid: Any, rows: conversion.Rows, is_step: bool) -> None:
        """Leads a grid to the samples of an input."""
        axes, data = len(rows.lead), rows.data
        if axes == 3:  # those of an environment lie one after another
            data = data.reshape(-1, *data.shape[2:])
            axes = 2
        self._kept.append(data)
        grid.data = data.__array_interface__["data"][0]
        if is_step:
            grid.stride = data.strides[0]
        elif axes == 1:
            grid.step_stride = data.strides[0]
        else:
            grid.stride, grid.step_stride = data.strides[:2]
        if rows.present is not None:
            self._kept.append(rows.present)
            grid.present = rows.present.__array_interface__["data"][0]

    def columns(self) -> Any:
        """Returns the same for a call that takes one row."""
        columns = (_library.Column * len(self._columns))()
        for grid, column in zip(self._columns, columns):
            column.data, column.present = grid.data, grid.present
            column.stride, column.count, column.type = grid.step_stride, grid.count, grid.type
        return columns

    @property
    def place(self) -> int:
        return ctypes.addressof(self._columns)

    def __len__(self) -> int:
        return len(self._columns)


def joined(arrays: Mapping[str, Any] | None, more: dict[str, Any]) -> dict[str, Any]:
    """Joins the two ways of giving samples. Arguments replace those of the dict."""
    if arrays is not None and not is_mapping(arrays):
        raise InputError(f"arrays is of {type(arrays).__name__}, expected a dict by input")
    return {**(arrays or {}), **more}


def warn_of_absent(spec: Described, given: Mapping[str, Any]) -> None:
    """Warns of inputs that monitors use and that are not given."""
    absent = [name for name, one in spec.inputs.items() if one.is_used and name not in given]
    if absent:
        said = "; ".join(
            f"every sample of {name!r} is missing: it is not given" for name in absent
        )
        warn(EtlcWarning(f"{said}; predicates that measure it are unknown throughout"))


def _counts(lead: tuple[int, ...]) -> str:
    names = ("steps",) if len(lead) == 1 else ("rows", "steps")
    if len(lead) == 3:
        names = ("environments", "plans", "steps")
    return " of ".join(f"{count} {name}" for count, name in zip(lead[::-1], names[::-1]))
