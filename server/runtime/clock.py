"""The clock of a run: it never runs backwards, whatever a robot's clock does."""

import math
from collections.abc import Callable
from typing import Literal, Protocol

TOLERANCE_S = 1e-6
"""Two moments closer than this are the same: converting between clocks loses the last digits."""


def rate_while_asked(speed: float | Literal["max"]) -> float:
    """How fast a simulated world's clock may run, at most, while people are asked: never faster
    than they live."""
    return 1.0 if speed == "max" else min(1.0, speed)


class RunClock(Protocol):
    """Seconds since the run began."""

    def now(self) -> float: ...

    def observe(self, robot_time: float) -> None:
        """Take note of a robot's clock."""
        ...

    def align(self, robot_time: float) -> None:
        """A robot has (re)joined: its clock says `robot_time` now."""
        ...

    def catch_up(self) -> None:
        """Be as far as its world is, whose robots may have driven since one last reported."""
        ...

    def to_robot(self, time: float) -> float:
        """A time of this clock as the robot's clock says it."""
        ...

    def from_robot(self, robot_time: float) -> float:
        """A time of the robot's clock as this one says it; where they differ, what it is now."""
        ...

    def pause(self) -> None: ...

    def resume(self) -> None: ...


class WorldTime:
    """How far the clock of one simulated world is, by all that was heard of it (seconds).

    A robot that nobody has told anything says nothing, while others let time pass.
    """

    def __init__(self) -> None:
        self._latest_s = -math.inf

    @property
    def latest_s(self) -> float:
        """The latest time that was heard; minus infinity where none was."""
        return self._latest_s

    def heard(self, robot_time: float) -> float:
        """A robot's clock says this, or said it a while ago; returns what it must be by now."""
        self._latest_s = max(self._latest_s, robot_time)
        return self._latest_s

    def begin_anew(self) -> None:
        """The world is rebuilt: what was heard of it is over."""
        self._latest_s = -math.inf


class SimulatedClock:
    """Follows a simulated world's clock, which may start again when the world is rebuilt."""

    def __init__(
        self,
        start: float = 0.0,
        world: WorldTime | None = None,
        began_s: float | None = None,
        shown_s: Callable[[], float] | None = None,
    ) -> None:
        """`world`: the time of the world that it follows, where others follow it too; `began_s`:
        what that said at the `start`, if it is known; `shown_s`: how far it is by all that robots
        say, also by what is only for display.
        """
        self._now = start
        self._offset = start
        self._world = world
        self._began_s = began_s
        self._shown_s = shown_s
        self._aligned = False

    def now(self) -> float:
        return self._now

    def observe(self, robot_time: float) -> None:
        if self._world is not None:
            self._world.heard(robot_time)
        self._now = max(self._now, robot_time + self._offset)

    def align(self, robot_time: float) -> None:
        if self._world is not None:
            robot_time = self._world.heard(robot_time)
        if self._began_s is not None:
            # It may have said so a while ago; others may have let time pass until it was there.
            robot_time = max(robot_time, self._began_s)
            self._now = max(self._now, self._offset + robot_time - self._began_s)
            self._began_s = None
        self._offset = self._now - robot_time
        self._aligned = True

    def catch_up(self) -> None:
        # Before any robot has joined it is not known what this clock said at a time of the world's.
        if self._aligned and self._shown_s is not None:
            self._now = max(self._now, self._shown_s() + self._offset)

    def to_robot(self, time: float) -> float:
        return time - self._offset

    def from_robot(self, robot_time: float) -> float:
        return robot_time + self._offset

    def pause(self) -> None:
        """Nothing to do: the world's clock only moves when it is told to."""

    def resume(self) -> None:
        """Nothing to do, as for `pause`."""


class WallClock:
    """Real time for real robots; it stands still while the run is paused."""

    def __init__(self, monotonic: Callable[[], float], start: float = 0.0) -> None:
        self._monotonic = monotonic
        self._elapsed = start
        self._since: float | None = monotonic()

    def now(self) -> float:
        running = 0.0 if self._since is None else self._monotonic() - self._since
        return self._elapsed + running

    def observe(self, robot_time: float) -> None:
        """Nothing to do: a real robot's clock is its own."""

    def align(self, robot_time: float) -> None:
        """Nothing to do, as for `observe`."""

    def catch_up(self) -> None:
        """Nothing to do: real time goes on by itself."""

    def to_robot(self, time: float) -> float:
        return time

    def from_robot(self, robot_time: float) -> float:  # noqa: ARG002 - part of the protocol
        return self.now()

    def pause(self) -> None:
        self._elapsed, self._since = self.now(), None

    def resume(self) -> None:
        if self._since is None:
            self._since = self._monotonic()


def has_come(clock: RunClock, moment: float) -> bool:
    """Whether a moment of the run's clock is now or past."""
    return clock.now() + TOLERANCE_S >= moment
