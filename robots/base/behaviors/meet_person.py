"""`meet_person`: drive to a place, and wait until somebody is there who is to be escorted."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, ClassVar

from pydantic import AfterValidator, Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import (
    MEETS_M,
    BaseBehavior,
    BaseSituation,
    BaseStep,
    Drive,
    Meet,
    steps_to,
)
from mend.robots.base.behaviors.deliver_message import require_sayable
from mend.robots.base.companion import CAUGHT_UP_M
from mend.robots.execution.command_error import CommandError
from mend.tasks.scene import Name

PersonName = Annotated[
    str, Field(min_length=1, max_length=100), AfterValidator(require_sayable("a person's name"))
]


class PersonParameters(StrictModel):
    """`place`: where to meet, or to lead to; `person`: what people call who is escorted."""

    place: Name
    person: PersonName


class MeetPerson(BaseBehavior):
    """Goes to a place as `go_to` does, and waits there until it sees the person.

    In a narrow place the person may be what keeps it from getting nearer.
    """

    name: ClassVar[str] = "meet_person"
    parameters: ClassVar[type[StrictModel]] = PersonParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, PersonParameters), "commands are checked before"
        person, place = parameters.person, parameters.place
        require_sight(situation)
        *there, drive = steps_to(place, situation, MEETS_M)
        assert isinstance(drive, Drive), "a way ends with a drive"
        meets = replace(drive, meets=True)
        return [*there, meets, Meet(f"meet {person}", person, place)]


def require_sight(situation: BaseSituation) -> None:
    """Raises `CommandError` for a base that does not sense who is with it."""
    if situation.companion.range_m < CAUGHT_UP_M:
        raise CommandError("this robot does not sense who follows it")
