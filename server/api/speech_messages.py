"""What a helper's speech socket carries besides sound."""

from typing import Annotated, Literal
from uuid import UUID

from pydantic import Field, TypeAdapter

from mend.server.api.helper_messages import Auth, Error, HelperMessage, ServerMessage
from mend.server.speech.commands import Command
from mend.server.speech.conversation import EndReason, Saying


class Listen(HelperMessage):
    """Begin a conversation about an open question, or help that is awaited; it replaces another."""

    type: Literal["listen"]
    dialogue: UUID
    prompt: UUID


class Spoken(HelperMessage):
    """What was to be said has been played to its end."""

    type: Literal["spoken"]


class Cancel(HelperMessage):
    """End the conversation, if there is one."""

    type: Literal["cancel"]


AnySpeechClientMessage = Auth | Listen | Spoken | Cancel

SpeechClientMessage = Annotated[AnySpeechClientMessage, Field(discriminator="type")]

speech_client_message: TypeAdapter[AnySpeechClientMessage] = TypeAdapter(SpeechClientMessage)


class Say(ServerMessage):
    """Play this, show the text, then send `spoken`. `audio` None: there is no voice."""

    type: Literal["say"] = "say"
    what: Saying
    text: str
    audio: str | None


class Listening(ServerMessage):
    """Speak now."""

    type: Literal["listening"] = "listening"


class Hearing(ServerMessage):
    """Somebody has begun to speak."""

    type: Literal["hearing"] = "hearing"


class HeardMessage(ServerMessage):
    """An utterance has ended; `command` None where it is not one.

    `way`: which of the prompt's `ways` was chosen by it.
    """

    type: Literal["heard"] = "heard"
    command: Command | None
    phrase: str | None
    latency_ms: float
    way: str | None = None


class GaveUp(ServerMessage):
    """Too much was not understood: show the buttons."""

    type: Literal["gave_up"] = "gave_up"


class Ended(ServerMessage):
    """The conversation is over."""

    type: Literal["ended"] = "ended"
    reason: EndReason


AnySpeechServerMessage = Say | Listening | Hearing | HeardMessage | GaveUp | Ended | Error

SpeechServerMessage = Annotated[AnySpeechServerMessage, Field(discriminator="type")]

speech_server_message: TypeAdapter[AnySpeechServerMessage] = TypeAdapter(SpeechServerMessage)
