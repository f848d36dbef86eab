"""Statistics are what the events say, whatever is chosen, and tell where there is nothing."""

import random
import sqlite3
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path
from statistics import median
from typing import Any
from uuid import UUID

import pytest
from made_up_history import write_history
from sample_events import started

from mend.dialogue.script import CloseReason
from mend.server.access.roles import Role
from mend.server.journal import events as ev
from mend.server.journal.indexing import index_work
from mend.server.journal.journal import Entry
from mend.server.journal.pruning import Keep
from mend.server.journal.run_statistics import MOST_GROUPS, Chosen, RunStatistics, Work
from mend.server.journal.sqlite import SqliteJournal

BEGUN = datetime(2026, 1, 1, tzinfo=UTC)
ANNA = ev.Author(principal="anna", role=Role.HELPER)
ROBOTS = ("pr2-0123abcd", "pr2-4567cdef", "left_arm")
PARTS = ("cup", "saucer", "spoon")
TREES = ("tea", "lunch")
KINDS = ("dropped", "missing", "positioning")


class Drawn:
    """The events of a drawn run, with picks, issues, and answers of people and of scripts."""

    def __init__(self, number: int, draw: random.Random) -> None:
        self._draw = draw
        self.run = UUID(int=number + 1)
        self.began = BEGUN + timedelta(hours=number)
        self._time = 0.0
        self.robot = draw.choice(ROBOTS)
        self.tree = draw.choice(TREES)
        self.events = [*self._events()]

    def _at(self, seconds: float = 1.0) -> dict[str, Any]:
        self._time += seconds
        at = self.began + timedelta(seconds=self._time)
        return {"time": self._time, "wall_time": at, "run": self.run}

    def _events(self) -> Iterator[ev.Event]:
        nodes: list[dict[str, Any]] = [{"kind": "then", "parent": None, "name": "all"}]
        nodes += [
            {
                "kind": "behavior",
                "parent": 0,
                "name": f"leaf_{part}",
                "behavior": "pick_and_place",
                "parameters": {"object": part, "place": part},
            }
            for part in PARTS
        ]
        yield started().model_copy(
            update={
                **self._at(0.0),
                "tree_name": self.tree,
                "tree": {"name": self.tree, "nodes": nodes},
                "robots": [self.robot],
            }
        )
        for part in self._draw.choices(PARTS, k=self._draw.randrange(5)):
            yield from self._worked_at(part)
        if self._draw.random() < 0.8:
            yield ev.RunFinished(**self._at(), missing=[])

    def _worked_at(self, part: str) -> Iterator[ev.Event]:
        node = {"node": f"/{PARTS.index(part)}", "name": f"leaf_{part}"}
        doing = {**node, "robot": self.robot, "execution": self.run, "object": part}
        for number, (name, phase) in enumerate(
            [("above pick", "approach"), ("close gripper", "grasp"), ("place", "place")], 1
        ):
            yield ev.StepStarted(**self._at(), **doing, step=number, step_name=name, phase=phase)
        if self._draw.random() < 0.6:
            yield from self._asked({**node, "robot": self.robot, "object": part})

    def _asked(self, about: dict[str, Any]) -> Iterator[ev.Event]:
        issue = self._draw.choice(KINDS)
        yield ev.IssueRaised(
            **self._at(), **about, issue=issue, place=None, execution=self.run, step=2,
            interrupts=True,
        )  # fmt: skip
        if self._draw.random() < 0.2:
            return
        talk = {**about, "issue": issue, "dialogue": UUID(int=self._draw.getrandbits(128))}
        yield ev.DialogueOpened(**self._at(), **talk)
        prompt = UUID(int=self._draw.getrandbits(128))
        for version in range(1, self._draw.randrange(2, 4)):
            yield ev.Prompt(
                **self._at(), **talk, prompt=prompt, version=version, kind="ask", text="Go on?"
            )
        if self._draw.random() < 0.8:
            author = self._draw.choice((ANNA, None))
            yield ev.Answered(
                **self._at(self._draw.uniform(0.5, 30.0)), **talk, prompt=prompt, version=version,
                answer="yes", helper="anna", author=author,
            )  # fmt: skip
        if self._draw.random() < 0.8:
            yield ev.DialogueClosed(**self._at(), **talk, reason=self._draw.choice([*CloseReason]))


@pytest.fixture(scope="module")
def drawn() -> Sequence[Drawn]:
    draw = random.Random(5)
    return [Drawn(number, draw) for number in range(60)]


@pytest.fixture
async def journal(tmp_path: Path, drawn: Sequence[Drawn]) -> SqliteJournal:
    journal = SqliteJournal(tmp_path / "journal.db")
    for each in drawn:
        await journal.append(Entry(each.events))
    return journal


def without_run(robot: str) -> str:
    return robot.removesuffix("-0123abcd").removesuffix("-4567cdef")


def counted(runs: Sequence[Drawn], by: str) -> dict[str, Work]:
    """The same, gone through event by event."""
    found: dict[str, Work] = {}
    times: dict[str, list[float]] = {}
    for run in runs:
        asked: dict[UUID, float] = {}
        open_issue: Work | None = None
        for event in run.events:
            names = {
                "total": "",
                "issue": getattr(event, "issue", None),
                "part": getattr(event, "name", "").removeprefix("leaf_"),
                "robot": without_run(run.robot),
                "tree": run.tree,
            }
            name = names[by]
            match event:
                case ev.StepStarted(step_name="close gripper") if name is not None:
                    found.setdefault(name, Work()).picks += 1
                case ev.IssueRaised() if name is not None:
                    open_issue = found.setdefault(name, Work())
                    _move(open_issue, None, "unasked")
                case ev.DialogueOpened():
                    assert open_issue is not None
                    _move(open_issue, "unasked", "open")
                case ev.DialogueClosed():
                    assert open_issue is not None
                    _move(open_issue, "open", event.reason)
                case ev.Prompt():
                    asked.setdefault(event.prompt, event.time)
                case ev.Answered() if event.author is not None and name is not None:
                    times.setdefault(name, []).append(event.time - asked[event.prompt])
                case _:
                    pass
    for name, seconds in times.items():
        work, ranked = found[name], sorted(seconds)
        work.answers, work.median_s = len(ranked), pytest.approx(median(ranked), abs=1e-5)
        work.p95_s = pytest.approx(ranked[-(-len(ranked) * 95 // 100) - 1], abs=1e-5)
    return found


def _move(work: Work, before: str | None, after: str) -> None:
    if before is not None:
        work.outcomes[before] -= 1
        work.outcomes = {name: count for name, count in work.outcomes.items() if count}
    work.outcomes[after] = work.outcomes.get(after, 0) + 1


def agree(found: RunStatistics, runs: Sequence[Drawn]) -> None:
    assert sum(found.runs.values()) == len(runs)
    total = counted(runs, "total").get("", Work())
    assert found.total == total
    for grouping, groups in found.groups.items():
        wanted = counted(runs, grouping)
        if grouping == "issue":
            for each in wanted.values():
                each.picks = total.picks
        assert groups.left_out == 0
        assert dict(groups.work) == wanted
        faults = [each.faults for each in groups.work.values()]
        assert faults == sorted(faults, reverse=True)


async def test_they_are_what_the_events_say(journal: SqliteJournal, drawn: Sequence[Drawn]) -> None:
    found = await journal.statistics.of(Chosen())
    agree(found, drawn)
    assert found.total.faults > 20
    assert found.total.answers > 10
    statuses = Counter(
        "finished" if isinstance(each.events[-1], ev.RunFinished) else "running" for each in drawn
    )
    assert dict(found.runs) == statuses
    journal.close()


async def test_only_what_is_chosen_counts(journal: SqliteJournal, drawn: Sequence[Drawn]) -> None:
    since, until = BEGUN + timedelta(hours=10), BEGUN + timedelta(hours=40)
    agree(await journal.statistics.of(Chosen(since=since)), drawn[10:])
    agree(await journal.statistics.of(Chosen(until=until)), drawn[:40])
    agree(
        await journal.statistics.of(Chosen(since=since, until=until, tree="tea")),
        [each for each in drawn[10:40] if each.tree == "tea"],
    )
    for robot in (*ROBOTS, "pr2", "nobody"):
        wanted = [each for each in drawn if robot in (each.robot, without_run(each.robot))]
        agree(await journal.statistics.of(Chosen(robot=robot)), wanted)
    journal.close()


async def test_nothing_is_told_of_work_that_there_was_not(tmp_path: Path) -> None:
    journal = SqliteJournal(tmp_path / "journal.db")
    empty = await journal.statistics.of(Chosen())
    assert (dict(empty.runs), empty.total) == ({}, Work())
    assert all(not groups.work for groups in empty.groups.values())
    await journal.append(Entry([started()]))
    idle = await journal.statistics.of(Chosen())
    assert (dict(idle.runs), idle.total) == ({"running": 1}, Work())
    journal.close()


async def test_pruned_and_unreadable_runs_do_not_count(
    journal: SqliteJournal, drawn: Sequence[Drawn]
) -> None:
    await journal.mark_unreadable(drawn[-1].run, "its events are damaged")
    ended = [each for each in drawn if isinstance(each.events[-1], ev.RunFinished)]
    await journal.prune(Keep(ended_runs=5), BEGUN + timedelta(days=9))
    gone = {each.run for each in ended[:-5]}
    left = [each for each in drawn[:-1] if each.run not in gone]
    agree(await journal.statistics.of(Chosen()), left)
    journal.close()


def rows(connection: sqlite3.Connection) -> list[Any]:
    picks = connection.execute("SELECT * FROM picks ORDER BY run, robot, part").fetchall()
    return picks + connection.execute("SELECT * FROM questions ORDER BY prompt").fetchall()


async def test_an_index_made_anew_has_the_parts_that_events_of_an_older_mend_do_not_tell(
    journal: SqliteJournal, tmp_path: Path
) -> None:
    journal.close()
    with closing(sqlite3.connect(tmp_path / "journal.db")) as connection:
        before = rows(connection)
        assert before
        connection.execute("DELETE FROM picks")
        connection.execute("DELETE FROM questions")
        connection.execute(
            "UPDATE events SET body = json_remove(body, '$.phase', '$.object')"
            " WHERE type = 'step_started' AND seq % 2"
        )
        index_work(connection)
        assert rows(connection) == before


async def test_only_so_many_groups_are_told(tmp_path: Path) -> None:
    write_history(tmp_path / "journal.db", MOST_GROUPS + 7)
    journal = SqliteJournal(tmp_path / "journal.db")
    found = await journal.statistics.of(Chosen())
    journal.close()
    # Their robots end with more digits than those of simulated worlds.
    assert (len(found.groups["robot"].work), found.groups["robot"].left_out) == (MOST_GROUPS, 7)
    assert found.total.picks == 4 * (MOST_GROUPS + 7)
    assert found.total.answers == MOST_GROUPS + 7
