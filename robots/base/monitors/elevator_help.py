"""`elevator_help`: a base needs somebody for an elevator that it cannot call, or that is stuck.

Or one in whose cabin another robot stands that works no more.
"""

from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.monitor import AwaitedElevator, BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import LASER, Detection


class ElevatorPatience(StrictModel):
    """It asks people to call an elevator after `asks_s`; after `doubts_s` it asks in any case."""

    asks_s: Annotated[float, Field(gt=0.0, le=600.0)] = 2.0
    doubts_s: Annotated[float, Field(gt=0.0, le=3600.0)] = 240.0


class ElevatorHelp(BaseMonitor[ElevatorPatience]):
    """Raises `elevator_help` while the base waits for an elevator, or in it."""

    issue: ClassVar[str] = "elevator_help"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.RIDE})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = ElevatorPatience

    def check(self, view: BaseView) -> Detection | None:
        awaited = view.elevator
        if awaited is None:
            return None
        why = self._why(awaited)
        if why is None:
            return None
        return Detection(camera=LASER, explanation=why, robot=awaited.failed)

    def _why(self, awaited: AwaitedElevator) -> str | None:
        ride, waited_s = awaited.ride, awaited.waited_s
        if awaited.failed is not None and not awaited.is_open:
            if waited_s < self.settings.asks_s:
                return None
            needs = f"I need {ride.elevator} to get from {ride.from_floor} to {ride.to_floor}"
            return f"{needs}, and {awaited.failed}, which has failed, has to be pushed out of it"
        if not ride.called and waited_s >= self.settings.asks_s:
            if not awaited.aboard and not awaited.is_open:
                return f"I need {ride.elevator} to get from {ride.from_floor} to {ride.to_floor}"
            if awaited.aboard and awaited.is_open and not awaited.was_shut:
                return f"I am in {ride.elevator}, and need to get to {ride.to_floor}"
        if waited_s >= self.settings.doubts_s:
            where = "in" if awaited.aboard else "for"
            return f"I have waited {where} {ride.elevator} for {waited_s:.0f} s"
        return None
