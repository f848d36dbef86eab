"""Rows of several arrays in one, which is made anew only where they are others."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


class StackedRows:
    """By name: segments (n, 4) of several arrays. What was given is not to be written to."""

    def __init__(self) -> None:
        self._made: dict[str, tuple[Sequence[Matrix], Matrix]] = {}

    def of(self, name: str, parts: Sequence[Matrix]) -> Matrix:
        """All of them; the same array as the time before where each is the same as then."""
        given, made = self._made.get(name, ((), None))
        if (
            made is None
            or len(given) != len(parts)
            or any(a is not b for a, b in zip(given, parts, strict=True))
        ):
            made = np.vstack([np.zeros((0, 4)), *parts])
            self._made[name] = parts, made
        return made
