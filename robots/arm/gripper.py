"""A gripper of two parallel fingers, as grasp planning and scene checks have to know it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

_STAGES = 4
"""A movement of the fingers is taken in so many stages, each as one room."""


@dataclass(frozen=True, slots=True)
class Slab:
    """A slice of a finger or of the palm, from `bottom_m` up. Lengths in metres.

    `bottom_m` is the height above the tips' ends; of a finger `thickness_m` is measured outward
    from its inner side along the opening direction, of the palm it is the whole extent. `width_m`
    is the whole extent across that direction.
    """

    bottom_m: float
    thickness_m: float
    width_m: float


@dataclass(frozen=True, slots=True)
class ToolBox:
    """An upright room around a tool that points down: all that is above `bottom_m`.

    Its middle is `along_m` from the tool point in the opening direction and `aside_m` across,
    where it has the extents `length_m` and `width_m`. `bottom_m` is a height above the tool point.
    """

    along_m: float
    aside_m: float
    bottom_m: float
    length_m: float
    width_m: float


@dataclass(frozen=True, slots=True)
class GripperModel:
    """Lengths in metres; the tool point is in the middle between the fingers.

    It takes parts and knobs from `min_width_m` to `max_width_m` wide and at least `min_height_m`
    high: smaller ones turn over or slip away between the closing fingers. Parts may be up to
    `max_length_m` long and, with their knobs, `max_height_m` high: held above the middle, larger
    ones swing far at the ends.

    Closed on something the fingers press with `grip_force_n`. Closed, the tips reach `tip_reach_m`
    below the tool point. The fingers stay parallel on links of `link_m` whose far joints lie
    `link_offset_m` outward, so that opening raises the tips; of fingers that slide, the links have
    length 0. A pad ends `pad_above_tip_m` above the tip; `overlap_m` of what is grasped has to be
    beside it. The top of what is grasped may be `deepest_m` above the tool point. `fingers` are
    slices of each finger, `palm` of what is above, both from below.
    """

    min_width_m: float
    max_width_m: float
    min_height_m: float
    max_length_m: float
    max_height_m: float
    max_opening_m: float
    max_mass_kg: float
    grip_force_n: float
    tip_reach_m: float
    pad_above_tip_m: float
    overlap_m: float
    deepest_m: float
    link_m: float
    link_offset_m: float
    fingers: Sequence[Slab]
    palm: Sequence[Slab]

    def reach_below_m(self, opening_m: float) -> float:
        """How far the tips reach below the tool point when they are so far apart."""
        if self.link_m == 0.0:
            return self.tip_reach_m
        radius_m = math.hypot(self.link_m, self.link_offset_m)
        aside_m = min(opening_m / 2 + self.link_offset_m, radius_m)
        return self.tip_reach_m - self.link_m + math.sqrt(radius_m**2 - aside_m**2)

    def boxes(self, opening_m: float) -> list[ToolBox]:
        """The room that fingers so far apart take, and the palm."""
        return [*self._fingers_between(opening_m, opening_m), *self._palm()]

    def swept_boxes(self, closed_m: float, opening_m: float) -> list[ToolBox]:
        """The room that fingers take while they close to `closed_m`, or open from it; the palm.

        Fingers on links come down as they close: onto what they pass over when they are open.
        """
        if closed_m >= opening_m:
            return self.boxes(opening_m)
        stages = pairwise(np.linspace(closed_m, opening_m, _STAGES + 1).tolist())
        fingers = [box for near, far in stages for box in self._fingers_between(near, far)]
        return [*fingers, *self._palm()]

    def _fingers_between(self, closed_m: float, opening_m: float) -> list[ToolBox]:
        """As low as they are at `closed_m`, as far out as at `opening_m`."""
        tip_m = -self.reach_below_m(closed_m)
        out_m = (opening_m - closed_m) / 2
        return [
            ToolBox(
                along_m=side * (closed_m + slab.thickness_m + out_m) / 2,
                aside_m=0.0,
                bottom_m=tip_m + slab.bottom_m,
                length_m=slab.thickness_m + out_m,
                width_m=slab.width_m,
            )
            for slab in self.fingers
            for side in (1.0, -1.0)
        ]

    def _palm(self) -> list[ToolBox]:
        palm_m = -self.tip_reach_m
        return [
            ToolBox(0.0, 0.0, palm_m + slab.bottom_m, slab.thickness_m, slab.width_m)
            for slab in self.palm
        ]
