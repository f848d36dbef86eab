"""`escort`: lead somebody whom the base has met to a place, and wait for them on the way."""

from collections.abc import Sequence
from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import (
    Arrive,
    BaseBehavior,
    BaseSituation,
    BaseStep,
    steps_to,
)
from mend.robots.base.behaviors.meet_person import PersonParameters, require_sight


class Escort(BaseBehavior):
    """Goes to a place as `go_to` does, slowly, and stands while the person does not keep up.

    It is done once the person is seen to be there, too.
    """

    name: ClassVar[str] = "escort"
    parameters: ClassVar[type[StrictModel]] = PersonParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, PersonParameters), "commands are checked before"
        person, place = parameters.person, parameters.place
        require_sight(situation)
        return [
            *steps_to(place, situation, leads=person),
            Arrive(f"arrive with {person}", person, place),
        ]
