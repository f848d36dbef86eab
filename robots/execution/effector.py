"""An effector: what a robot acts with, and how fast that may go at the moment."""

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

from mend.robots.body import MovingBody
from mend.robots.execution.routine import Routine

B = TypeVar("B", bound=MovingBody)


class Effector(ABC, Generic[B]):
    """An arm with its gripper, or a base that drives, over its body."""

    def __init__(self, body: B) -> None:
        self.body = body
        self.at_rest = False
        """Whether it is where it is in nobody's way: an arm at neutral, a base that stands."""
        self._slow_down = 1.0
        self._caution = 1.0

    def slow_down(self, factor: float) -> None:
        """Scale all motion from now on, as the service commanded."""
        self._slow_down = factor
        self._apply_speed()

    def be_careful(self, factor: float) -> None:
        """Scale all motion from now on because a person is near; 1 when nobody is."""
        self._caution = factor
        self._apply_speed()

    def stop(self) -> None:
        """Stop as soon as the body can."""
        self.body.stop()

    @property
    def braking(self) -> bool:
        """Whether it still moves although it was told to stop."""
        return False

    def settle(self) -> Routine[None]:
        """Wait until nothing moves any more."""
        while self.body.moving:
            yield

    def wait(self, duration_s: float) -> Routine[None]:
        """Let time pass."""
        end = self.body.time_s() + duration_s
        while self.body.time_s() < end - 1e-9:
            yield

    def _scaled(self, speed: float) -> float:
        """What a motion of this speed, in (0, 1] of the best, has now."""
        return speed * self._slow_down * self._caution

    @abstractmethod
    def _apply_speed(self) -> None:
        """What is under way goes on as `_scaled` says."""
