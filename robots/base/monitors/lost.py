"""`lost`: a base does not know where it is."""

from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import LASER, Detection


class LostPatience(StrictModel):
    """`patience_s`: it stands and looks for so long whether it finds out by itself."""

    patience_s: Annotated[float, Field(gt=0.0, le=600.0)] = 2.0


class Lost(BaseMonitor[LostPatience]):
    """Raises `lost` for any behavior of a base that may be lost, with where it may be."""

    issue: ClassVar[str] = "lost"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset(
        {
            Phase.PREPARE,
            Phase.TRAVEL,
            Phase.LOAD,
            Phase.UNLOAD,
            Phase.TELL,
            Phase.CHARGE,
            Phase.MEET,
            Phase.ARRIVE,
            Phase.CONFIRM,
        }
    )
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = LostPatience

    def check(self, view: BaseView) -> Detection | None:
        if view.lost_s < self.settings.patience_s:
            return None
        guesses = list(view.guesses())
        explanation = "what I see fits no place for sure"
        if not guesses:
            explanation = "what I see fits no place that I know"
        return Detection(camera=LASER, explanation=explanation, guesses=guesses)
