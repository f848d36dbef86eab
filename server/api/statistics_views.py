"""Statistics, as clients are told."""

from pydantic import BaseModel, ConfigDict


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
