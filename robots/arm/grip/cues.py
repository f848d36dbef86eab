"""How likely each reading of the hand is, by what is between the fingers.

Each likelihood is the product over the cues, which say nothing about one another once it is known
what is there.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mend.robots.arm.grasp import Grasp
from mend.robots.arm.grip.belief import Between, Hypothesis
from mend.robots.arm.grip.composition import Composition, log_density
from mend.robots.arm.grip.rivals import RivalReading
from mend.robots.arm.gripper import GripperModel


@dataclass(frozen=True, slots=True)
class HandReading:
    """What the hand's sensors say at one moment; the composition is None where it cannot tell.

    `presses`: the fingers press on something; `pushed`: something has pushed against the arm.
    `rivals` are the known parts that somebody may have put there in its stead.
    """

    opening_m: float
    presses: bool
    composition: Composition | None
    pushed: bool = False
    rivals: Sequence[RivalReading] = ()


@dataclass(frozen=True, slots=True)
class CueModel:
    """How the cues scatter.

    The opening of fingers on the right part is normal around its width, with the encoder's noise
    and `grasp_sd_m`, what pads and parts give way. A part that is turned between them either lies
    the other way round or is jammed askew: flat fingers turn it straight unless the line between
    the two corners that they touch is within the angle of their `friction`, or something pushed.
    Fingers that closed on nothing are apart by the noise alone, in `moving_share` of the cases they
    are still on their way.
    """

    encoder_sd_m: float = 0.0003
    grasp_sd_m: float = 0.0015
    friction: float = 1.0
    closed_sd_m: float = 0.001
    moving_share: float = 0.4
    impossible_per_m: float = 1e-3
    presses_on_something: float = 0.9999
    presses_on_nothing: float = 0.3

    def log_likelihoods(
        self, reading: HandReading, grasp: Grasp, gripper: GripperModel
    ) -> Mapping[Hypothesis, float]:
        """log p(reading | what is between the fingers), for everything that may be there."""
        opening_m, seen = reading.opening_m, reading.composition
        on_something = self._log_pressing(reading.presses, self.presses_on_something)
        on_nothing = self._log_pressing(reading.presses, self.presses_on_nothing)
        right = on_something + _log_looks(seen, "right")
        rivals: dict[Hypothesis, float] = {
            number: on_something + self._log_rival(opening_m, each, grasp)
            for number, each in enumerate(reading.rivals)
        }
        return {
            **rivals,
            Between.STRAIGHT: right + math.log(self._opening_on(opening_m, grasp.width_m)),
            Between.TURNED: right
            + math.log(self._opening_on_turned(opening_m, grasp, gripper, pushed=reading.pushed)),
            Between.OTHER: on_something
            + _log_looks(seen, "other")
            + math.log(self._opening_on_other(opening_m, gripper, pushed=reading.pushed)),
            Between.NOTHING: on_nothing
            + _log_looks(seen, "nothing")
            + math.log(self._opening_on_nothing(opening_m, gripper)),
        }

    def _opening_on(self, opening_m: float, width_m: float) -> float:
        """Density per metre."""
        return _normal(opening_m - width_m, self._sd_m) + self.impossible_per_m

    def _opening_on_turned(
        self, opening_m: float, grasp: Grasp, gripper: GripperModel, *, pushed: bool
    ) -> float:
        if pushed:
            return self._opening_on_other(opening_m, gripper, pushed=True)
        jammed_m = grasp.diagonal_m / math.hypot(1.0, self.friction)
        askew = self._opening_within(opening_m, jammed_m, grasp.diagonal_m)
        other_way_round = _normal(opening_m - grasp.across_m, self._sd_m)
        return 0.5 * (askew + other_way_round)

    def _opening_within(self, opening_m: float, least_m: float, most_m: float) -> float:
        """Evenly between these, but for the scatter at both ends."""
        least_m, most_m = least_m - 2 * self._sd_m, most_m + 2 * self._sd_m
        inside = least_m <= opening_m <= most_m
        return (1.0 / (most_m - least_m) if inside else 0.0) + self.impossible_per_m

    def _opening_on_nothing(self, opening_m: float, gripper: GripperModel) -> float:
        sd_m = math.hypot(self.encoder_sd_m, self.closed_sd_m)
        closed = 2.0 * _normal(opening_m, sd_m)
        return (1.0 - self.moving_share) * closed + self.moving_share / gripper.max_opening_m

    def _log_rival(self, opening_m: float, rival: RivalReading, grasp: Grasp) -> float:
        """Of opening and looks if that is held."""
        return rival.log_looks + math.log(self._opening_on(opening_m, self._felt_m(rival, grasp)))

    def _felt_m(self, rival: RivalReading, grasp: Grasp) -> float:
        """A rival's width; the part's own where neither looks nor fingers tell the two."""
        told_apart = not rival.alike or abs(rival.width_m - grasp.width_m) > 2 * self._sd_m
        return rival.width_m if told_apart else grasp.width_m

    def _opening_on_other(self, opening_m: float, gripper: GripperModel, *, pushed: bool) -> float:
        # What is pushed they may have by a corner, narrower than any of its sides.
        least_m = 0.0 if pushed else gripper.min_width_m
        return self._opening_within(opening_m, least_m, gripper.max_opening_m)

    def _log_pressing(self, presses: bool, share: float) -> float:
        return math.log(share if presses else 1.0 - share)

    @property
    def _sd_m(self) -> float:
        return math.hypot(self.encoder_sd_m, self.grasp_sd_m)


def _log_looks(composition: Composition | None, what: str) -> float:
    return 0.0 if composition is None else log_density(composition, what)


def _normal(offset: float, sd: float) -> float:
    return math.exp(-0.5 * (offset / sd) ** 2) / (sd * math.sqrt(2 * math.pi))
