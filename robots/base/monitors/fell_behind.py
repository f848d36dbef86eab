"""`fell_behind`: whom a base leads does not come after it."""

from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import TRACKER, Detection


class LeadingPatience(StrictModel):
    """It stands and waits for `patience_s` before it asks."""

    patience_s: Annotated[float, Field(gt=0.0, le=600.0)] = 20.0


class FellBehind(BaseMonitor[LeadingPatience]):
    """Raises `fell_behind` on the way with somebody, in elevators, and where it leads to."""

    issue: ClassVar[str] = "fell_behind"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.TRAVEL, Phase.RIDE, Phase.ARRIVE})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = LeadingPatience

    def check(self, view: BaseView) -> Detection | None:
        left = view.left
        if left is None or left.waited_s < self.settings.patience_s:
            return None
        told = f"I have waited for {left.waited_s:.0f} s"
        seen = "have not seen who follows me"
        if left.last is not None:
            seen = f"saw who follows me last {left.last.told}"
        return Detection(camera=TRACKER, explanation=f"{told}, and {seen}")
