"""What earlier pictures say of the parts: where each was last, and how it stood when seen whole."""

import math
from collections.abc import Mapping
from types import MappingProxyType

from mend.robots.link.messages import Location
from mend.robots.vision.head import HeadSighting

_MOVED_M = 0.02

Spot = tuple[float, float, float]
"""Where a part's bottom centre is, in the base frame, metres."""


class LastSeen:
    """Where each part was last, by name; of equal parts names stay with what was seen under them.

    A part that is not seen keeps its place: it may be hidden, or gone, and what is put back
    elsewhere is then the one that is left over. What is half hidden most likely stands as it did
    when it was last seen whole.
    """

    def __init__(self, starts: Mapping[str, Spot] | None = None) -> None:
        """`starts`: where the parts are said to start."""
        self._spots = dict(starts or {})
        self._whole: dict[str, Location] = {}
        self._stood: dict[str, Location] = {}

    @property
    def spots(self) -> Mapping[str, Spot]:
        return MappingProxyType(self._spots)

    def nearer(self, names: tuple[str, str], to: Spot) -> str:
        """Which of two parts was last nearer to a place."""

        def distance_m(name: str) -> float:
            spot = self._spots.get(name)
            return math.inf if spot is None else math.dist(spot, to)

        return min(names, key=distance_m)

    def seen_whole(self, name: str) -> Location | None:
        """How a part stood when it was last seen whole, unless it was moved since."""
        return self._whole.get(name)

    def seen_standing(self, name: str) -> Location | None:
        """How a part stood when it was last seen, whole or not, unless it was moved since."""
        return self._stood.get(name)

    def note_sighting(self, name: str, seen: HeadSighting) -> None:
        """A part was seen."""
        self.note(name, (seen.x, seen.y, seen.z))
        if seen.toppled:
            self._stood.pop(name, None)
            return
        self._stood[name] = Location(x=seen.x, y=seen.y, z=seen.z, yaw=seen.yaw)
        if seen.complete:
            self._whole[name] = self._stood[name]

    def note_gone(self, name: str) -> None:
        """A part was seen not to be where it stood any more."""
        self._whole.pop(name, None)
        self._stood.pop(name, None)

    def note(self, name: str, at: Spot) -> None:
        """A part was at a place, or was let go there."""
        self._spots[name] = at
        for known in (self._whole, self._stood):
            stood = known.get(name)
            if stood is not None and math.hypot(stood.x - at[0], stood.y - at[1]) > _MOVED_M:
                del known[name]
