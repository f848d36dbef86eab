"""Statistics over runs: how often what goes wrong, how it ends, and how long people take."""

from typing import Annotated, Any

from fastapi import APIRouter, Query

from mend.dialogue.script import CloseReason
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import Since, Until, WithServices
from mend.server.api.statistics_views import (
    AnswerTimes,
    GroupedStatistics,
    NamedStatistics,
    OutcomeCounts,
    RunCounts,
    Statistics,
    WorkStatistics,
)
from mend.server.journal.run_statistics import (
    OPEN,
    UNASKED,
    Chosen,
    Groups,
    RunStatistics,
    Work,
)

router = APIRouter(prefix="/api/statistics", tags=["issues"], route_class=RepeatableRoute)


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
