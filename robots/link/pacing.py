"""How much of a robot's clock may pass at once, and when: the pace of simulated time."""

WALL_BUDGET_S = 0.01
"""An advance should take no longer than this: commands get in between two advances."""

SHORTEST_S = 0.005
LONGEST_S = 1.0
HORIZON_S = 0.02
"""A paced robot runs at most so far (wall time) ahead of the pace."""

LARGEST_LAG_S = 0.25
"""A robot that cannot keep the pace by more than this stops trying to catch up."""


class Pacer:
    """Cuts a robot's time into slices and says how long to wait after each.

    `pace` is robot seconds per wall second, None as fast as possible; all other times are seconds
    of the link's clock.
    """

    def __init__(self) -> None:
        self._cost = WALL_BUDGET_S / SHORTEST_S
        self._pace: float | None = None
        self._anchor: tuple[float, float] | None = None

    def slice_s(self, pace: float | None) -> float:
        """How much of the robot's clock the next advance may let pass."""
        affordable_s = min(max(WALL_BUDGET_S / self._cost, SHORTEST_S), LONGEST_S)
        return affordable_s if pace is None else min(affordable_s, pace * HORIZON_S)

    def took(self, wall_s: float, robot_s: float) -> None:
        """Learn from an advance what a robot second costs."""
        if robot_s > 0.0:
            cost = max(wall_s / robot_s, WALL_BUDGET_S / LONGEST_S)
            # Dearer at once, cheaper slowly: one cheap advance must not let the next one block.
            self._cost = max(cost, 0.5 * (self._cost + cost))

    def delay_s(self, pace: float | None, now: float, robot_time: float) -> float:
        """How long until the pace allows the next slice; 0 when it is due or there is no pace."""
        if pace is None:
            self._anchor = None
            return 0.0
        if self._anchor is None or pace != self._pace:
            self._pace, self._anchor = pace, (now, robot_time)
            return 0.0
        anchor_now, anchor_time = self._anchor
        delay_s = anchor_now + (robot_time - anchor_time) / pace - now
        if delay_s < -LARGEST_LAG_S:
            self._anchor = (now, robot_time)
        return max(0.0, delay_s)

    def rest(self) -> None:
        """The robot idles: its clock stands still, and nothing has to be caught up with."""
        self._anchor = None
