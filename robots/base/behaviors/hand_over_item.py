"""`hand_over_item`: drive to a place, and have people take something out of the basket."""

from collections.abc import Sequence
from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import (
    MEETS_M,
    AwaitTaken,
    BaseBehavior,
    BaseSituation,
    BaseStep,
    steps_to,
)
from mend.robots.base.behaviors.collect_item import ItemParameters


class HandOverItem(BaseBehavior):
    """Goes to a place as `go_to` does, and waits there until its basket is lighter by the item."""

    name: ClassVar[str] = "hand_over_item"
    parameters: ClassVar[type[StrictModel]] = ItemParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, ItemParameters), "commands are checked before"
        item, place = parameters.item, parameters.place
        if situation.basket.memory.handed_over.get(item) == place:
            return []
        return [*steps_to(place, situation, MEETS_M), AwaitTaken(f"hand over {item}", item, place)]
