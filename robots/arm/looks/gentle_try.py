"""Whether what was felt still holds up the arm: no camera shows that past the arm itself."""

import math

from mend.robots.arm.behaviors.execution import ArmExecution
from mend.robots.arm.behaviors.felt_motion import FeltMotion
from mend.robots.arm.looks.looker import Looker
from mend.robots.execution.routine import Routine

_AGAIN_S = 5.0
"""Who clears the way is pushed no more often than this."""
_BACK_SPEED = 0.3


class GentleTry:
    """Goes slowly to where the step leads in which something was felt, and back if it is felt."""

    def __init__(self, looker: Looker) -> None:
        self._arm, self._held = looker.arm, looker.held
        self._next_s = -math.inf

    def passes(self) -> Routine[bool]:
        """Whether nothing was felt, or nothing is any more; not while the last try is just over."""
        held, body = self._held, self._arm.body
        if held is None or not held.was_held_up or self._arm.at_rest:
            return True
        if body.time_s() < self._next_s:
            return False
        free = yield from self._goes_on(held)
        self._next_s = body.time_s() + _AGAIN_S
        return free

    def _goes_on(self, held: ArmExecution) -> Routine[bool]:
        attempt, (to, *_) = held.gentlest_try, held.way
        path = self._arm.body.plan_path([to])
        if path is None:
            # Whoever goes on has to find another way first.
            return True
        motion = FeltMotion(self._arm, to, attempt.limit_n)
        for segment in range(path.segments):
            self._arm.start(path, segment, attempt.speed)
            while self._arm.body.moving:
                yield
                if motion.is_held_up():
                    yield from self._go_back(motion)
                    return False
        return True

    def _go_back(self, motion: FeltMotion) -> Routine[None]:
        way = motion.way_back()
        back = self._arm.body.plan_back(way) if way else None
        if back is not None:
            yield from self._arm.follow(back, _BACK_SPEED)
