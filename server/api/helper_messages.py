"""What a helper's WebSocket carries: every message but the events themselves."""

from typing import Annotated, Any, Literal
from uuid import UUID

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from mend.server.dialogues.attendance import Presence
from mend.server.runtime.views import DialogueView, RunSummary

CommandId = Annotated[str, Field(max_length=128)] | Annotated[int, Field(ge=0, le=2**53 - 1)]


class HelperMessage(BaseModel):
    """Base of what a client sends. With an `id`, its result or error carries the same."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    id: CommandId | None = None


class Auth(HelperMessage):
    """Show the token, where no header or cookie did; must be the first message."""

    type: Literal["auth"]
    token: Annotated[str, Field(max_length=1024)]


class Answer(HelperMessage):
    """Answer a prompt; the first answer wins."""

    type: Literal["answer"]
    dialogue: UUID
    prompt: UUID
    answer: Literal["yes", "no"]


class Choose(HelperMessage):
    """Choose one of a prompt's `ways`: all its answers are given at once."""

    type: Literal["choose"]
    dialogue: UUID
    prompt: UUID
    way: Annotated[str, Field(min_length=1, max_length=100)]


class Claim(HelperMessage):
    """Show the others that you are on it; send it again to renew the lease.

    `take_over`: take the claim from the helper who has it.
    """

    type: Literal["claim"]
    dialogue: UUID
    take_over: bool = False


class Release(HelperMessage):
    """Give up your claim."""

    type: Literal["release"]
    dialogue: UUID


class Extend(HelperMessage):
    """Move the open question's deadline by its original length, at most ten times."""

    type: Literal["extend"]
    dialogue: UUID
    prompt: UUID


class Done(HelperMessage):
    """Say that the awaited help is done: the robot looks at once."""

    type: Literal["done"]
    dialogue: UUID


class TakeBack(HelperMessage):
    """Take back your promise to help."""

    type: Literal["take_back"]
    dialogue: UUID


class Here(HelperMessage):
    """Say who is at this page. `active`: somebody has just done something there; again and again.

    `away`: nobody sees it. `beside`: whoever is beside a robot, whom it always hears. The result
    has `away_after_s`: whoever was last active longer ago counts as away.
    """

    type: Literal["here"]
    presence: Presence


class Ping(HelperMessage):
    """Is anybody there?"""

    type: Literal["ping"]


AnyClientMessage = Auth | Answer | Choose | Claim | Release | Extend | Done | TakeBack | Here | Ping

ClientMessage = Annotated[AnyClientMessage, Field(discriminator="type")]

client_message: TypeAdapter[AnyClientMessage] = TypeAdapter(ClientMessage)


class ServerMessage(BaseModel):
    """Base of what the service sends, events apart."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class SnapshotMessage(ServerMessage):
    """The first message: the state after event `seq`; every later event follows.

    What became of a run's nodes is at `GET /api/runs/{run}`.
    """

    type: Literal["snapshot"] = "snapshot"
    seq: int
    runs: list[RunSummary]
    dialogues: list[DialogueView]


class Result(ServerMessage):
    """What was asked for is done. `result`: the answer's event, or the dialogue after a claim."""

    type: Literal["result"] = "result"
    id: str | int | None = None
    result: dict[str, Any] = {}


class TroubleMessage(ServerMessage):
    """Why the journal cannot be written, so that no run goes on; null once it can be again."""

    type: Literal["trouble"] = "trouble"
    reason: str | None


class Error(ServerMessage):
    """It was not done. `answered_by`: who answered first."""

    type: Literal["error"] = "error"
    id: str | int | None = None
    status: int
    title: str
    detail: str
    answered_by: str | None = None
    errors: list[str] | None = None
