"""Whether a base passes ways that were closed: only who has passed one knows that it is open."""

from mend.robots.base.base import Base
from mend.robots.base.closed_ways import Lane

_AT_END_M = 0.6
"""Who is so near to the end of a lane is there; of a short one it is a third."""


class Passing:
    """Follows where on closed ways a base is."""

    def __init__(self, base: Base) -> None:
        self._base = base
        self._entered: dict[Lane, str] = {}

    def passed(self) -> list[tuple[str, str]]:
        """The closed ways that it has just passed, each from where to where."""
        base, now_s = self._base, self._base.body.time_s()
        doubtful = base.closed.doubtful(now_s)
        passed = []
        for lane, origin in doubtful.items():
            reached = self._reached(lane, origin)
            if reached is not None:
                base.closed.passed(lane)
                passed.append((self._entered.pop(lane), reached))
        return passed

    def _reached(self, lane: Lane, origin: str | None) -> str | None:
        """The far end of a lane that it has come to the end of."""
        ends_m = self._base.ways.along(lane, self._base.body.pose())
        if ends_m is None:
            self._entered.pop(lane, None)
            return None
        at_end_m = min(_AT_END_M, sum(ends_m.values()) / 3.0)
        at = next((end for end, away_m in ends_m.items() if away_m <= at_end_m), None)
        entered = self._entered.get(lane, at or origin)
        if entered is not None:
            self._entered[lane] = entered
        return None if at == entered else at
