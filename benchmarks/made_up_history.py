"""Journals of many ended runs, written fast: one made-up run, copied under other numbers."""

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from uuid import UUID

from mend.server.access.roles import Role
from mend.server.journal import events as ev
from mend.server.journal import issue_index, run_index, work_index
from mend.server.journal.chain import Chain, Row
from mend.server.journal.issue_index import note_issue
from mend.server.journal.run_index import note
from mend.server.journal.sqlite import INSERT_EVENT, SqliteJournal
from mend.server.journal.upgrades import current_version
from mend.server.journal.work_index import GRASP_STEP, note_work

BEGUN = datetime(2026, 1, 1, tzinfo=UTC)
BETWEEN_RUNS = timedelta(minutes=10)
NUMBER = "ffffffffffff"
"""Stands for the run's number in every id of the made-up run."""
ROBOT = f"pr2-{NUMBER}"
PARTS = 4
STEPS = ("above pick", "pick", "close gripper", "above pick", "above place", "place")
STEPS += ("open gripper", "above place")
INDEXED = {
    *run_index.INDEXED_TYPES,
    *issue_index.INDEXED_TYPES,
    *work_index.INDEXED_TYPES,
}
ANNA = ev.Author(principal="anna", role=Role.HELPER)
JPEG = b"\xff\xd8" + bytes(4000) + b"\xff\xd9"


def id_of(kind: int, number: int) -> UUID:
    """An id of the run of a number; `kind` tells its ids apart (0: the run itself)."""
    return UUID(f"{kind:08x}-0000-4000-8000-{number:012x}")


def run_id(number: int) -> UUID:
    return id_of(0, number)


def picture_id(number: int) -> UUID:
    return id_of(3, number)


def made_up_run() -> list[ev.Event]:
    """A THEN of four parts, one of them dropped and picked up again as a helper said."""
    run = UUID(f"00000000-0000-4000-8000-{NUMBER}")
    events: list[ev.Event] = [_started(run)]
    for part in range(PARTS):
        events += _placed(run, part)
    events.append(ev.RunFinished(**_at(run, 10.0 * PARTS), missing=[]))
    return events


def _at(run: UUID, time_s: float) -> dict[str, Any]:
    return {"time": time_s, "wall_time": BEGUN, "run": run}


def _started(run: UUID) -> ev.RunStarted:
    nodes: list[dict[str, Any]] = [{"kind": "then", "parent": None, "name": "all"}]
    nodes += [
        {
            "kind": "behavior",
            "parent": 0,
            "name": f"part_{part}",
            "behavior": "pick_and_place",
            "parameters": {"object": f"part_{part}", "place": f"place_{part}"},
        }
        for part in range(PARTS)
    ]
    return ev.RunStarted(
        **_at(run, 0.0),
        tree_name="made_up",
        tree={"name": "made_up", "description": "", "scene": None, "nodes": nodes},
        scene={"name": "made_up", "objects": {}, "places": {}},
        world="tabletop",
        robots=[ROBOT],
        seed=0,
        speed="max",
        scenario=None,
        options={"tree": "made_up", "world": "tabletop", "speed": "max"},
    )


def _placed(run: UUID, part: int) -> Iterator[ev.Event]:
    begin = 10.0 * part
    node = {"node": f"/{part}", "name": f"part_{part}"}
    doing = {"robot": ROBOT, "execution": UUID(f"{10 + part:08x}-0000-4000-8000-{NUMBER}")}
    candidate = ev.Candidate(**node, level=1.0, potential=1.5, attempts=0)
    yield ev.NodeStarted(
        **_at(run, begin), **node, **doing, boot="boot", attempt=1, candidates=[candidate]
    )
    for step, name in enumerate(STEPS, start=1):
        yield ev.StepStarted(**_at(run, begin + step), **node, **doing, step=step, step_name=name)
        if part == 1 and step == 5:
            yield from _dropped(_at(run, begin + step) | node, doing)
    yield ev.NodeDone(**_at(run, begin + 9), **node, robot=ROBOT, by="robot")


def _dropped(at: dict[str, Any], doing: dict[str, Any]) -> Iterator[ev.Event]:
    issue = {"robot": ROBOT, "issue": "dropped", "object": at["name"]}
    yield ev.IssueRaised(
        **at, **issue, place="place_1", execution=doing["execution"], step=5, interrupts=True,
        picture=UUID(f"00000003-0000-4000-8000-{NUMBER}"),
    )  # fmt: skip
    dialogue = {**at, **issue, "dialogue": UUID(f"00000001-0000-4000-8000-{NUMBER}")}
    prompt = UUID(f"00000002-0000-4000-8000-{NUMBER}")
    yield ev.DialogueOpened(**dialogue)
    yield ev.Prompt(**dialogue, prompt=prompt, version=1, kind="ask", text="Shall I go on?")
    by = {"helper": "anna", "author": ANNA}
    yield ev.Answered(**dialogue, **by, prompt=prompt, version=1, answer="yes")
    yield ev.DialogueClosed(**dialogue, reason="resolved")
    resumed = {name: at[name] for name in ("time", "wall_time", "run")}
    yield ev.RobotResumed(**resumed, robot=ROBOT, step=5)


@dataclass(frozen=True, slots=True)
class _Template:
    """The texts of a run's events, before and after their `seq`."""

    types: Sequence[str]
    times: Sequence[float]
    rests: Sequence[str]

    def rows(self, number: int, first_seq: int) -> list[Row]:
        own, version = f"{number:012x}", current_version()
        moment = (BEGUN + number * BETWEEN_RUNS).isoformat().replace("+00:00", "Z")
        return [
            (
                first_seq + index, str(run_id(number)), kind, time, version,
                f'{{"seq":{first_seq + index}'
                + rest.replace(NUMBER, own).replace("2026-01-01T00:00:00Z", moment),
            )
            for index, (kind, time, rest) in enumerate(
                zip(self.types, self.times, self.rests, strict=True)
            )
        ]  # fmt: skip


def write_history(path: Path, runs: int, *, pictures: bool = False, first: int = 0) -> None:
    """Add so many ended runs to a journal, which is made if it is not there."""
    events = made_up_run()
    texts = [event.model_dump_json() for event in events]
    assert all(text.startswith('{"seq":0,') for text in texts), "the number comes first"
    template = _Template(
        [str(vars(event)["type"]) for event in events],
        [event.time for event in events],
        [text.removeprefix('{"seq":0') for text in texts],
    )
    SqliteJournal(path).close()
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("PRAGMA synchronous=OFF")
        (head,) = connection.execute("SELECT coalesce(max(last), 0) FROM batches").fetchone()
        chain = Chain(connection)
        connection.execute("BEGIN")
        for number in range(first, first + runs):
            chain.begin()
            rows = template.rows(number, head + 1)
            head += len(rows)
            connection.executemany(INSERT_EVENT, rows)
            for row in rows:
                if row[2] in INDEXED and (row[2] != "step_started" or GRASP_STEP in row[5]):
                    event = ev.any_event.validate_json(row[5])
                    note(connection, event, row[5])
                    note_issue(connection, event)
                    note_work(connection, event)
            if pictures:
                connection.execute(
                    "INSERT INTO pictures (id, jpeg) VALUES (?, ?)", (str(picture_id(number)), JPEG)
                )
            chain.add(rows)
            chain.seal(connection)
        connection.execute("COMMIT")
