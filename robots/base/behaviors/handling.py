"""Standing at a place: things that people put in and take out, and messages that they confirm."""

from collections.abc import Callable

from mend.robots.base.base import Base
from mend.robots.base.battery import FULL
from mend.robots.base.behaviors.behavior import (
    Arrive,
    AwaitItem,
    AwaitTaken,
    Meet,
    StandingStep,
)
from mend.robots.base.behaviors.progress import BaseProgress, StandingWait
from mend.robots.base.behaviors.watch import BaseWatch
from mend.robots.base.companion import CAUGHT_UP_M
from mend.robots.execution.routine import Routine


class Handling:
    """Takes the steps of a base that are done standing, and lets the monitors watch."""

    def __init__(self, base: Base, progress: BaseProgress, watch: BaseWatch) -> None:
        self._base, self._progress, self._watch = base, progress, watch

    def receive(self, step: AwaitItem) -> Routine[None]:
        """Wait until something is put into the basket. Raises `Interruption`."""
        base = self._base
        base.basket.memory.asked = (step.item, step.place)
        base.basket.ask_for(step.item, step.place)
        yield from self._await(step, until=lambda: base.load.given() is None)
        base.basket.withdraw()
        base.basket.memory.note_given(step.item, base.basket.load_kg())

    def hand_over(self, step: AwaitTaken) -> Routine[None]:
        """Wait until the item is taken out of the basket. Raises `Interruption`."""
        base, memory = self._base, self._base.basket.memory
        if not memory.offers(step.item, step.place):
            # What is gone by now was taken before anybody was offered it.
            self._watch.check()
        memory.offered = (step.item, step.place)
        base.basket.offer(step.item, step.place)
        weight_kg = memory.items[step.item]
        yield from self._await(step, until=lambda: base.load.taken(weight_kg) is None)
        base.basket.withdraw()
        memory.note_taken(step.item, step.place, base.basket.load_kg())

    def tell(self, step: StandingStep) -> Routine[None]:
        """Wait until somebody says that the message was heard. Raises `Interruption`."""
        yield from self._await(step, until=lambda: self._progress.heard)

    def charge(self, step: StandingStep) -> Routine[None]:
        """Stand until the battery is full. Raises `Interruption`."""
        yield from self._await(step, until=lambda: self._base.battery.share >= FULL)

    def meet(self, step: Meet) -> Routine[None]:
        """Wait until somebody is there. Raises `Interruption`."""
        yield from self._await(step, until=lambda: self._base.company.is_within(CAUGHT_UP_M))
        self._base.companion.leave()

    def arrive(self, step: Arrive) -> Routine[None]:
        """Wait until whom it has led is there, too. Raises `Interruption`."""
        self._progress.alone_since_s = self._base.body.time_s()
        yield from self._await(step, until=lambda: self._base.company.is_within(CAUGHT_UP_M))
        self._progress.alone_since_s = None
        self._base.companion.leave()

    def _await(self, step: StandingStep, until: Callable[[], bool]) -> Routine[None]:
        self._progress.standing = StandingWait(step, self._base.body.time_s())
        while not until():
            self._watch.check_if_due()
            yield
        self._progress.standing = None
