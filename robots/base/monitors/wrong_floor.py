"""`wrong_floor`: the elevator has opened at another floor than the base rides to."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, NoParameters, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import LASER, Detection


class WrongFloor(BaseMonitor[NoParameters]):
    """Raises `wrong_floor` in an elevator that was shut and is open elsewhere."""

    issue: ClassVar[str] = "wrong_floor"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.RIDE})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: BaseView) -> Detection | None:
        awaited = view.elevator
        if awaited is None or not (awaited.aboard and awaited.is_open and awaited.was_shut):
            return None
        ride, floor = awaited.ride, awaited.floor
        if floor is None or floor == ride.to_floor:
            return None
        told = f"{ride.elevator} has opened at {floor}, and I must get to {ride.to_floor}"
        return Detection(camera=LASER, explanation=told)
