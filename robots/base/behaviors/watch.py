"""The monitors of a base's execution: when they check, and what they are shown."""

import math
from collections.abc import Callable, Sequence

from mend.robots.base.base import Barrier, Base
from mend.robots.base.behaviors.behavior import (
    Arrive,
    AwaitItem,
    AwaitTaken,
    Charging,
    Drive,
    GetIn,
    Meet,
    Tell,
)
from mend.robots.base.behaviors.going_round import GoingRound
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.base.monitors.monitor import (
    AwaitedElevator,
    BaseView,
    Left,
    Power,
    StandingFor,
)
from mend.robots.execution.monitor import AnyMonitor
from mend.robots.execution.watch import Watch
from mend.robots.link.messages import Detection, ReportBody


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
        self.going_round = GoingRound(base, progress, report)
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
                door=self._shut_door(barrier),
                between=None if barrier is None else barrier.between,
                robot=None if barrier is None else barrier.robot,
                waited_s=0.0 if since_s is None else now - since_s,
                stalled_s=progress.stalled_s,
                no_way=None if whereabouts.is_lost else progress.no_way,
                elevator=self._elevator(now),
                lost_s=whereabouts.lost_s,
                guesses=whereabouts.guesses,
                scan=self._base.body.scan(),
                standing=self._standing(now),
                lacks=self._lacks(),
                missing_kg=self._missing_kg(),
                power=self._power(),
                left=self._left(now),
            )
        )

    def _copes_with(self, monitor: AnyMonitor, detection: Detection) -> bool:
        return self.going_round.copes_with(monitor.issue, detection)

    def _shut_door(self, barrier: Barrier | None) -> str | None:
        """The door that bars its way; an elevator that is open for it is none."""
        taken, elevators = self._progress.taken, self._base.elevators
        if barrier is None or not isinstance(taken, GetIn):
            return None if barrier is None else barrier.door
        into_it = barrier.door == taken.ride.elevator and elevators.is_open_for(taken.ride)
        return None if into_it else barrier.door

    def _standing(self, now_s: float) -> StandingFor | None:
        standing = self._progress.standing
        if standing is None:
            return None
        match standing.step:
            case AwaitItem(item=item, place=place) | AwaitTaken(item=item, place=place):
                return StandingFor(item, place, now_s - standing.since_s)
            case Meet(place=place) | Arrive(place=place):
                return StandingFor(None, place, now_s - standing.since_s)
            case Tell() | Charging():
                return StandingFor(None, None, now_s - standing.since_s)

    def _left(self, now_s: float) -> Left | None:
        """How long it has waited for whom it leads."""
        since_s = self._progress.alone_since_s
        return None if since_s is None else Left(now_s - since_s, self._base.company.last)

    def _power(self) -> Power:
        battery = self._base.battery
        to_charger = any(isinstance(each, Charging) for each in self._progress.steps)
        return Power(battery.share, battery.charging, to_charger)

    def _lacks(self) -> str | None:
        """What it is to hand over and was never given."""
        items = self._base.basket.memory.items
        given = {e.item for e in self._progress.steps if isinstance(e, AwaitItem)} | items.keys()
        wanted = (e.item for e in self._progress.steps if isinstance(e, AwaitTaken))
        return next((each for each in wanted if each not in given), None)

    def _missing_kg(self) -> float:
        """How much less its basket holds than it was given; what it offers may be taken."""
        memory = self._base.basket.memory
        if not memory.items or memory.offered is not None:
            return 0.0
        return max(0.0, -self._base.load.change_kg())

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
            failed=None if wait.aboard else base.failed_in(wait.ride.elevator),
        )
