"""The queue of open questions over REST, and one choice for several of them."""

from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Body
from pydantic import BaseModel, ConfigDict, Field

from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import HelperName, WithCaller, WithServices, helper_of
from mend.server.runtime.views import ChosenView, QuestionBatchView

router = APIRouter(prefix="/api/questions", tags=["dialogues"], route_class=RepeatableRoute)

MOST_AT_ONCE = 100
PROMPTS = ["3f0c5b1e-8a55-4d7c-9d2b-6b1e8a554d7c", "b2c7f1de-10a5-4a7c-8d11-0c9b5d3e2f60"]


class ChoiceForAllRequest(BaseModel):
    """A way, and the open questions that it is chosen for; by one helper."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    way: Annotated[str, Field(min_length=1, max_length=100)]
    prompts: Annotated[
        list[Annotated[UUID, Field(strict=False)]], Field(min_length=1, max_length=MOST_AT_ONCE)
    ]
    helper: HelperName | None = None


@router.get("", operation_id="list_questions", responses=documented(401, 421))
async def list_questions(services: WithServices) -> list[QuestionBatchView]:
    """The open questions of all runs, the most urgent first; those alike stand together."""
    return services.runs.dialogues.questions()


@router.post(
    "/choices",
    operation_id="choose_for_all",
    responses=documented(400, 401, 403, 404, 409, 413, 421, 422),
)
async def choose_for_all(
    body: Annotated[
        ChoiceForAllRequest,
        Body(examples=[{"way": "later", "prompts": PROMPTS, "helper": "anna"}]),
    ],
    services: WithServices,
    caller: WithCaller,
) -> list[ChosenView]:
    """Choose a way for several questions at once, where it is one of their batch's `at_once`.

    Each says what became of it: somebody may have been faster with one of them.
    """
    return await services.runs.dialogues.choose_for_all(
        body.way, body.prompts, helper_of(caller, body.helper), caller.author
    )
