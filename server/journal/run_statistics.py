"""Statistics over runs, reckoned in SQL over the indexes of runs, issues and work."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Literal

from mend.server.journal.run_index import UNREADABLE, Select

Grouping = Literal["issue", "part", "robot", "tree"]
GROUPINGS: tuple[Grouping, ...] = ("issue", "part", "robot", "tree")

MOST_GROUPS = 100
"""So many groups of each grouping are told, those with the most faults."""

OPEN, UNASKED = "open", "unasked"
"""What stands for the outcome of an issue whose dialogue goes on, and of one without any."""

RUN_SUFFIX = 9
"""Of robots of simulated worlds: a hyphen and eight digits of their run's or site's id."""


@dataclass(frozen=True, slots=True)
class Chosen:
    """Which runs count: those that began in `since` <= started < `until`, and can be read.

    `robot` may be told as it is called, or without what tells the runs of simulated worlds apart.
    """

    since: datetime | None = None
    until: datetime | None = None
    tree: str | None = None
    robot: str | None = None


@dataclass(slots=True)
class Work:
    """What there is to tell of some work: faults by outcome, picks, and answers of people (s)."""

    outcomes: dict[str, int] = field(default_factory=dict)
    picks: int = 0
    answers: int = 0
    median_s: float | None = None
    p95_s: float | None = None

    @property
    def faults(self) -> int:
        return sum(self.outcomes.values())


@dataclass(frozen=True, slots=True)
class Groups:
    """Work by name, the most faults first; of so many groups more nothing is told."""

    work: Mapping[str, Work]
    left_out: int


@dataclass(frozen=True, slots=True)
class RunStatistics:
    """How many runs there are of each status, all their work, and the same by each grouping."""

    runs: Mapping[str, int]
    total: Work
    groups: Mapping[Grouping, Groups]


class RunStatisticsIndex:
    """Reckons them; each statement by itself, so that others have their turn between them."""

    def __init__(self, select: Select) -> None:
        self._select = select

    async def of(self, chosen: Chosen) -> RunStatistics:
        """The statistics of the runs that are chosen. Raises `JournalReadError`."""
        runs, values = _runs(chosen)
        counts = await self._select(
            f"{runs} SELECT status, count(*) FROM chosen GROUP BY 1", values
        )
        total = (await self._work("''", "''", runs, chosen, values)).get("", Work())
        groups: dict[Grouping, Groups] = {}
        for grouping in GROUPINGS:
            of_issue, of_pick = _KEYS[grouping]
            work = await self._work(of_issue, of_pick, runs, chosen, values)
            groups[grouping] = _most(work, total.picks if of_pick is None else None)
        return RunStatistics(dict(counts), total, groups)

    async def _work(
        self,
        of_issue: str,
        of_pick: str | None,
        runs: str,
        chosen: Chosen,
        values: Mapping[str, Any],
    ) -> dict[str, Work]:
        work: dict[str, Work] = {}
        for name, outcome, faults in await self._select(
            f"{runs} SELECT {of_issue} AS name, {_OUTCOME}, count(*)"
            f" FROM issues JOIN chosen USING (run) WHERE {_of_robot(chosen)} GROUP BY 1, 2",
            values,
        ):
            work.setdefault(name, Work()).outcomes[outcome] = faults
        if of_pick is not None:
            for name, picks in await self._select(
                f"{runs} SELECT {of_pick} AS name, sum(picks)"
                f" FROM picks JOIN chosen USING (run) WHERE {_of_robot(chosen)} GROUP BY 1",
                values,
            ):
                work.setdefault(name, Work()).picks = picks
        for name, answers, median_s, p95_s in await self._select(
            f"{runs}, {_ranked(of_issue, chosen)} {_QUANTILES}", values
        ):
            told = work.setdefault(name, Work())
            told.answers, told.median_s, told.p95_s = answers, median_s, p95_s
        return work


_ROBOT = (
    f"iif(robot GLOB '*-{'[0-9a-f]' * (RUN_SUFFIX - 1)}',"
    f" substr(robot, 1, length(robot) - {RUN_SUFFIX}), robot)"
)
_PART = "coalesce(object, name)"
_OUTCOME = f"coalesce(outcome, iif(dialogue IS NULL, '{UNASKED}', '{OPEN}'))"
_KEYS: Mapping[Grouping, tuple[str, str | None]] = {
    "issue": ("issue", None),
    "part": (_PART, "part"),
    "robot": (_ROBOT, _ROBOT),
    "tree": ("tree", "tree"),
}
"""By what issues, and by what picks, are grouped; a pick is of no kind of issue."""


def _runs(chosen: Chosen) -> tuple[str, dict[str, Any]]:
    """The runs that are chosen, as a table to begin a statement with, and its values."""
    conditions = ["status != :unreadable"]
    values: dict[str, Any] = {"unreadable": UNREADABLE}
    if chosen.since is not None:
        conditions.append("started >= :since")
        values["since"] = chosen.since.timestamp()
    if chosen.until is not None:
        conditions.append("started < :until")
        values["until"] = chosen.until.timestamp()
    if chosen.tree is not None:
        conditions.append("tree = :tree")
        values["tree"] = chosen.tree
    if chosen.robot is not None:
        # Of a damaged row nobody knows which robots it has.
        known = "iif(json_valid(robots), robots, '[]')"
        named = f"SELECT 1 FROM (SELECT value AS robot FROM json_each({known}))"
        conditions.append(f"EXISTS ({named} WHERE {_of_robot(chosen)})")
        values["robot"] = chosen.robot
    where = " AND ".join(conditions)
    chosen_runs = f"SELECT run, tree, status FROM runs WHERE {where}"
    return f"WITH chosen AS MATERIALIZED ({chosen_runs})", values


def _of_robot(chosen: Chosen) -> str:
    return "1" if chosen.robot is None else f"(robot = :robot OR {_ROBOT} = :robot)"


def _ranked(of_issue: str, chosen: Chosen) -> str:
    """The answers of each group in order, numbered."""
    name = "part" if of_issue == _PART else of_issue
    return (
        f"ranked AS (SELECT {name} AS name, answer_s,"
        f" row_number() OVER (PARTITION BY {name} ORDER BY answer_s) AS rank,"
        f" count(*) OVER (PARTITION BY {name}) AS answers"
        " FROM questions JOIN chosen USING (run)"
        f" WHERE answer_s IS NOT NULL AND {_of_robot(chosen)})"
    )


_QUANTILES = (
    "SELECT name, max(answers),"
    " avg(iif(rank IN ((answers + 1) / 2, (answers + 2) / 2), answer_s, NULL)),"
    " max(iif(rank = (answers * 95 + 99) / 100, answer_s, NULL))"
    " FROM ranked GROUP BY name"
)
"""The median, and the least time in which 95 of 100 were given."""


def _most(work: Mapping[str, Work], picks: int | None) -> Groups:
    """The groups with the most faults; `picks` is what all of them are measured by, if one is."""
    order: Sequence[str] = sorted(
        work, key=lambda name: (-work[name].faults, -work[name].picks, name)
    )
    told = {name: work[name] for name in order[:MOST_GROUPS]}
    if picks is not None:
        for each in told.values():
            each.picks = picks
    return Groups(told, len(order) - len(told))
