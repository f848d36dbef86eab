"""Driving: from where a base is to a pose, with waits where something bars its way."""

from collections.abc import Callable

from mend.maps.building.building import ON_FLOOR_M
from mend.robots.base.base import Base
from mend.robots.base.behaviors.behavior import Drive
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.base.behaviors.watch import BaseWatch
from mend.robots.base.body import BasePose
from mend.robots.base.motion.headway import Headway
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.routine import Routine

NEAR_M = 0.05
TURNED_RAD = 0.09
"""A base is where it was to go when it is so near and turned no farther."""

KEPT_OFF_S = 2.0
"""Who only passes by is let pass."""


class Driving:
    """Takes drives, and lets the monitors watch."""

    def __init__(self, base: Base, progress: BaseProgress, watch: BaseWatch) -> None:
        self._base, self._progress, self._watch = base, progress, watch

    def is_at(self, goal: BasePose) -> bool:
        """Whether the base is where it was to go."""
        here = self._base.body.pose()
        near = here.distance_m(goal) <= NEAR_M and abs(here.z - goal.z) < ON_FLOOR_M
        return near and here.turned_by_rad(goal) <= TURNED_RAD

    def is_about_at(self, drive: Drive) -> bool:
        """Whether the base is where a drive leads, or as near as is near enough."""
        here = self._base.body.pose()
        near = here.distance_m(drive.to) <= drive.near_m and abs(here.z - drive.to.z) < ON_FLOOR_M
        return near or self.is_at(drive.to)

    def take(self, drive: Drive, no_more: Callable[[], bool] = lambda: False) -> Routine[None]:
        """Drive there, or until there is `no_more` reason to. Raises `Interruption`."""
        self._begin(drive)
        self._watch.check()
        headway = Headway(self._base.body.limits.turn_rad_s)
        while not (self.is_at(drive.to) and self._base.slow) and not no_more():
            if self._is_kept_off(drive):
                break
            if self._base.following is not None:
                self._drive_on(drive, headway)
            self._watch.check_if_due()
            yield
        self._base.stop()
        yield from self._watched(self._base.settle())
        yield from self._watched(self._base.wait(drive.wait_s))

    def _is_kept_off(self, drive: Drive) -> bool:
        """Whether it is near enough, and something that is no door has barred its way for long."""
        since_s = self._progress.blocked_since_s
        if since_s is None or not self.is_about_at(drive):
            return False
        barrier = self._base.barrier()
        stood_s = self._base.body.time_s() - since_s
        return barrier is not None and barrier.door is None and stood_s >= KEPT_OFF_S

    def _begin(self, drive: Drive) -> None:
        progress = self._progress
        progress.blocked_since_s, progress.stalled_s, progress.no_way = None, 0.0, None
        try:
            self._base.start(drive.to, drive.speed)
        except CommandError as error:
            progress.no_way = str(error)

    def _drive_on(self, drive: Drive, headway: Headway) -> None:
        """Drive while there is a way; stand still before what leaves none."""
        progress, base = self._progress, self._base
        if base.jumps():
            self._begin(drive)
            if base.following is None:
                return
        base.drive_on()
        if base.whereabouts.is_lost:
            return
        following = base.following
        assert following is not None, "it drives"
        if not following.barred:
            turn_rad = base.body.pose().turned_by_rad(drive.to) if following.turns_at_end else None
            headway.note(following.left_m, turn_rad, base.pace * base.body.control_period_s)
            progress.blocked_since_s, progress.stalled_s = None, headway.stalled_s
        elif progress.blocked_since_s is None and base.slow:
            progress.blocked_since_s = base.body.time_s()

    def _watched(self, routine: Routine[None]) -> Routine[None]:
        for _ in routine:
            self._watch.check_if_due()
            yield
