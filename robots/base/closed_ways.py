"""Ways that a base keeps off while it believes that nobody gets through."""

from collections.abc import Mapping

Lane = frozenset[str]
"""Two neighbouring places, by their names on the map."""
Closed = Mapping[Lane, str | None]
"""What is closed, with the place from which it was found so; None where that is not known."""

NO_WAYS: Closed = {}

KEPT_S = 1800.0
"""So long a base remembers what it has found itself."""


class ClosedWays:
    """What one base was told of ways, and what it has found itself.

    Its own finding comes before what it was told, until it is told something new of that way.
    """

    def __init__(self) -> None:
        self._told: dict[Lane, float] = {}
        self._barred: dict[Lane, tuple[str, float]] = {}
        self._free: dict[Lane, str | None] = {}
        self._passed: set[Lane] = set()

    def tell(self, told: Mapping[Lane, float]) -> None:
        """These are closed, each until a time of its clock, and what was told before is not."""
        for anew in told.keys() - self._told.keys():
            self._free.pop(anew, None)
            self._passed.discard(anew)
        for opened in self._told.keys() - told.keys():
            self._barred.pop(opened, None)
        self._told = dict(told)

    def bar(self, lane: Lane, origin: str, now_s: float) -> None:
        """It is barred, as was seen from one of its places."""
        self._free.pop(lane, None)
        self._passed.discard(lane)
        self._barred[lane] = origin, now_s + KEPT_S

    def free(self, lane: Lane) -> None:
        """It is seen to be free, from where it was found to be barred."""
        origin, _ = self._barred.pop(lane, (None, 0.0))
        self._free[lane] = origin

    def passed(self, lane: Lane) -> None:
        """It has been passed."""
        self._barred.pop(lane, None)
        self._free.pop(lane, None)
        self._passed.add(lane)

    def doubtful(self, now_s: float) -> Closed:
        """What may be closed, and has not been passed since."""
        return {
            lane: origin
            for lane, origin in {
                **self._told_at(now_s),
                **self._free,
                **self._barred_at(now_s),
            }.items()
            if lane not in self._passed
        }

    def at(self, now_s: float) -> Closed:
        """What counts as closed at a time."""
        told = self._told_at(now_s)
        seen_open = self._free.keys() | self._passed
        still = {lane: origin for lane, origin in told.items() if lane not in seen_open}
        return {**still, **self._barred_at(now_s)}

    def _told_at(self, now_s: float) -> Closed:
        return {lane: None for lane, until_s in self._told.items() if until_s > now_s}

    def _barred_at(self, now_s: float) -> Closed:
        return {lane: origin for lane, (origin, until) in self._barred.items() if until > now_s}
