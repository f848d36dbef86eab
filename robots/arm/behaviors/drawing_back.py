"""Drawing back from what the fingers have lost, with an eye on the table.

People reach in as soon as they hear of it. Only what was seen before tells what they have done
from what the robot itself has made of it.
"""

import itertools
from collections.abc import Sequence

from mend.robots.arm.arm import Arm
from mend.robots.arm.perception import Perception
from mend.robots.catalogue import Part
from mend.robots.execution.routine import Routine
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.presence import Presence
from mend.robots.vision.table_view import TableView

_AT_REST_S = 0.5
"""What falls from the fingers has come to rest after that, and nobody has reached in before."""
_PERIOD_S = 0.2
_MOST_VIEWS = 10


class DrawnBack:
    """What the head camera saw of the table, past the arm, while that drew back from a part."""

    def __init__(self, part: Part, perception: Perception, lost_s: float) -> None:
        """`lost_s`: when the fingers were found to have lost it, by the body's clock."""
        self._part, self._head = part, perception.head
        self._next_s = lost_s + _AT_REST_S
        self._views: list[TableView] = []

    def during(self, motion: Routine[None], arm: Arm) -> Routine[None]:
        """A motion of the arm in which the head camera looks now and then."""
        for _ in motion:
            yield
            if arm.body.time_s() >= self._next_s and len(self._views) < _MOST_VIEWS:
                self._next_s = arm.body.time_s() + _PERIOD_S
                self._look()

    def brought_to(self, now: HeadSighting) -> bool | None:
        """Whether the part was seen not to be where it is now; None if that was not seen.

        One noisy picture says nothing: it takes two, one after the other. That it was there all the
        time only the first view can tell: by the next ones somebody may have brought it.
        """
        verdicts = [self._head.stood_at(view, self._part, now) for view in self._views]
        if _twice_on_end(verdicts, Presence.GONE):
            return True
        return False if verdicts[:1] == [Presence.THERE] else None

    def _look(self) -> None:
        self._head.doubt()
        view = self._head.understand(self._head.look())
        if view is not None:
            self._views.append(view)


def _twice_on_end(verdicts: Sequence[Presence], wanted: Presence) -> bool:
    pairs = itertools.pairwise(verdicts)
    return any(one is wanted and other is wanted for one, other in pairs)
