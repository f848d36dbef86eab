"""Dialogues over REST: what is asked, answering it, and being on it."""

from typing import Annotated, Literal
from uuid import UUID

from fastapi import APIRouter, Body, Query
from pydantic import BaseModel, ConfigDict, Field

from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import (
    DialogueId,
    HelperName,
    Limit,
    Offset,
    WithCaller,
    WithServices,
    helper_of,
)
from mend.server.journal.events import Answered, DeadlineExtended, HelpReported, PromiseTakenBack
from mend.server.runtime.views import DialogueView

router = APIRouter(prefix="/api/dialogues", tags=["dialogues"], route_class=RepeatableRoute)

PROMPT = "3f0c5b1e-8a55-4d7c-9d2b-6b1e8a554d7c"
CHANGES = documented(400, 401, 403, 404, 409, 413, 421, 422)


class AnswerRequest(BaseModel):
    """One helper's answer to one prompt; a principal's name is that of its token."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    prompt: Annotated[UUID, Field(strict=False)]
    answer: Literal["yes", "no"]
    helper: HelperName | None = None


class ChoiceRequest(BaseModel):
    """One of a prompt's `ways`, chosen by one helper."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    prompt: Annotated[UUID, Field(strict=False)]
    way: Annotated[str, Field(min_length=1, max_length=100)]
    helper: HelperName | None = None


class HelperRequest(BaseModel):
    """Which helper says it."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    helper: HelperName | None = None


class ClaimRequest(HelperRequest):
    """Who is on it; `take_over` takes the claim from another helper."""

    take_over: bool = False


class ExtendRequest(BaseModel):
    """Which question needs more time, and who says so."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    prompt: Annotated[UUID, Field(strict=False)]
    helper: HelperName | None = None


@router.get("", operation_id="list_dialogues", responses=documented(401, 421, 422))
async def list_dialogues(
    services: WithServices,
    status: Annotated[Literal["open", "closed"] | None, Query()] = None,
    limit: Limit = 100,
    offset: Offset = 0,
) -> list[DialogueView]:
    """Dialogues, all or those of one status."""
    return await services.runs.dialogues.page(status, limit, offset)


@router.get(
    "/{dialogue}", operation_id="get_dialogue", responses=documented(401, 404, 421, 422, 500)
)
async def get_dialogue(dialogue: DialogueId, services: WithServices) -> DialogueView:
    """One dialogue with its latest prompt."""
    return await services.runs.dialogues.view(dialogue)


@router.post(
    "/{dialogue}/answers", operation_id="answer_prompt", status_code=201, responses=CHANGES
)
async def answer_prompt(
    dialogue: DialogueId,
    body: Annotated[
        AnswerRequest, Body(examples=[{"prompt": PROMPT, "answer": "yes", "helper": "anna"}])
    ],
    services: WithServices,
    caller: WithCaller,
) -> Answered:
    """Answer a prompt. The first answer wins; a later one gets 409 with `answered_by`."""
    return await services.runs.dialogues.answer(
        dialogue, body.prompt, body.answer, helper_of(caller, body.helper), caller.author
    )


@router.post("/{dialogue}/choices", operation_id="choose_way", status_code=201, responses=CHANGES)
async def choose_way(
    dialogue: DialogueId,
    body: Annotated[
        ChoiceRequest, Body(examples=[{"prompt": PROMPT, "way": "place", "helper": "anna"}])
    ],
    services: WithServices,
    caller: WithCaller,
) -> Answered:
    """Choose one of a prompt's `ways`: all its answers are given at once, and the last returned.

    The first answer wins, as of `answers`; a way that there is not now gets 409.
    """
    return await services.runs.dialogues.choose(
        dialogue, body.prompt, body.way, helper_of(caller, body.helper), caller.author
    )


@router.post("/{dialogue}/claim", operation_id="claim_dialogue", responses=CHANGES)
async def claim_dialogue(
    dialogue: DialogueId,
    body: Annotated[ClaimRequest, Body(examples=[{"helper": "anna"}])],
    services: WithServices,
    caller: WithCaller,
) -> DialogueView:
    """Show the other helpers that you are on it; the claim ends with its lease."""
    return await services.runs.dialogues.claim(
        dialogue, helper_of(caller, body.helper), take_over=body.take_over, author=caller.author
    )


@router.post("/{dialogue}/extend", operation_id="extend_deadline", responses=CHANGES)
async def extend_deadline(
    dialogue: DialogueId,
    body: Annotated[ExtendRequest, Body(examples=[{"prompt": PROMPT, "helper": "anna"}])],
    services: WithServices,
    caller: WithCaller,
) -> DeadlineExtended:
    """Move the open question's deadline by its original length, at most ten times."""
    return await services.runs.dialogues.extend(
        dialogue, body.prompt, helper_of(caller, body.helper), caller.author
    )


@router.post("/{dialogue}/done", operation_id="say_help_is_done", responses=CHANGES)
async def say_help_is_done(
    dialogue: DialogueId,
    body: Annotated[HelperRequest, Body(examples=[{"helper": "anna"}])],
    services: WithServices,
    caller: WithCaller,
) -> HelpReported:
    """Say that the awaited help is done: the robot looks at once, and says what it sees."""
    return await services.runs.dialogues.said_done(
        dialogue, helper_of(caller, body.helper), caller.author
    )


@router.post("/{dialogue}/take_back", operation_id="take_back_promise", responses=CHANGES)
async def take_back_promise(
    dialogue: DialogueId,
    body: Annotated[HelperRequest, Body(examples=[{"helper": "anna"}])],
    services: WithServices,
    caller: WithCaller,
) -> PromiseTakenBack:
    """Take back your promise to help: the dialogue goes on as after a no to it."""
    return await services.runs.dialogues.take_back(
        dialogue, helper_of(caller, body.helper), caller.author
    )


@router.post("/{dialogue}/release", operation_id="release_dialogue", responses=CHANGES)
async def release_dialogue(
    dialogue: DialogueId,
    body: Annotated[HelperRequest, Body(examples=[{"helper": "anna"}])],
    services: WithServices,
    caller: WithCaller,
) -> DialogueView:
    """Give up your claim."""
    return await services.runs.dialogues.release(
        dialogue, helper_of(caller, body.helper), caller.author
    )
