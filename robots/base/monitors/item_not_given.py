"""`item_not_given`: a base has come for something, and its basket is not heavier."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.asking import Asking
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import BASKET, Detection


class ItemNotGiven(BaseMonitor[Asking]):
    """Raises `item_not_given` while the base waits for something to be put in."""

    issue: ClassVar[str] = "item_not_given"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.LOAD})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = Asking

    def check(self, view: BaseView) -> Detection | None:
        standing = view.standing
        if standing is None or standing.waited_s < self.settings.asks_s:
            return None
        told = f"I have come to {standing.place} to collect the {standing.item}"
        return Detection(camera=BASKET, explanation=told)
