"""The base class of results without a truth value."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar, NoReturn, cast

import numpy as np

from .errors import AmbiguousError

_VALUES = (bool, int, float, complex, str, bytes, np.generic, np.ndarray)


class Ambiguous:
    """A result whose truth value could mean several things, and raises, like that of a numpy array.

    A comparison with a plain value raises too: a verdict is neither True nor "violated". Two
    objects of one class are equal if their contents are.
    """

    __slots__ = ()
    __array_ufunc__ = None  # array == verdict calls the verdict's __eq__
    #: The attributes to use instead.
    _ask: ClassVar[str] = ""

    def __bool__(self) -> NoReturn:
        raise AmbiguousError(
            f"the truth value of {self._shown()} is ambiguous: ask for {self._ask}"
        )

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Ambiguous) and type(other) is type(self):
            return bool(self._content() == other._content())
        if isinstance(other, (*_VALUES, Ambiguous)):
            raise AmbiguousError(
                f"{self._shown()} is compared with {other!r}: compare {self._ask}"
            )
        return NotImplemented

    def __hash__(self) -> int:
        return hash(self._content())

    def _content(self) -> tuple[Any, ...]:
        """Returns the values to compare: for a dataclass all its fields."""
        return tuple(getattr(self, field.name) for field in fields(cast(Any, self)))

    def _shown(self) -> str:
        kind = type(self).__name__
        return f"an {kind}" if kind[0] in "AEIOU" else f"a {kind}"
