"""Driving: from where a base is to a pose, with waits where something bars its way."""

from collections.abc import Callable

from mend.maps.building.building import ON_FLOOR_M
from mend.robots.base.base import Base
from mend.robots.base.behaviors.behavior import Drive
from mend.robots.base.behaviors.passing import Passing
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.base.behaviors.watch import BaseWatch
from mend.robots.base.body import BasePose
from mend.robots.base.companion import CAUGHT_UP_M
from mend.robots.base.made_way import MadeWay
from mend.robots.base.motion.headway import Headway
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import ReportBody, WayFound

NEAR_M = 0.05
TURNED_RAD = 0.09
"""A base is where it was to go when it is so near and turned no farther."""
CLEARS_M = 2.0
"""Who gets out of a cabin drives so far before it waits for anybody: nobody else could use it."""

KEPT_OFF_S = 2.0
"""Who only passes by is let pass."""


class Driving:
    """Takes drives, and lets the monitors watch."""

    def __init__(
        self,
        base: Base,
        progress: BaseProgress,
        watch: BaseWatch,
        report: Callable[[ReportBody], None],
    ) -> None:
        self._base, self._progress, self._watch = base, progress, watch
        self._passing, self._report = Passing(base), report

    def is_at(self, goal: BasePose) -> bool:
        """Whether the base is where it was to go."""
        here = self._base.body.pose()
        near = here.distance_m(goal) <= NEAR_M and abs(here.z - goal.z) < ON_FLOOR_M
        return near and here.turned_by_rad(goal) <= TURNED_RAD

    def is_about_at(self, drive: Drive) -> bool:
        """Whether the base is where a drive leads, or as near as is near enough."""
        here, company = self._base.body.pose(), self._base.company
        if abs(here.z - drive.to.z) >= ON_FLOOR_M:
            return False
        near = here.distance_m(drive.to) <= drive.near_m or self.is_at(drive.to)
        return near or (
            drive.meets
            and company.is_within(CAUGHT_UP_M)
            and company.is_at(drive.to, CAUGHT_UP_M, here)
        )

    def take(self, drive: Drive, no_more: Callable[[], bool] = lambda: False) -> Routine[None]:
        """Drive there, or until there is `no_more` reason to. Raises `Interruption`."""
        self._begin(drive)
        self._watch.check()
        headway, rounds = self._headway(), self._watch.going_round.times
        clears_from = self._clears_from(drive)
        while not (self.is_at(drive.to) and self._base.slow) and not no_more():
            if self._is_kept_off(drive):
                break
            if self._base.made_way is not None:
                yield from self._make_way(drive, self._base.made_way)
                headway, clears_from = self._headway(), self._clears_from(drive)
            if self._base.following is not None:
                self._drive_on(drive, headway, clears_from)
            self._watch.check_if_due()
            if self._watch.going_round.times > rounds:
                headway, rounds = self._headway(), self._watch.going_round.times
            yield
        self._base.stop()
        self._progress.alone_since_s = None
        yield from self._watched(self._base.settle())
        yield from self._watched(self._base.wait(drive.wait_s))

    def _make_way(self, drive: Drive, made: MadeWay) -> Routine[None]:
        """Make way for another robot, or let it make way; people are asked for nothing then."""
        progress = self._progress
        if not self._is_for_now(made):
            self._base.made_way = None
            return
        progress.blocked_since_s, progress.stalled_s = None, 0.0
        if not made.way:
            return
        yield from self._stand_aside(made, lambda: False)
        self._begin(drive)

    def stand_aside(self, no_more: Callable[[], bool]) -> Routine[None]:
        """Make way while it waits for something, if it was told to, until there is `no_more` reason
        to wait. Raises `Interruption`.
        """
        base, made = self._base, self._base.made_way
        if made is None or not made.way or not self._is_for_now(made):
            return
        yield from self._stand_aside(made, no_more)
        base.stop()
        yield from self._watched(base.settle())

    def _stand_aside(self, made: MadeWay, no_more: Callable[[], bool]) -> Routine[None]:
        base = self._base
        base.made_way = None
        base.start_along(made.way)
        while base.body.time_s() < made.until_s and not base.jumps() and not no_more():
            base.drive_on()
            self._watch.check_if_due()
            yield

    def _is_for_now(self, made: MadeWay) -> bool:
        """Whether it is for this floor, and not too late."""
        here, now_s = self._base.body.pose(), self._base.body.time_s()
        return now_s < made.until_s and abs(here.z - made.z) < ON_FLOOR_M

    def _is_kept_off(self, drive: Drive) -> bool:
        """Whether it is near enough, and something that is no door has barred its way for long."""
        since_s = self._progress.blocked_since_s
        if since_s is None or not self.is_about_at(drive):
            return False
        barrier = self._base.barrier()
        stood_s = self._base.body.time_s() - since_s
        return barrier is not None and barrier.door is None and stood_s >= KEPT_OFF_S

    def _headway(self) -> Headway:
        return Headway(self._base.body.limits.turn_rad_s)

    def _begin(self, drive: Drive) -> None:
        progress = self._progress
        progress.blocked_since_s, progress.stalled_s, progress.no_way = None, 0.0, None
        progress.alone_since_s = None
        try:
            self._base.start(drive.to, drive.speed)
        except CommandError as error:
            progress.no_way = str(error)

    def _drive_on(self, drive: Drive, headway: Headway, clears_from: BasePose | None) -> None:
        """Drive while there is a way, and whom it leads keeps up; stand still otherwise."""
        progress, base = self._progress, self._base
        if base.jumps():
            self._begin(drive)
            if base.following is None:
                return
        waits = self._waits(drive, clears_from)
        base.drive_on(waits=waits)
        if base.whereabouts.is_lost or waits:
            return
        for origin, beyond in self._passing.passed():
            self._report(WayFound(finding="open", between=[origin, beyond]))
        following = base.following
        assert following is not None, "it drives"
        if not following.barred:
            turn_rad = base.body.pose().turned_by_rad(drive.to) if following.turns_at_end else None
            headway.note(following.left_m, turn_rad, base.pace * base.body.control_period_s)
            progress.blocked_since_s, progress.stalled_s = None, headway.stalled_s
        elif progress.blocked_since_s is None and base.slow:
            progress.blocked_since_s = base.body.time_s()

    def _clears_from(self, drive: Drive) -> BasePose | None:
        """Where in a cabin it is with whom it leads; None where it is in none."""
        here, ways = self._base.body.pose(), self._base.ways
        return here if drive.leads is not None and ways.way_out(here) is not None else None

    def _waits(self, drive: Drive, clears_from: BasePose | None) -> bool:
        """Whether whom it leads does not keep up; it gets clear of a cabin in any case."""
        progress, base = self._progress, self._base
        if drive.leads is None:
            return False
        here = base.body.pose()
        clears = clears_from is not None and here.distance_m(clears_from) < CLEARS_M
        if base.company.keeps_up() or clears:
            progress.alone_since_s = None
        elif progress.alone_since_s is None:
            progress.alone_since_s = base.body.time_s()
        return progress.alone_since_s is not None

    def _watched(self, routine: Routine[None]) -> Routine[None]:
        for _ in routine:
            self._watch.check_if_due()
            yield
