"""Of which colours the picture is where a held part must be seen, and how likely that is.

The shares of the part's own colour, of other parts' colours and of none follow mixtures of
Dirichlet distributions, one for each thing that may be between the fingers. A picture is one
reading, however many pixels it has: its pixels share light, focus and pose.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

_LEAST_SHARE = 0.02
"""Shares nearer to 0 say no more: a rim or a reflection always remains."""


@dataclass(frozen=True, slots=True)
class Composition:
    """Shares of the `pixels` looked at: the part's own colour, other parts', the rest.

    `most_other` is the part whose colour most of the others have.
    """

    pixels: int
    own: float
    other: float
    most_other: str | None

    @property
    def rest(self) -> float:
        return max(0.0, 1.0 - self.own - self.other)


@dataclass(frozen=True, slots=True)
class _Component:
    weight: float
    own: float
    other: float
    rest: float
    log_norm: float = field(init=False)
    """Of its density, which is asked for in every reading of a hand."""

    def __post_init__(self) -> None:
        alphas = (self.own, self.other, self.rest)
        log_norm = math.lgamma(sum(alphas)) - sum(math.lgamma(each) for each in alphas)
        object.__setattr__(self, "log_norm", log_norm)


_COMPONENTS: Mapping[str, Sequence[_Component]] = {
    # Seen well; in light in which its colour is hardly known; anything.
    "right": (
        _Component(0.90, 6.0, 0.4, 1.5),
        _Component(0.08, 0.5, 0.3, 5.0),
        _Component(0.02, 1.0, 1.0, 1.0),
    ),
    # A known part; one of the same colours; something that nobody knows.
    "other": (
        _Component(0.60, 0.4, 6.0, 1.5),
        _Component(0.15, 6.0, 0.4, 1.5),
        _Component(0.25, 0.4, 0.4, 5.0),
    ),
    # Table and fingers; things below, of any colour.
    "nothing": (
        _Component(0.75, 0.3, 0.3, 6.0),
        _Component(0.25, 1.0, 1.0, 1.0),
    ),
}


def log_density(composition: Composition, what: str) -> float:
    """The log density of the shares if `right`, `other` or `nothing` is between the fingers."""
    shares = [max(each, _LEAST_SHARE) for each in (composition.own, composition.other)]
    shares.append(max(composition.rest, _LEAST_SHARE))
    whole = sum(shares)
    own, other, rest = (math.log(each / whole) for each in shares)
    density = 0.0
    for each in _COMPONENTS[what]:
        exponent = (each.own - 1.0) * own + (each.other - 1.0) * other + (each.rest - 1.0) * rest
        density += each.weight * math.exp(each.log_norm + exponent)
    return math.log(density)


def likeliest(composition: Composition) -> str:
    """What is most likely between the fingers: `right`, `other` or `nothing`."""
    return max(_COMPONENTS, key=lambda what: log_density(composition, what))
