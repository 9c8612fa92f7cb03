"""Types that annotations share."""

from typing import Any

import numpy.typing as npt

#: An array of any type; the docstring says of which, and its shape.
Array = npt.NDArray[Any]
