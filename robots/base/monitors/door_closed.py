"""`door_closed`: a base stands before a door that is shut."""

from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import LASER, Detection


class DoorPatience(StrictModel):
    """`patience_s`: doors that open themselves take that long."""

    patience_s: Annotated[float, Field(gt=0.0, le=600.0)] = 4.0


class DoorClosed(BaseMonitor[DoorPatience]):
    """Raises `door_closed` while the base drives, for any behavior of it that knows its doors."""

    issue: ClassVar[str] = "door_closed"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.TRAVEL})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = DoorPatience

    def check(self, view: BaseView) -> Detection | None:
        if view.door is None or view.waited_s < self.settings.patience_s:
            return None
        return Detection(
            camera=LASER,
            explanation=f"the door '{view.door}' is shut",
            between=list(view.between or ()),
        )
