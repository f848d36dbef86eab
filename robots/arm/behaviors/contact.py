"""Contact: felt as a force that lasts, met by backing off and by gentler tries.

A force is noticed by a one-sided CUSUM test (Page, "Continuous inspection schemes", Biometrika 41,
1954): what is above the limit adds up over time, what is below takes away. Moving freely the PR2
feels at most 3 N, and 8 N with the heaviest part that it lifts (200 motions; noise of the efforts,
what the part weighs, its inertia): the gentlest limit is above that.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.body import ToolPose

_LASTING_N_S = 0.3
"""A force is a contact once this much above the limit has added up: 15 N more for 20 ms."""

_BACK_M = 0.10
"""So far the tool point goes back the way it came."""
_TRACK_STEP_M = 0.01

GUARD_M = 0.008
"""What is met so near above the end of a way straight down is what was to be come down on."""
_ASIDE_M = 0.01


@dataclass(frozen=True, slots=True)
class Try:
    """How hard the arm may push, and how fast it goes (a share of the step's own speed)."""

    limit_n: float
    speed: float


@dataclass(frozen=True, slots=True)
class Contact:
    """What was felt in the last of so many tries."""

    force_n: float
    tries: int


class ContactWatch:
    """Feels one motion: whether something pushes harder than a limit, and lastingly."""

    def __init__(self, limit_n: float) -> None:
        self._limit_n = limit_n
        self._sum_n_s = 0.0
        self.strongest_n = 0.0

    def feel(self, force_n: float, period_s: float) -> bool:
        """Take one reading; whether the forces so far are a contact."""
        self._sum_n_s = max(0.0, self._sum_n_s + (force_n - self._limit_n) * period_s)
        self.strongest_n = max(self.strongest_n, force_n)
        return self._sum_n_s > _LASTING_N_S


def hindering_n(force: NDArray[np.float64], here: ToolPose, to: ToolPose) -> float:
    """How strong a force (3, N) is but for what helps along the way from here to a pose.

    A part that fingers have closed on is pressed down a little; the table then helps to lift it.
    """
    way = np.array([to.x - here.x, to.y - here.y, to.z - here.z])
    length_m = float(np.linalg.norm(way))
    if length_m > 0.0:
        along = way / length_m
        force = force - max(0.0, float(force @ along)) * along
    return float(np.linalg.norm(force))


class Track:
    """Where the tool point has come along, so that it can go back the same way."""

    def __init__(self) -> None:
        self._poses: list[ToolPose] = []

    def note(self, pose: ToolPose | None) -> None:
        """The tool is here now; None while it does not point down."""
        if pose is None:
            self._poses.clear()
        elif not self._poses or distance_m(pose, self._poses[-1]) >= _TRACK_STEP_M:
            self._poses.append(pose)

    def way_back(self) -> Sequence[ToolPose]:
        """The poses passed last, the latest first, up to where there is room enough."""
        back: list[ToolPose] = []
        for pose in reversed(self._poses):
            back.append(pose)
            if distance_m(pose, self._poses[-1]) >= _BACK_M:
                break
        # Where it is now is no way back.
        return back[1:]


def is_arrival(here: ToolPose, to: ToolPose) -> bool:
    """Whether a contact here on the way straight down to a pose is with what is to be met there."""
    aside_m = distance_m(ToolPose(here.x, here.y, to.z, to.yaw), to)
    return aside_m <= _ASIDE_M and -GUARD_M <= here.z - to.z <= GUARD_M


def distance_m(one: ToolPose, other: ToolPose) -> float:
    """Between two tool points."""
    apart = (one.x - other.x) ** 2 + (one.y - other.y) ** 2 + (one.z - other.z) ** 2
    return float(apart**0.5)
