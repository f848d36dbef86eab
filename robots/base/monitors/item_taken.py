"""`item_taken`: something was taken out of the basket of a base before it was offered."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.basket import MISSED_KG
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, NoParameters, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import BASKET, Detection


class ItemTaken(BaseMonitor[NoParameters]):
    """Raises `item_taken` for a basket that is lighter than it was, until anything is offered."""

    issue: ClassVar[str] = "item_taken"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset(
        {Phase.PREPARE, Phase.TRAVEL, Phase.RIDE, Phase.UNLOAD}
    )
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: BaseView) -> Detection | None:
        if view.missing_kg < MISSED_KG:
            return None
        told = f"my basket is {view.missing_kg:.1f} kg lighter than it was"
        return Detection(camera=BASKET, explanation=told)
