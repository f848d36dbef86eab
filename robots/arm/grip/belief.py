"""The belief about what is between the fingers.

A discrete Bayes filter (Thrun, Burgard & Fox, Probabilistic Robotics, 2005, ch. 4.1). What is
there stays what it is: a part that fingers hold turned is turned in every picture, so that many
readings of one grasp do not make a stranger of it. It can change in two ways only: what is held
may turn, most of all when it is pushed, and whatever is there may get lost, which does not come
back by itself.
"""

import math
from collections.abc import Mapping
from enum import StrEnum


class Between(StrEnum):
    """What may be between the fingers."""

    STRAIGHT = "straight"
    """The right part, as it was to be grasped."""
    TURNED = "turned"
    """The right part, another way round or askew."""
    OTHER = "other"
    """Something else that is none of the rivals."""
    NOTHING = "nothing"


Hypothesis = Between | int
"""What may be there; a number is that of a rival, a known part that may be there in its stead."""

HELD = frozenset({Between.STRAIGHT, Between.TURNED})

_AT_FIRST: Mapping[Hypothesis, float] = {
    Between.STRAIGHT: 0.485,
    Between.TURNED: 0.015,
    Between.OTHER: 0.25,
    Between.NOTHING: 0.25,
}
"""Even odds that the part is held; of 100 held ones 3 are turned."""

_KNOWN_SHARE = 0.75
"""So often something else is one of the rivals, where there are any, each as often."""

_LOST_PER_S = 0.02
_TURNS_PER_S = 0.005
"""How often something held gets lost or turns, as the filter expects it."""

_TURNS_IF_PUSHED = 0.6
"""How often something held turns if it, or the hand, is pushed."""

_LEAST = math.exp(-7.0)
"""Readings of one grasp are not independent: however many agree, they leave so much doubt."""


class Belief:
    """Starts at even odds; `probability` is that of holding the part.

    Of `rivals` each is a hypothesis of its own: one that fits reading after reading is not held
    against by all those that do not.
    """

    def __init__(self, rivals: int = 0) -> None:
        self._shares: dict[Hypothesis, float] = {**_AT_FIRST}
        if rivals:
            other = self._shares[Between.OTHER]
            self._shares[Between.OTHER] = (1.0 - _KNOWN_SHARE) * other
            self._shares |= dict.fromkeys(range(rivals), _KNOWN_SHARE * other / rivals)

    @property
    def probability(self) -> float:
        return sum(self._shares[each] for each in HELD)

    def of(self, between: Between) -> float:
        """How likely it is that this is between the fingers."""
        return self._shares[between]

    def forget_rivals(self) -> None:
        """What is there now is no rival, or is of no interest: they are something else."""
        rivals = sum(share for each, share in self._all() if isinstance(each, int))
        self._shares = {each: self._shares[each] for each in Between}
        self._shares[Between.OTHER] += rivals

    def predict(self, elapsed_s: float) -> None:
        """Time has passed in which it may have been lost or have turned."""
        shares = {each: share * math.exp(-_LOST_PER_S * elapsed_s) for each, share in self._all()}
        shares[Between.NOTHING] += 1.0 - sum(shares.values())
        self._shares = shares
        self._turn(-math.expm1(-_TURNS_PER_S * elapsed_s))

    def push(self) -> None:
        """Something has pushed against what is held."""
        self._turn(_TURNS_IF_PUSHED)

    def _turn(self, share: float) -> None:
        turns = self._shares[Between.STRAIGHT] * share
        self._shares[Between.STRAIGHT] -= turns
        self._shares[Between.TURNED] += turns

    def update(self, log_likelihoods: Mapping[Hypothesis, float]) -> None:
        """Take a reading into account: log p(reading | what is there)."""
        most = max(log_likelihoods.values())
        shares = {
            each: share * math.exp(log_likelihoods[each] - most) for each, share in self._all()
        }
        total = sum(shares.values())
        shares = {each: max(share / total, _LEAST) for each, share in shares.items()}
        total = sum(shares.values())
        self._shares = {each: share / total for each, share in shares.items()}

    def _all(self) -> list[tuple[Hypothesis, float]]:
        return list(self._shares.items())
