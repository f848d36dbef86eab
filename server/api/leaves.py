"""Leaves that people do themselves, over REST: taking one, giving it back, and saying so."""

from typing import Annotated

from fastapi import APIRouter, Body
from pydantic import BaseModel, ConfigDict, Field

from mend.documents.spellings import NODE
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import HelperName, RunId, WithCaller, WithServices, helper_of
from mend.server.runtime.views import LeafSaid, RunSummary

router = APIRouter(prefix="/api/runs/{run}/leaves", tags=["runs"], route_class=RepeatableRoute)

ANSWERS = documented(400, 401, 403, 404, 409, 413, 421, 422, 503)
EXAMPLES = [{"node": "/0/1", "helper": "anna"}]
WORDS = [{"words": "I do the saucer", "helper": "anna"}]


class LeafRequest(BaseModel):
    """Which leaf, by its path, and who says so; a principal's name is that of its token."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    node: Annotated[str, Field(pattern=NODE, max_length=400)]
    helper: HelperName | None = None


class LeafWords(BaseModel):
    """What somebody says that they do, or do not do after all."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    words: Annotated[str, Field(min_length=1, max_length=200)]
    helper: HelperName | None = None


@router.post("/take", operation_id="take_leaf", responses=ANSWERS)
async def take_leaf(
    run: RunId,
    body: Annotated[LeafRequest, Body(examples=EXAMPLES)],
    services: WithServices,
    caller: WithCaller,
) -> RunSummary:
    """Do a leaf yourself: no robot begins it, and one that sees it done says so."""
    helper = helper_of(caller, body.helper)
    return await services.runs.take_leaf(run, body.node, helper, caller.author)


@router.post("/give_back", operation_id="give_leaf_back", responses=ANSWERS)
async def give_leaf_back(
    run: RunId,
    body: Annotated[LeafRequest, Body(examples=EXAMPLES)],
    services: WithServices,
    caller: WithCaller,
) -> RunSummary:
    """Do not do it after all: it is anybody's again."""
    helper = helper_of(caller, body.helper)
    return await services.runs.give_leaf_back(run, body.node, helper)


@router.post("/say", operation_id="say_of_leaf", responses=ANSWERS)
async def say_of_leaf(
    run: RunId,
    body: Annotated[LeafWords, Body(examples=WORDS)],
    services: WithServices,
    caller: WithCaller,
) -> LeafSaid:
    """Take a leaf, or give it back, in plain words: "I do the saucer"."""
    helper = helper_of(caller, body.helper)
    return await services.runs.say_of_leaf(run, body.words, helper, caller.author)
