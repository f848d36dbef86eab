"""Where a run passes on what its robots show of themselves."""

from typing import Protocol

from mend.robots.link.messages import Hello, Poses


class PoseSink(Protocol):
    """Takes what robots show, for people who watch."""

    def robot_connected(self, hello: Hello) -> None: ...

    def take(self, robot: str, time_s: float, poses: Poses) -> None:
        """`time_s` is of the run's clock."""
        ...
