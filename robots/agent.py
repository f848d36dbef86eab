"""The agent core: what drives a robot, or several in one world, seen from their end of the link.

It is synchronous and knows no network: the link hands it commands, lets it advance, and takes its
reports. Simulated and real robots, and tests, drive the same core.
"""

from collections.abc import Callable, Sequence
from typing import Any, Protocol, runtime_checkable

from mend.robots.link.messages import (
    CommandBody,
    Driven,
    Hello,
    Picture,
    PoseLayout,
    Poses,
    ReportBody,
)

Emit = Callable[[ReportBody, float, dict[str, Any] | None], None]
"""Takes a report's body, the time (s, robot's clock) and a simulated world's state or None."""

EmitPicture = Callable[[Picture], None]


class Agent(Protocol):
    """One robot, without its link and its clock."""

    def hello(self, boot: str) -> Hello:
        """What the robot is, and what it is doing now."""
        ...

    def attach(self, emit: Emit, emit_picture: EmitPicture) -> None:
        """Say where reports and pictures go; called once, before anything else."""
        ...

    def handle(self, command_id: str, body: CommandBody) -> None:
        """Take a command. One that cannot be carried out is answered by a `Rejected` report."""
        ...


class Clockwork(Protocol):
    """Lets time pass for all robots that share a clock."""

    def advance(self, duration_s: float) -> bool:
        """Let up to `duration_s` of the robots' clock pass; False when there is nothing to do.

        Emits what happens. Returns early when a report was emitted that the service must see
        before more time passes (an issue, a finished behavior, a look's answer).
        """
        ...

    @property
    def pace(self) -> float | None:
        """Simulated seconds per wall second wanted now; None as fast as possible."""
        ...

    def time_s(self) -> float: ...

    @property
    def shut_down(self) -> bool:
        """Whether a `shutdown` command came."""
        ...


class AgentCore(Agent, Clockwork, Protocol):
    """One robot with a clock of its own."""


class AgentGroup(Clockwork, Protocol):
    """Robots that are in one world."""

    @property
    def agents(self) -> Sequence[Agent]: ...


@runtime_checkable
class ShowsPoses(Protocol):
    """An agent core that can say where everything is."""

    def pose_layout(self) -> PoseLayout:
        """What its poses hold; the same all the time."""
        ...

    def poses(self) -> Poses:
        """Where everything is now."""
        ...


@runtime_checkable
class Drives(Protocol):
    """An agent core that may have a base, and then knows how far that has driven."""

    def driven(self) -> Driven | None:
        """So far, since its program began; None without a base."""
        ...
