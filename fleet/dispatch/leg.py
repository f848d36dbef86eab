"""Legs: what one robot is to do next, and how that may end."""

from enum import StrEnum

from mend.documents.strict_model import StrictModel
from mend.fleet.dispatch.setting import RobotName
from mend.fleet.requests import LegAction, Moment, PlaceName, Request, Text


class Leg(StrictModel):
    """A robot goes to a place and does something there for a request.

    `number` counts the legs of this robot. It is expected to begin at the place at `begins_s` and
    to be done at `done_s`; it may not begin before `not_before_s`, nor before `waits_for`, another
    robot, has given what is to be taken. `held_by`: in the basket of which robot, which works no
    more, is what is to be taken.
    """

    robot: str
    number: int
    action: LegAction
    place: str
    booking: str
    request: Request
    begins_s: float
    done_s: float
    not_before_s: float
    waits_for: str | None = None
    held_by: str | None = None

    def is_same(self, other: "Leg") -> bool:
        """Whether it is the same thing to do, whenever that is expected."""
        mine = (self.robot, self.number, self.action, self.place, self.booking)
        return mine == (other.robot, other.number, other.action, other.place, other.booking)


class LegOutcome(StrEnum):
    """How a leg ended."""

    DONE = "done"
    FAILED = "failed"
    ITEM_LOST = "item_lost"
    WITHDRAWN = "withdrawn"


class LegEnd(StrictModel):
    """How a leg ended, and why where it was not done; else what is known of what was done.

    `at`: where the robot is now; None: at the place of the leg.
    """

    outcome: LegOutcome
    reason: Text | None = None
    at: PlaceName | None = None


class Finding(StrEnum):
    """What a robot finds of a way, or of an elevator."""

    BLOCKED = "blocked"
    DOOR_CLOSED = "door_closed"
    ELEVATOR_DEAD = "elevator_dead"
    OPEN = "open"


class Found(StrictModel):
    """What was found between two neighbouring places, by whom, and until when it may last.

    Of an elevator they are two of its stops.
    """

    finding: Finding
    between: tuple[PlaceName, PlaceName]
    until_s: Moment | None = None
    by: RobotName | None = None
