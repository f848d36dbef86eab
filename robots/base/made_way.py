"""What a base was told to do about another robot that it has met."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MadeWay:
    """It drives along `way`, points on the floor at height `z`, and waits at the last `until_s`.

    Without a way it is the other one that makes way. In the base's frame, and of its clock.
    """

    way: Sequence[tuple[float, float]]
    z: float
    until_s: float
