"""The monitors of a base's execution: when they check, and what they are shown."""

import math
from collections.abc import Callable, Sequence

from mend.robots.base.base import Base
from mend.robots.base.behaviors.behavior import Drive
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.base.monitors.monitor import AwaitedElevator, BaseView
from mend.robots.execution.monitor import AnyMonitor
from mend.robots.execution.watch import Watch
from mend.robots.link.messages import ReportBody


class BaseWatch(Watch[BaseView, BaseProgress]):
    """Lets the monitors of the step under way judge what the base senses."""

    def __init__(
        self,
        execution: str,
        behavior: str,
        progress: BaseProgress,
        base: Base,
        monitors: Sequence[AnyMonitor],
        report: Callable[[ReportBody], None],
    ) -> None:
        """`behavior`: the name by which monitors know the one that is executed."""
        super().__init__(execution, behavior, progress, base, monitors, report)
        self._base = base
        self._next_check_s = -math.inf

    def check_if_due(self) -> None:
        """Check at the laser's period. Raises `Interruption`."""
        now = self._base.body.time_s()
        if now >= self._next_check_s - 1e-9:
            self._next_check_s = now + self._base.body.scan_period_s
            self.check()

    def check(self) -> None:
        """Let the monitors of this step judge. Raises `Interruption` for the first that must."""
        progress, now = self._progress, self._base.body.time_s()
        taken, since_s = progress.taken, progress.blocked_since_s
        whereabouts = self._base.whereabouts
        # Who is lost knows neither of doors nor of ways.
        barrier = None if whereabouts.is_lost else self._base.barrier()
        self.show(
            BaseView(
                time_s=now,
                step=progress.step,
                phase=progress.phase,
                pose=self._base.body.pose(),
                goal=taken.to if isinstance(taken, Drive) else None,
                in_the_way_m=None if barrier is None else barrier.away_m,
                door=None if barrier is None else barrier.door,
                waited_s=0.0 if since_s is None else now - since_s,
                stalled_s=progress.stalled_s,
                no_way=None if whereabouts.is_lost else progress.no_way,
                elevator=self._elevator(now),
                lost_s=whereabouts.lost_s,
                guesses=whereabouts.guesses,
                scan=self._base.body.scan(),
            )
        )

    def _elevator(self, now_s: float) -> AwaitedElevator | None:
        wait, base = self._progress.wait, self._base
        if wait is None:
            return None
        is_open = base.sees_out() if wait.aboard else base.elevators.is_open_for(wait.ride)
        return AwaitedElevator(
            ride=wait.ride,
            aboard=wait.aboard,
            is_open=is_open,
            was_shut=wait.was_shut,
            floor=base.ways.floor(base.body.pose()),
            waited_s=now_s - wait.since_s,
        )
