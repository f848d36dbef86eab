"""The execution of one behavior of a base: its steps, one after the other."""

from collections.abc import Callable, Sequence
from itertools import pairwise

from mend.robots.base.base import Base
from mend.robots.base.battery import ENOUGH, LOW
from mend.robots.base.behaviors.behavior import (
    UNHEARD,
    Arrive,
    AwaitItem,
    AwaitTaken,
    BaseStep,
    Charging,
    Drive,
    GetIn,
    Meet,
    RideUntilThere,
    StandingStep,
    Tell,
    phase_of,
)
from mend.robots.base.behaviors.driving import NEAR_M, Driving
from mend.robots.base.behaviors.handling import Handling
from mend.robots.base.behaviors.other_elevator import OtherElevator
from mend.robots.base.behaviors.progress import BaseProgress
from mend.robots.base.behaviors.riding import Riding, place_in
from mend.robots.base.behaviors.watch import BaseWatch
from mend.robots.base.companion import CAUGHT_UP_M
from mend.robots.base.monitors.low_battery import LowBattery
from mend.robots.base.way_ahead import WayAhead
from mend.robots.execution.command_error import CommandError
from mend.robots.execution.execution import Execution
from mend.robots.execution.execution_state import ExecutionState
from mend.robots.execution.monitor import BEFORE_FIRST_STEP, AnyMonitor
from mend.robots.execution.routine import Routine
from mend.robots.execution.watch import Interruption
from mend.robots.link.messages import FeltLoad, ReportBody, Resume, Resumed, StepStarted


class BaseExecution(Execution[BaseProgress]):
    """Walks one behavior of a base. What was done before a hold is not done again."""

    def __init__(
        self,
        id: str,  # noqa: A002 - the protocol's word
        behavior: str,
        steps: Sequence[BaseStep],
        base: Base,
        monitors: Sequence[AnyMonitor],
        report: Callable[[ReportBody], None],
    ) -> None:
        """`behavior`: the name by which monitors know it."""
        progress = BaseProgress(steps=steps)
        super().__init__(id, progress, base, report)
        self._base = base
        self._watch = BaseWatch(id, behavior, progress, base, monitors, report)
        self._other = OtherElevator(base, progress, report)
        self._driving = Driving(base, progress, self._watch, report)
        self._riding = Riding(base, self._driving, progress, self._watch, self._other)
        self._handling = Handling(base, progress, self._watch)
        self._done = 0
        self._asked_whether_heard = False

    def pass_by(self) -> None:
        """Take what it is to drive for done where it stands there already."""
        for step in self._progress.steps[self._done :]:
            if not (isinstance(step, Drive) and self._driving.is_about_at(step)):
                return
            self._done += 1

    def way_ahead(self) -> WayAhead:
        """Whether the step under way, or else the next, could be taken, as far as is seen."""
        left = self._progress.steps[self._done :]
        try:
            match left[0] if left else None:
                case Drive() as drive:
                    return self._base.way_to(drive.to, self._watch.going_round.patience_s())
                case GetIn() as step if self._base.elevators.is_open_for(step.ride):
                    return self._base.way_to(place_in(step), 0.0)
                case RideUntilThere() as step if self._riding.is_over(step.ride):
                    return WayAhead.FREE
                case GetIn() as step if self._other.leads_there(step):
                    return WayAhead.ROUND
                case GetIn() | RideUntilThere():
                    return WayAhead.BARRED
        except CommandError:
            return WayAhead.BARRED
        return WayAhead.FREE

    def felt(self) -> FeltLoad | None:
        """What the basket feels that is not what the step under way, or else the next, needs."""
        left, load = self._progress.steps[self._done :], self._base.load
        memory = self._base.basket.memory
        if self._progress.taken is None:
            # It has not asked for anything yet, or anew.
            return load.as_remembered()
        match left[0] if left else None:
            case AwaitItem():
                return load.given()
            case AwaitTaken(item=item, place=place) if memory.offers(item, place):
                return load.taken(memory.items.get(item, 0.0))
            case _:
                return load.as_remembered()

    def accompanied(self) -> bool:
        """Whether it sees whom it escorts, as near as the step under way, or the next, needs."""
        left = self._progress.steps[self._done :]
        match left[0] if left else None:
            case RideUntilThere(ride=ride):
                return self._riding.is_led_in(ride)
            case _:
                return self._base.company.is_within(CAUGHT_UP_M)

    def resume(self, told: Resume) -> Routine[None]:
        """Go on; who asked whether a message was heard is told so by that alone."""
        self._progress.heard = self._asked_whether_heard
        return super().resume(told)

    @property
    def fraction(self) -> float:
        following = self._base.following
        if self._progress.wait is not None or self._progress.standing is not None:
            return 0.0
        if following is None or following.length_m <= NEAR_M:
            return 1.0
        return min(max(0.0, 1.0 - following.left_m / following.length_m), 1.0)

    def end(self) -> None:
        self._other.give_up()
        self._base.elevators.withdraw()
        self._base.basket.withdraw()
        self._base.companion.leave()
        super().end()

    def _walk(self, *, resumed: bool) -> Routine[bool]:
        progress = self._progress
        progress.step, progress.blocked_since_s = BEFORE_FIRST_STEP, None
        progress.wait = progress.standing = progress.alone_since_s = None
        self._base.company.start_anew()
        self._forget_offers_elsewhere()
        self._base.basket.memory.asked = None
        self._other.announce(progress.steps[self._done :])
        self._invite()
        self._watch.check()
        yield from self._find_out()
        yield from self._fill_up()
        if self._done == 0 and self._is_there():
            return True
        if self._is_elsewhere():
            self._forget_offers_elsewhere()
            self._done -= 1
        progress.move_to(ExecutionState.RUNNING)
        while self._done < len(progress.steps):
            progress.step = self._done + 1
            if resumed:
                self._report(Resumed(execution=self.id, step=progress.step))
                resumed = False
            if (yield from self._take(progress.steps[self._done])):
                self._done += 1
        progress.move_to(ExecutionState.CONFIRMING)
        self._watch.check()
        yield from self._find_out()
        return False

    def _is_elsewhere(self) -> bool:
        """Whether it is not where its last drive led, and is to be: it had thought so."""
        steps = self._progress.steps
        before = steps[self._done - 1] if self._done else None
        stays = self._done == len(steps) or isinstance(steps[self._done], StandingStep)
        return stays and isinstance(before, Drive) and not self._driving.is_about_at(before)

    def _invite(self) -> None:
        """Have those hear of it whom it is to meet, or to lead."""
        for step in self._progress.steps[self._done :]:
            match step:
                case Meet(person=person, place=place):
                    self._base.companion.expect(person, place)
                case Arrive(person=person):
                    self._base.companion.lead(person)

    def _forget_offers_elsewhere(self) -> None:
        """What was offered where it stood is offered no more by who is to go from there.

        Who takes it on the way is no one to whom it was handed over.
        """
        memory = self._base.basket.memory
        stays = any(
            isinstance(step, AwaitTaken) and memory.offers(step.item, step.place)
            and isinstance(before, Drive) and self._driving.is_about_at(before)
            for before, step in pairwise(self._progress.steps)
        )  # fmt: skip
        if not stays:
            memory.offered = None

    def _find_out(self) -> Routine[None]:
        """Stand while it does not know where it is: it cannot say that it is there."""
        while self._base.whereabouts.is_lost:
            self._watch.check_if_due()
            yield

    def _fill_up(self) -> Routine[None]:
        """Stand while it is charged because its battery was low."""
        battery, progress = self._base.battery, self._progress
        # Who was plugged in as it asked for that holds more than that by the time it goes on.
        if not progress.ran_low and battery.share >= LOW:
            return
        while battery.charging and battery.share < ENOUGH:
            self._watch.check_if_due()
            yield
        progress.ran_low = False

    def _is_there(self) -> bool:
        """Whether it is where all of its steps lead."""
        return all(
            isinstance(each, Drive) and self._driving.is_at(each.to)
            for each in self._progress.steps
        )

    def _take(self, step: BaseStep) -> Routine[bool]:
        """One step; False if other steps are taken instead. Raises `Interruption`."""
        self._report(
            StepStarted(execution=self.id, step=self.step, name=step.name, phase=phase_of(step))
        )
        match step:
            case Drive():
                yield from self._driving.take(step)
            case GetIn():
                return (yield from self._riding.get_in(step))
            case RideUntilThere():
                return (yield from self._riding.ride(step))
            case AwaitItem():
                yield from self._handling.receive(step)
            case AwaitTaken():
                yield from self._handling.hand_over(step)
            case Tell():
                yield from self._handling.tell(step)
            case Charging():
                yield from self._handling.charge(step)
            case Meet():
                yield from self._handling.meet(step)
            case Arrive():
                yield from self._handling.arrive(step)
        return True

    def _react(self, interruption: Interruption) -> Routine[None]:
        self._progress.ran_low |= interruption.issue == LowBattery.issue
        self._asked_whether_heard = interruption.issue == UNHEARD
        yield from super()._react(interruption)

    def _go_to_rest(self) -> Routine[None]:
        """A base rests where it stands, but in no cabin."""
        self._other.give_up()
        self._base.elevators.withdraw()
        self._base.basket.withdraw()
        yield from self._base.settle()
        yield from self._riding.get_out(rides=isinstance(self._progress.taken, RideUntilThere))
        yield from self._base.settle()
