"""Who gets to know what a robot does: the run that owns it."""

from collections.abc import Callable
from typing import Protocol

from mend.robots.link.messages import Hello, Poses, Report
from mend.server.journal.journal import Receipt

FollowPoses = Callable[[str, Poses], None]
"""Told of each robot's poses as they come."""


class RobotSink(Protocol):
    """The owner of a robot. Of one robot it is called for one thing after another."""

    async def robot_connected(self, robot: str, hello: Hello) -> None:
        """The robot is there: for the first time, again, or with a new boot."""
        ...

    async def robot_reported(self, robot: str, report: Report, receipt: Receipt) -> None:
        """Take a report; returns when it and what follows from it are committed with `receipt`.

        A `receipt.boot` other than that of the last hello tells of an earlier start of the robot's
        program, which did not get to deliver it: it is history and says nothing about now.
        """
        ...

    def robot_posed(self, robot: str, poses: Poses) -> None:
        """Where everything is, for people who watch; never waits."""
        ...

    async def robot_lost(self, robot: str, reason: str) -> None:
        """The robot is gone and has not come back in time, or its process has ended."""
        ...
