"""Which of several equal parts is which: names stay with what was last seen under them."""

from collections.abc import Mapping
from types import MappingProxyType

Spot = tuple[float, float]
"""A place in the plane of the base frame, metres."""


class LastSeen:
    """Where each part was last, by name.

    A part that is not seen keeps its place: it may be hidden, or gone, and what is put back
    elsewhere is then the one that is left over.
    """

    def __init__(self, starts: Mapping[str, Spot]) -> None:
        """`starts`: where the parts are said to start."""
        self._spots = dict(starts)

    @property
    def spots(self) -> Mapping[str, Spot]:
        return MappingProxyType(self._spots)

    def note(self, name: str, x: float, y: float) -> None:
        """A part was seen, or let go, at a place."""
        self._spots[name] = (x, y)
