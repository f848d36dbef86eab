"""`item_not_taken`: a base has brought something, and its basket is not lighter."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.asking import Asking
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import BASKET, Detection


class ItemNotTaken(BaseMonitor[Asking]):
    """Raises `item_not_taken` while the base waits for something to be taken out."""

    issue: ClassVar[str] = "item_not_taken"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.UNLOAD})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = Asking

    def check(self, view: BaseView) -> Detection | None:
        standing = view.standing
        if standing is None or standing.waited_s < self.settings.asks_s:
            return None
        told = f"I have brought the {standing.item} to {standing.place}"
        return Detection(camera=BASKET, explanation=told)
