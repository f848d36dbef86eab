"""When a robot's poses are to be sent: often enough for the eye, not more."""

import math

SHORTEST_WALL_S = 0.01
"""However fast a simulated clock runs, no sample comes sooner after another one than this."""


class PoseSampling:
    """Says when the next sample is due; nothing ever is while nobody asked for any.

    Times are seconds: `robot_s` of the robot's clock, `wall_s` of the link's.
    """

    def __init__(self) -> None:
        self._period_s = math.inf
        self._next_robot_s = -math.inf
        self._next_wall_s = -math.inf
        self._robot_s = -math.inf
        self._changed = False

    def ask(self, rate_hz: float) -> None:
        """Want so many samples per second of the robot's clock from now on."""
        self._period_s = 1.0 / rate_hz if rate_hz > 0.0 else math.inf
        self.change()

    def change(self) -> None:
        """Something may have moved although no time has passed."""
        self._next_robot_s = -math.inf
        self._changed = True

    def due(self, robot_s: float, wall_s: float) -> bool:
        """Whether to take a sample now, which is then counted as taken."""
        if math.isinf(self._period_s) or wall_s < self._next_wall_s:
            return False
        if robot_s < self._next_robot_s - 1e-9:
            return False
        self._take(robot_s, wall_s)
        return True

    def due_at_rest(self, robot_s: float, wall_s: float) -> bool:
        """Whether a robot that has just come to rest is to take one last sample."""
        if math.isinf(self._period_s) or not (self._changed or robot_s > self._robot_s):
            return False
        self._take(robot_s, wall_s)
        return True

    def longest_slice_s(self, wall_s: float) -> float:
        """How much of the robot's clock may pass before the next sample can be due."""
        return self._period_s if wall_s >= self._next_wall_s else math.inf

    def _take(self, robot_s: float, wall_s: float) -> None:
        self._robot_s, self._changed = robot_s, False
        self._next_robot_s = robot_s + self._period_s
        self._next_wall_s = wall_s + SHORTEST_WALL_S
