"""What is pushed to a device; the console's service worker shows it."""

from collections.abc import Sequence
from typing import Annotated, Literal
from uuid import UUID

from pydantic import BaseModel, ConfigDict, Field

from mend.server.journal.events import WordedSentence, Wording

MOST_CHARS = 400
"""Of a text; a whole message may have some 3900 bytes (RFC 8291), and a character up to six."""
MOST_BYTES_OF_SENTENCES = 1000


class PushModel(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class CallMessage(PushModel):
    """A robot asks. `urgent`: it does not wait, so that help is needed now or not at all.

    `sentences` are what `text` is made of, for other languages; empty where that has no room.
    """

    type: Literal["call"] = "call"
    dialogue: UUID
    run: UUID
    robot: str
    text: str
    sentences: list[WordedSentence] = []
    urgent: bool = False


class WithdrawnMessage(PushModel):
    """What was called about needs this device no more; `text` says why."""

    type: Literal["withdrawn"] = "withdrawn"
    dialogue: UUID
    robot: str
    text: str


class RobotLostMessage(PushModel):
    """A robot is gone while a run waits for it; it is called off by `dialogue`, as calls are."""

    type: Literal["robot_lost"] = "robot_lost"
    dialogue: UUID
    run: UUID
    robot: str


class TrialMessage(PushModel):
    """A push that a device has asked for, to see whether pushes reach it."""

    type: Literal["trial"] = "trial"
    nonce: str


PushMessage = Annotated[
    CallMessage | RobotLostMessage | WithdrawnMessage | TrialMessage, Field(discriminator="type")
]


def sentences_with_room(text: str, wordings: Sequence[Wording]) -> list[WordedSentence]:
    """What a text is made of, where it fits into a message beside the text."""
    for each in wordings:
        if each.text == text and len(each.model_dump_json().encode()) <= MOST_BYTES_OF_SENTENCES:
            return each.sentences
    return []


def shortened(text: str) -> str:
    """A text that fits into a message."""
    return text if len(text) <= MOST_CHARS else f"{text[: MOST_CHARS - 1]}…"
