"""Issues over REST: what robots noticed, found again by part, robot, tree and date."""

from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Query

from mend.dialogue.script import CloseReason
from mend.server.api.issue_summary import IssueSummary
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import MAX_SEQ, Limit, SearchedText, Since, Until, WithServices
from mend.server.journal.issue_index import IndexedIssue, IssuePage

router = APIRouter(prefix="/api/issues", tags=["issues"], route_class=RepeatableRoute)


Kinds = Annotated[
    list[str] | None,
    Query(description="Only issues of these kinds (`dropped`, `missing`, ...); may be repeated."),
]
Outcomes = Annotated[
    list[CloseReason] | None,
    Query(description="Only issues whose dialogues ended so; may be repeated."),
]
Part = Annotated[str | None, Query(alias="object", max_length=200)]
Name = Annotated[str | None, Query(max_length=200)]
BeforeSeq = Annotated[
    int | None,
    Query(ge=0, le=MAX_SEQ, description="Only issues before this `seq`: the cursor of a page."),
]


@router.get("", operation_id="list_issues", responses=documented(401, 421, 422))
async def list_issues(
    services: WithServices,
    text: SearchedText = None,
    issue: Kinds = None,
    part: Part = None,
    robot: Name = None,
    tree: Name = None,
    outcome: Outcomes = None,
    run: Annotated[UUID | None, Query(description="Only issues of this run.")] = None,
    since: Since = None,
    until: Until = None,
    before: BeforeSeq = None,
    limit: Limit = 100,
) -> list[IssueSummary]:
    """Issues of all runs that can be read, newest first, for which all holds that is given.

    For the next page give the `seq` of the last issue as `before`.
    """
    page = IssuePage(text, issue, part, robot, tree, outcome, run, since, until, before, limit)
    return [_summary(each) for each in await services.journal.issues.page(page)]


def _summary(issue: IndexedIssue) -> IssueSummary:
    return IssueSummary.model_validate(issue, from_attributes=True)
