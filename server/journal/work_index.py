"""The index of work: how often each robot picked each part, and how long people took to answer."""

import sqlite3
from collections.abc import Callable, Mapping
from typing import Any

from mend.server.journal import events as ev

INDEXED_TYPES = ("step_started", "prompt", "answered")
"""The types of events that change the index."""

GRASP = "grasp"
"""The phase of the step in which a gripper closes: a pick."""

GRASP_STEP = "close gripper"
"""What that step is called, where an older Mend did not tell its phase."""


def note_work(connection: sqlite3.Connection, event: ev.Event) -> None:
    """Change the index as an event says."""
    change = _NOTES.get(type(event))
    if change is not None:
        change(connection, event)


def forget_work_of_run(connection: sqlite3.Connection, run: str) -> None:
    """Take a run's picks and questions out of the index."""
    connection.execute("DELETE FROM picks WHERE run = ?", (run,))
    connection.execute("DELETE FROM questions WHERE run = ?", (run,))


def is_pick(event: ev.StepStarted) -> bool:
    """Whether a gripper closes in this step to take something."""
    return event.phase == GRASP or (event.phase is None and event.step_name == GRASP_STEP)


def _pick(connection: sqlite3.Connection, event: ev.StepStarted) -> None:
    if is_pick(event):
        connection.execute(
            "INSERT INTO picks (run, robot, part, picks) VALUES (?, ?, ?, 1)"
            " ON CONFLICT DO UPDATE SET picks = picks + 1",
            (str(event.run), event.robot, event.object or event.name),
        )


def _ask(connection: sqlite3.Connection, event: ev.Prompt) -> None:
    """A question that is put again keeps when it was put first."""
    if event.kind == "ask":
        connection.execute(
            "INSERT OR IGNORE INTO questions (prompt, run, robot, issue, part, asked)"
            " VALUES (?, ?, ?, ?, ?, ?)",
            (
                str(event.prompt), str(event.run), event.robot, event.issue,
                event.object or event.name, event.wall_time.timestamp(),
            ),
        )  # fmt: skip


def _answer(connection: sqlite3.Connection, event: ev.Answered) -> None:
    """What a script answers tells nothing of people, and has no author."""
    if event.author is not None:
        connection.execute(
            "UPDATE questions SET answer_s = max(0.0, ? - asked) WHERE prompt = ?",
            (event.wall_time.timestamp(), str(event.prompt)),
        )


_NOTES: Mapping[type[ev.Event], Callable[[sqlite3.Connection, Any], None]] = {
    ev.StepStarted: _pick,
    ev.Prompt: _ask,
    ev.Answered: _answer,
}
