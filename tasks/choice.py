"""The choice of an idle agent among the eligible leaves."""

import numpy as np
from numpy.typing import NDArray


def choose_leaf(
    leaves: NDArray[np.int64],
    attempts: NDArray[np.int64],
    potentials: NDArray[np.float64],
    able: NDArray[np.bool_],
) -> int | None:
    """The leaf with the fewest failed attempts, then the highest potential, then the first.

    The arrays are parallel and in tree order; `able` is False where the agent can never do the
    leaf. Returns None if it can do none.
    """
    if not able.all():
        leaves, attempts, potentials = leaves[able], attempts[able], potentials[able]
    if leaves.size == 0:
        return None
    promising = np.where(attempts == attempts.min(), potentials, -np.inf)
    return int(leaves[promising.argmax()])
