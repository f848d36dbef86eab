"""Random numbers inside the kernels: xorshift with its state in an array of one number."""

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.compiled import compiled

Dice = NDArray[np.uint64]


def dice_from(generator: np.random.Generator) -> Dice:
    """Dice whose throws the generator decides."""
    return generator.integers(1, 2**63, size=1, dtype=np.uint64)


@compiled
def throw(dice: Dice) -> float:
    """A number from 0 (included) to 1 (excluded)."""
    bits = dice[0]
    bits ^= bits << np.uint64(13)
    bits ^= bits >> np.uint64(7)
    bits ^= bits << np.uint64(17)
    dice[0] = bits
    return float(bits >> np.uint64(11)) / 9007199254740992.0


@compiled
def one_of(dice: Dice, count: int) -> int:
    """A whole number from 0 (included) to `count` (excluded)."""
    return min(int(throw(dice) * count), count - 1)


@compiled
def shuffle(dice: Dice, numbers: NDArray[np.int64], count: int) -> None:
    """Bring the first `count` numbers into a random order, in place."""
    for last in range(count - 1, 0, -1):
        other = one_of(dice, last + 1)
        numbers[last], numbers[other] = numbers[other], numbers[last]
