"""`item_missing`: a base is to hand over what it was not given."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, NoParameters, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import BASKET, Detection


class ItemMissing(BaseMonitor[NoParameters]):
    """Raises `item_missing` before the base sets out for nothing."""

    issue: ClassVar[str] = "item_missing"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.PREPARE})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: BaseView) -> Detection | None:
        if view.lacks is None:
            return None
        return Detection(camera=BASKET, explanation=f"nobody has given me the {view.lacks}")
