"""Types that annotations share."""

from typing import Any

import numpy as np
import numpy.typing as npt

#: An array of any type; the docstring says of which, and its shape.
Array = npt.NDArray[Any]

#: numpy for calls whose types are incomplete in numpy 1.24.
untyped: Any = np
