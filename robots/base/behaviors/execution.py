"""The execution of one behavior of a base: its drives, with waits where something bars the way."""

from collections.abc import Callable, Sequence

from mend.robots.base.base import Base
from mend.robots.base.behaviors.behavior import Drive
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.base.behaviors.watch import BaseWatch
from mend.robots.base.body import BasePose
from mend.robots.base.motion.headway import Headway
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.execution import Execution
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.monitor import BEFORE_FIRST_STEP, AnyMonitor
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import ReportBody, Resumed, StepStarted

NEAR_M = 0.05
TURNED_RAD = 0.09
"""A base is where it was to go when it is so near and turned no farther."""


class BaseExecution(Execution[BaseProgress]):
    """Drives one behavior of a base. What was driven before a hold is not driven again."""

    def __init__(
        self,
        id: str,  # noqa: A002 - the protocol's word
        behavior: str,
        drives: Sequence[Drive],
        base: Base,
        monitors: Sequence[AnyMonitor],
        report: Callable[[ReportBody], None],
    ) -> None:
        """`behavior`: the name by which monitors know it."""
        progress = BaseProgress(drives=drives)
        super().__init__(id, progress, base, report)
        self._base = base
        self._watch = BaseWatch(id, behavior, progress, base, monitors, report)
        self._driven = 0

    @property
    def goal(self) -> BasePose | None:
        """Where the step under way, or else the next, leads; None if there is none."""
        left = self._progress.drives[self._driven :]
        return left[0].to if left else None

    @property
    def fraction(self) -> float:
        following = self._base.following
        if following is None or following.length_m <= NEAR_M:
            return 1.0
        return min(max(0.0, 1.0 - following.left_m / following.length_m), 1.0)

    def _walk(self, *, resumed: bool) -> Routine[bool]:
        progress = self._progress
        progress.step, progress.waits_since_s = BEFORE_FIRST_STEP, None
        self._watch.check()
        yield from self._find_out()
        if self._driven == 0 and all(self._is_at(each.to) for each in progress.drives):
            return True
        if self._driven == len(progress.drives) and not self._is_at(progress.drives[-1].to):
            # It was elsewhere than it had thought.
            self._driven -= 1
        progress.move_to(ExecutionState.RUNNING)
        for number in range(self._driven + 1, len(progress.drives) + 1):
            progress.step = number
            if resumed:
                self._report(Resumed(execution=self.id, step=number))
                resumed = False
            yield from self._take(progress.drives[number - 1])
            self._driven = number
        progress.move_to(ExecutionState.CONFIRMING)
        self._watch.check()
        yield from self._find_out()
        return False

    def _find_out(self) -> Routine[None]:
        """Stand while it does not know where it is: it cannot say that it is there."""
        while self._base.whereabouts.is_lost:
            self._watch.check_if_due()
            yield

    def _take(self, drive: Drive) -> Routine[None]:
        """One drive, with waits wherever its way is barred. Raises `Interruption`."""
        self._report(StepStarted(execution=self.id, step=self.step, name=drive.name))
        self._begin(drive)
        self._watch.check()
        headway = Headway(self._base.body.limits.turn_rad_s)
        while not (self._is_at(drive.to) and self._base.slow):
            if self._base.following is not None:
                self._drive_on(drive, headway)
            self._watch.check_if_due()
            yield
        self._base.stop()
        yield from self._watched(self._base.settle())
        yield from self._watched(self._base.wait(drive.wait_s))

    def _begin(self, drive: Drive) -> None:
        progress = self._progress
        progress.waits_since_s, progress.stalled_s, progress.no_way = None, 0.0, None
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
            progress.waits_since_s, progress.stalled_s = None, headway.stalled_s
        elif progress.waits_since_s is None and base.slow:
            progress.waits_since_s = base.body.time_s()

    def _watched(self, routine: Routine[None]) -> Routine[None]:
        for _ in routine:
            self._watch.check_if_due()
            yield

    def _is_at(self, goal: BasePose) -> bool:
        here = self._base.body.pose()
        return here.distance_m(goal) <= NEAR_M and here.turned_by_rad(goal) <= TURNED_RAD

    def _go_to_rest(self) -> Routine[None]:
        """A base rests where it stands."""
        yield from self._base.settle()
