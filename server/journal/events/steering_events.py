"""Events of people who steer a run, and of the run that waits for them."""

from typing import Literal

from mend.server.journal.events.event import Author, Event, NodeEvent
from mend.tasks.autonomy import AutonomyLevel


class SteeringEvent(NodeEvent):
    """What somebody said of a node: `by` whom, and why (`reason`) as far as they said so."""

    by: str
    reason: str = ""
    author: Author | None = None


class BreakpointSet(SteeringEvent):
    """Agents wait before a leaf, or before the first one under a goal node."""

    type: Literal["breakpoint_set"] = "breakpoint_set"


class BreakpointRemoved(SteeringEvent):
    """They wait there no longer."""

    type: Literal["breakpoint_removed"] = "breakpoint_removed"


class LeafLetGo(SteeringEvent):
    """A leaf begins once, whatever holds it."""

    type: Literal["leaf_let_go"] = "leaf_let_go"


class LeafPreferred(SteeringEvent):
    """A leaf is to be begun before all others whose turn has come."""

    type: Literal["leaf_preferred"] = "leaf_preferred"


class LeafNotPreferred(SteeringEvent):
    """It is chosen as ever after all."""

    type: Literal["leaf_not_preferred"] = "leaf_not_preferred"


class LeafTriedAgain(SteeringEvent):
    """A leaf that failed, was left out or given up is to be done as if it were new."""

    type: Literal["leaf_tried_again"] = "leaf_tried_again"


class AutonomySet(Event):
    """How much the robots may do from now on without being asked."""

    type: Literal["autonomy_set"] = "autonomy_set"
    level: AutonomyLevel
    by: str
    reason: str = ""
    author: Author | None = None


class LeafHeld(NodeEvent):
    """A robot has nothing else to begin, and waits before a leaf to be let go.

    `breakpoint`: the node before which somebody has set one, `by` whom and why; None where the
    run's `level` of autonomy asks for it.
    """

    type: Literal["leaf_held"] = "leaf_held"
    robot: str
    breakpoint: str | None
    by: str | None = None
    reason: str = ""
    level: AutonomyLevel
