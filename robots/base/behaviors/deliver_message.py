"""`deliver_message`: drive to a place, tell people something, and have that confirmed."""

from collections.abc import Callable, Sequence
from typing import Annotated, ClassVar

from pydantic import AfterValidator, Field

from mend.documents.quotation_marks import MARKS
from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import (
    MEETS_M,
    BaseBehavior,
    BaseSituation,
    BaseStep,
    Tell,
    steps_to,
)
from mend.robots.link.shown_name import can_be_shown
from mend.tasks.scene import Name

MOST_CHARACTERS = 300


def require_sayable(what: str) -> Callable[[str], str]:
    """A check of a text, `what` it is called, that robots say as somebody has written it.

    What is shown between quotation marks has none of its own, or it would seem to end there.
    """

    def require(text: str) -> str:
        if not can_be_shown(text) or not set(MARKS).isdisjoint(text):
            raise ValueError(
                f"{what} has only characters that can be seen, no double quotation marks, and no "
                "blank at its ends"
            )
        return text

    return require


Message = Annotated[
    str,
    Field(min_length=1, max_length=MOST_CHARACTERS),
    AfterValidator(require_sayable("a message")),
]


class MessageParameters(StrictModel):
    """`place`: where people are; `message`: what they are told, word for word."""

    place: Name
    message: Message


class DeliverMessage(BaseBehavior):
    """Goes to a place as `go_to` does, and tells a message there until it is confirmed."""

    name: ClassVar[str] = "deliver_message"
    parameters: ClassVar[type[StrictModel]] = MessageParameters

    def steps(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[BaseStep]:
        assert isinstance(parameters, MessageParameters), "commands are checked before"
        return [*steps_to(parameters.place, situation, MEETS_M), Tell("tell the message")]
