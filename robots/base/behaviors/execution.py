"""The execution of one behavior of a base: its drives, with stops before what stands in the way."""

from collections.abc import Callable, Sequence

from mend.robots.base.base import SPARE_M, Base
from mend.robots.base.behaviors.behavior import Drive
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.base.behaviors.watch import BaseWatch
from mend.robots.base.body import BasePose
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

    def _walk(self, *, resumed: bool) -> Routine[bool]:
        progress = self._progress
        progress.step, progress.waits_since_s = BEFORE_FIRST_STEP, None
        self._watch.check()
        if self._driven == 0 and all(self._is_at(each.to) for each in progress.drives):
            return True
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
        return False

    def _take(self, drive: Drive) -> Routine[None]:
        """One drive, begun again wherever it had to stop. Raises `Interruption`."""
        self._progress.fell_short, self._progress.driving = 0, False
        self._report(StepStarted(execution=self.id, step=self.step, name=drive.name))
        self._watch.check()
        while not self._is_at(drive.to):
            self._look_out(drive)
            self._watch.check_if_due()
            yield
        self._base.stop()
        yield from self._watched(self._base.wait(drive.wait_s))

    def _look_out(self, drive: Drive) -> None:
        """Drive while nothing is in the way; stand still before what is."""
        progress, base = self._progress, self._base
        in_the_way_m = base.in_the_way_m(drive.to)
        if in_the_way_m is not None and in_the_way_m < self._needed_m():
            if progress.waits_since_s is None:
                progress.waits_since_s, progress.driving = base.body.time_s(), False
                base.stop()
        elif not base.body.moving:
            if progress.waits_since_s is None and progress.driving:
                progress.fell_short += 1
            progress.waits_since_s, progress.driving = None, True
            base.start(drive.to, drive.speed)

    def _needed_m(self) -> float:
        """Who stands before something needs a little more room to start than who drives on."""
        return SPARE_M if self._progress.waits_since_s is None else 2 * SPARE_M

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
