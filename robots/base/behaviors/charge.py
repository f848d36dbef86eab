"""`charge`: drive to a charger, and stand there until the battery is full."""

from collections.abc import Sequence
from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import (
    BaseBehavior,
    BaseSituation,
    BaseStep,
    Charging,
    steps_to,
)
from mend.tasks.scene import Name


class ChargeParameters(StrictModel):
    """`place`: a charger."""

    place: Name


class Charge(BaseBehavior):
    """Goes to a charger as `go_to` does, and stays until its battery is full."""

    name: ClassVar[str] = "charge"
    parameters: ClassVar[type[StrictModel]] = ChargeParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, ChargeParameters), "commands are checked before"
        return [*steps_to(parameters.place, situation), Charging("charge")]
