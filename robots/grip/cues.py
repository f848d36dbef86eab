"""How likely each reading of the hand is, by what is between the fingers.

What the fingers do not hold rightly is one of two things: nothing, or something else. The ratio of
likelihoods is that of the right part to an even mixture of both, each the product over the cues,
which say nothing about one another once it is known what is there.
"""

import math
from dataclasses import dataclass

from robots.grip.composition import Composition, log_density
from robots.gripper import GripperModel

_EVEN = 0.5


@dataclass(frozen=True, slots=True)
class HandReading:
    """What the hand's sensors say at one moment; the composition is None where it cannot tell."""

    opening_m: float
    presses: bool
    composition: Composition | None


@dataclass(frozen=True, slots=True)
class CueModel:
    """How the cues scatter.

    The opening of fingers on the right part is normal around its width, with the encoder's noise
    and `grasp_sd_m`, what pads and parts give way; in `turned_share` of all grasps the part is
    turned between them, which makes it up to `turned_m` wider. Fingers that closed on nothing are
    apart by the noise alone, in `moving_share` of the cases they are still on their way.
    """

    encoder_sd_m: float = 0.0003
    grasp_sd_m: float = 0.0015
    turned_share: float = 0.03
    turned_m: float = 0.022
    closed_sd_m: float = 0.001
    moving_share: float = 0.4
    impossible_per_m: float = 1e-3
    presses_on_something: float = 0.9999
    presses_on_nothing: float = 0.3

    def log_ratio(self, reading: HandReading, width_m: float, gripper: GripperModel) -> float:
        """log p(reading | the right part, `width_m` wide) - log p(reading | anything else)."""
        held = (
            math.log(self._opening_on(reading.opening_m, width_m))
            + self._log_pressing(reading.presses, self.presses_on_something)
            + _log_looks(reading.composition, "right")
        )
        empty = (
            math.log(self._opening_on_nothing(reading.opening_m, gripper))
            + self._log_pressing(reading.presses, self.presses_on_nothing)
            + _log_looks(reading.composition, "nothing")
        )
        other = (
            math.log(self._opening_on_other(reading.opening_m, gripper))
            + self._log_pressing(reading.presses, self.presses_on_something)
            + _log_looks(reading.composition, "other")
        )
        most = max(empty, other)
        mixture = _EVEN * (math.exp(empty - most) + math.exp(other - most))
        return held - most - math.log(mixture)

    def _opening_on(self, opening_m: float, width_m: float) -> float:
        """Density per metre."""
        sd_m = math.hypot(self.encoder_sd_m, self.grasp_sd_m)
        straight = _normal(opening_m - width_m, sd_m)
        may_be_turned = -2 * sd_m <= opening_m - width_m <= self.turned_m
        turned = 1.0 / (self.turned_m + 2 * sd_m) if may_be_turned else 0.0
        share = self.turned_share
        return (1.0 - share) * straight + share * turned + self.impossible_per_m

    def _opening_on_nothing(self, opening_m: float, gripper: GripperModel) -> float:
        sd_m = math.hypot(self.encoder_sd_m, self.closed_sd_m)
        closed = 2.0 * _normal(opening_m, sd_m)
        return (1.0 - self.moving_share) * closed + self.moving_share / gripper.max_opening_m

    def _opening_on_other(self, opening_m: float, gripper: GripperModel) -> float:
        fits = gripper.min_width_m <= opening_m <= gripper.max_opening_m
        spread_m = gripper.max_opening_m - gripper.min_width_m
        return (1.0 / spread_m if fits else 0.0) + self.impossible_per_m

    def _log_pressing(self, presses: bool, share: float) -> float:
        return math.log(share if presses else 1.0 - share)


def _log_looks(composition: Composition | None, what: str) -> float:
    return 0.0 if composition is None else log_density(composition, what)


def _normal(offset: float, sd: float) -> float:
    return math.exp(-0.5 * (offset / sd) ** 2) / (sd * math.sqrt(2 * math.pi))
