"""Arrays of records: one argument of a kernel in place of an array for each of their fields."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Records = np.recarray[Any, Any]
Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]


def records(shape: int | tuple[int, ...], whole: str = "", real: str = "") -> Records:
    """Records of zeros, with these fields of whole and of real numbers."""
    kinds = [(name, np.int64) for name in whole.split()] + [
        (name, np.float64) for name in real.split()
    ]
    return np.zeros(shape, np.dtype(kinds)).view(np.recarray)
