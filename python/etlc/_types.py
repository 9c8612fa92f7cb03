"""Types that annotations share."""

from typing import Any

import numpy as np
import numpy.typing as npt

#: An array of any type; the docstring says of which, and its shape.
Array = npt.NDArray[Any]

#: numpy for calls whose types are incomplete in numpy 1.24.
untyped: Any = np


def extremes(numbers: Array) -> tuple[float, float]:
    """Returns the least and the greatest; zeros for an empty array."""
    return (untyped.min(numbers), untyped.max(numbers)) if numbers.size > 0 else (0.0, 0.0)
