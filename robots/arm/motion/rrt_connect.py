"""Ways around things in joint space: RRT-Connect, then shortcuts.

Kuffner & LaValle, "RRT-Connect: an efficient approach to single-query path planning", ICRA 2000;
shortcuts as in Geraerts & Overmars, "Creating high-quality paths for motion planning", IJRR 2007.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mend.robots.arm.motion.kinematics import Joints

_STEP_RAD = 0.3
"""How far a tree grows at once, by the joint that moves furthest."""
_CHECK_RAD = 0.06
_GROWTHS = 600
_AROUND_RAD = 1.0
"""So far beyond both ends joints may go."""
_SHORTCUTS = 40

IsFree = Callable[[Joints], bool]


@dataclass(slots=True)
class _Tree:
    """Postures that are reached from the first one, and from which each was."""

    postures: list[Joints]
    parents: list[int]

    @classmethod
    def from_root(cls, root: Joints) -> "_Tree":
        return cls([root], [0])

    def nearest(self, to: Joints) -> int:
        return int(np.abs(np.array(self.postures) - to).max(axis=1).argmin())

    def grow(self, towards: Joints, is_free: IsFree) -> tuple[int, bool] | None:
        """One step; the new posture's number and whether it is there. None if it is not free."""
        at = self.nearest(towards)
        here = self.postures[at]
        away = float(np.abs(towards - here).max())
        arrives = away <= _STEP_RAD
        there = towards if arrives else here + (towards - here) * (_STEP_RAD / away)
        if not _is_edge_free(here, there, is_free):
            return None
        self.postures.append(there)
        self.parents.append(at)
        return len(self.postures) - 1, arrives

    def grow_all_the_way(self, towards: Joints, is_free: IsFree) -> int | None:
        """Steps until it is there: the number of that posture; None if something is on the way."""
        while (grown := self.grow(towards, is_free)) is not None:
            number, arrives = grown
            if arrives:
                return number
        return None

    def way_to(self, number: int) -> list[Joints]:
        """From the root to a posture."""
        way = [self.postures[number]]
        while number != 0:
            number = self.parents[number]
            way.append(self.postures[number])
        return way[::-1]


def connect(
    start: Joints,
    goal: Joints,
    lower: Joints,
    upper: Joints,
    is_free: IsFree,
    rng: np.random.Generator,
) -> list[Joints] | None:
    """Postures (rad) from start to goal with free straight ways between them; None if not found.

    `lower` and `upper` are the joints' limits.
    """
    if not (is_free(start) and is_free(goal)):
        return None
    low = np.maximum(np.minimum(start, goal) - _AROUND_RAD, lower)
    high = np.minimum(np.maximum(start, goal) + _AROUND_RAD, upper)
    ours, other = _Tree.from_root(start), _Tree.from_root(goal)
    for growth in range(_GROWTHS):
        towards = goal if growth == 0 else rng.uniform(low, high)
        grown = ours.grow(towards, is_free)
        if grown is not None:
            met = other.grow_all_the_way(ours.postures[grown[0]], is_free)
            if met is not None:
                way = [*ours.way_to(grown[0]), *other.way_to(met)[-2::-1]]
                return _shortened(way if way[0] is start else way[::-1], is_free, rng)
        ours, other = other, ours
    return None


def _shortened(way: list[Joints], is_free: IsFree, rng: np.random.Generator) -> list[Joints]:
    for _ in range(_SHORTCUTS):
        if len(way) < 3:
            break
        first, last = sorted(int(each) for each in rng.integers(0, len(way), 2))
        if last - first >= 2 and _is_edge_free(way[first], way[last], is_free):
            way = [*way[: first + 1], *way[last:]]
    return way


def _is_edge_free(start: Joints, end: Joints, is_free: IsFree) -> bool:
    """Whether all is free on the straight way, but for its start, which was looked at before."""
    count = max(1, round(float(np.abs(end - start).max()) / _CHECK_RAD))
    return all(is_free(start + (end - start) * (step / count)) for step in range(1, count + 1))
