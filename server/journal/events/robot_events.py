"""Events of a robot of a run."""

from typing import Literal

from mend.server.journal.events.event import RobotEvent


class RobotLost(RobotEvent):
    """The robot's connection or process is gone."""

    type: Literal["robot_lost"] = "robot_lost"
    reason: str


class RobotBack(RobotEvent):
    """The robot is there (again); `continues`: with the execution that it had."""

    type: Literal["robot_back"] = "robot_back"
    boot: str
    continues: bool


class RobotHolding(RobotEvent):
    """The robot has stopped and holds."""

    type: Literal["robot_holding"] = "robot_holding"
    at: str


class RobotResumed(RobotEvent):
    """The robot moves again, at `step` of its behavior."""

    type: Literal["robot_resumed"] = "robot_resumed"
    step: int


class WayFound(RobotEvent):
    """The robot has found a way to be barred, and goes round, or open, as it has passed it.

    `between`: neighbouring places, the one that it came from first.
    """

    type: Literal["way_found"] = "way_found"
    finding: str
    between: list[str]
