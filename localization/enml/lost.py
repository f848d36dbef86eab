"""How well the map explains what is seen from a pose, and how lost the robot therefore is."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.problem import Floats

_AT_WALL_M = 0.15
_BEHIND_WALL_M = 0.4
_BEHIND_COUNTS = 3.0
"""Right poses see a few percent of their returns behind walls that are gone, wrong ones a third."""
_CONTRADICTION_COUNTS = 6.0
_USUALLY_BEHIND = 0.02
"""The share of returns from behind walls that is nothing unusual at a right pose."""
_BEFORE_COUNTS = 0.05
"""What stands in front of a wall, or where the map is empty, may be furniture or a wall that nobody
mapped: it hardly speaks against a pose."""


@dataclass(frozen=True, slots=True)
class MapFit:
    """How many returns lie on what the map shows, behind it, and before it or where it is empty.

    A return from behind a wall of the map is what a right pose never has, unless the wall is gone.
    """

    on_map: float = 0.0
    behind: float = 0.0
    before: float = 0.0

    @property
    def returns(self) -> float:
        return self.on_map + self.behind + self.before

    @property
    def contradiction(self) -> float:
        """From 0 to 1, by what cannot be seen from where the map explains the rest.

        What is seen where the map is empty says nothing against a pose here.
        """
        against = _CONTRADICTION_COUNTS * max(self.behind - _USUALLY_BEHIND * self.returns, 0.0)
        total = against + self.on_map
        return against / total if total > 0.0 else 0.0

    @property
    def lost(self) -> float:
        """From 0 (the map explains all returns) to 1 (none)."""
        against = _BEHIND_COUNTS * self.behind + _BEFORE_COUNTS * self.before
        total = against + self.on_map
        return against / total if total > 0.0 else 1.0

    def faded(self, share: float, newer: "MapFit") -> "MapFit":
        """This evidence at a share of its weight, and newer evidence at its full weight."""
        return MapFit(
            share * self.on_map + newer.on_map,
            share * self.behind + newer.behind,
            share * self.before + newer.before,
        )


def evidence(measured_m: Floats, expected_m: Floats, is_ltf: NDArray[np.bool_]) -> MapFit:
    """Weigh the returns of one scan against what the map foretells along the same bearings."""
    on_map = is_ltf | (np.abs(measured_m - expected_m) < _AT_WALL_M)
    behind = ~on_map & (measured_m > expected_m + _BEHIND_WALL_M)
    return MapFit(
        float(on_map.sum()), float(behind.sum()), float(len(on_map) - on_map.sum() - behind.sum())
    )


def evidence_of(node: PoseNode) -> MapFit:
    """The evidence of a pose of the episode, at the pose where it was classified."""
    return evidence(node.ranges_m, node.expected_m, node.is_ltf)
