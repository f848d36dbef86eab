"""`collect_item`: drive to a place, and have people put something into the basket."""

from collections.abc import Sequence
from typing import ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import (
    MEETS_M,
    AwaitItem,
    BaseBehavior,
    BaseSituation,
    BaseStep,
    steps_to,
)
from mend.robots.execution.command_error import CommandError
from mend.tasks.scene import Name


class ItemParameters(StrictModel):
    """`place`: where people are; `item`: what they call the thing that is carried."""

    place: Name
    item: Name


class CollectParameters(ItemParameters):
    """`held_by`: the robot in whose basket it is, where nobody at the place has it.

    `away_m`: how far from the place that robot stands, for people to find it.
    """

    held_by: Name | None = None
    away_m: float | None = Field(default=None, ge=0.0)


class CollectItem(BaseBehavior):
    """Goes to a place as `go_to` does, and waits there until its basket is heavier."""

    name: ClassVar[str] = "collect_item"
    parameters: ClassVar[type[StrictModel]] = CollectParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, ItemParameters), "commands are checked before"
        item, place, basket = parameters.item, parameters.place, situation.basket
        if item in basket.memory.items:
            return []
        if len(basket.memory.items) >= basket.most_items:
            held = ", ".join(basket.memory.items) or "nothing"
            raise CommandError(
                f"its basket has room for {basket.most_items} items, and holds {held}"
            )
        return [*steps_to(place, situation, MEETS_M), AwaitItem(f"collect {item}", item, place)]
