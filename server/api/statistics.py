"""Statistics over runs: how often what goes wrong, how it ends, and how long people take."""

from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import BaseModel, ConfigDict

from mend.dialogue.script import CloseReason
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import Since, Until, WithServices
from mend.server.journal.run_statistics import (
    OPEN,
    UNASKED,
    Chosen,
    Groups,
    RunStatistics,
    Work,
)

router = APIRouter(prefix="/api/statistics", tags=["issues"], route_class=RepeatableRoute)


class StatisticsModel(BaseModel):
    """Base of what is told here."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class RunCounts(StatisticsModel):
    """How many runs count, by their status now."""

    total: int
    running: int = 0
    paused: int = 0
    finished: int = 0
    failed: int = 0
    aborted: int = 0


class OutcomeCounts(StatisticsModel):
    """How the dialogues of faults ended.

    `open`: of so many it goes on; `unasked`: so many had none.
    """

    resolved: int = 0
    withdrawn: int = 0
    gave_up: int = 0
    left_out: int = 0
    aborted: int = 0
    open: int = 0
    unasked: int = 0


class AnswerTimes(StatisticsModel):
    """How long people took to answer, s by the wall clock, from when a question was put first.

    `count`: so many answers count; what a script answered does not. Without any the rest is null.
    """

    count: int
    median_s: float | None
    p95_s: float | None


class WorkStatistics(StatisticsModel):
    """`faults`: issues that were raised. `picks`: how often a gripper closed to take something.

    `faults_per_1000_picks` is null where nothing was picked.
    """

    faults: int
    picks: int
    faults_per_1000_picks: float | None
    outcomes: OutcomeCounts
    answers: AnswerTimes


class NamedStatistics(WorkStatistics):
    """Those of one kind of issue, part, robot or task tree."""

    name: str


class GroupedStatistics(StatisticsModel):
    """Those with the most faults first; `left_out`: so many more there are."""

    groups: list[NamedStatistics]
    left_out: int


class Statistics(StatisticsModel):
    """All of the chosen runs, and the same by kind of issue, part, robot and task tree.

    The picks of every kind of issue are all picks: a pick is of no kind.
    """

    runs: RunCounts
    total: WorkStatistics
    by_issue: GroupedStatistics
    by_part: GroupedStatistics
    by_robot: GroupedStatistics
    by_tree: GroupedStatistics


Name = Annotated[str | None, Query(max_length=200)]
RobotName = Annotated[
    str | None,
    Query(
        max_length=200,
        description="As it is called, or without the digits that tell simulated runs apart.",
    ),
]


@router.get("", operation_id="get_statistics", responses=documented(401, 421, 422))
async def get_statistics(
    services: WithServices,
    since: Since = None,
    until: Until = None,
    tree: Name = None,
    robot: RobotName = None,
) -> Statistics:
    """Statistics over the runs that began in a span and can be read, of a tree or a robot."""
    chosen = Chosen(since, until, tree, robot)
    return _told(await services.journal.statistics.of(chosen))


def _told(found: RunStatistics) -> Statistics:
    known = RunCounts.model_fields.keys() - {"total"}
    return Statistics(
        runs=RunCounts(
            total=sum(found.runs.values()),
            **{name: found.runs[name] for name in known if name in found.runs},
        ),
        total=WorkStatistics(**_work(found.total)),
        **{f"by_{grouping}": _grouped(each) for grouping, each in found.groups.items()},
    )


def _grouped(groups: Groups) -> GroupedStatistics:
    named = [NamedStatistics(name=name, **_work(work)) for name, work in groups.work.items()]
    return GroupedStatistics(groups=named, left_out=groups.left_out)


def _work(work: Work) -> dict[str, Any]:
    known = {*CloseReason, OPEN, UNASKED}
    outcomes = {name: count for name, count in work.outcomes.items() if name in known}
    return {
        "faults": work.faults,
        "picks": work.picks,
        "faults_per_1000_picks": work.faults * 1000 / work.picks if work.picks else None,
        "outcomes": OutcomeCounts(**outcomes),
        "answers": AnswerTimes(count=work.answers, median_s=work.median_s, p95_s=work.p95_s),
    }
