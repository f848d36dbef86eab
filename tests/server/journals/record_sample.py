"""Writes the sample journal of the newest schema version: one event of every type that a run has.

Run it once when a version is added, from the root; what it wrote is never changed again.
"""

import asyncio
import sqlite3
import tempfile
from datetime import UTC, datetime
from itertools import count
from pathlib import Path
from typing import Any
from uuid import UUID

from mend.dialogue.script import CloseReason, Help, Sight
from mend.robots.link.messages import Detection
from mend.server.journal import events as ev
from mend.server.journal.journal import Document, Entry, Receipt
from mend.server.journal.migrations import MIGRATIONS
from mend.server.journal.sqlite import SqliteJournal
from mend.tasks.intervention import Act, Intervention
from mend.tasks.resolution import Resolution

RUN = UUID("0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11")
EXECUTION = UUID("5d0f2c1e-0a44-4a0c-8a3e-9f6f3f2b1a01")
DIALOGUE = UUID("c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02")
PROMPT = UUID("9a3b1c2d-1f2e-4d3c-8b4a-6e5f7a8b9c03")
PICTURE = UUID("3e2d1c0b-9a8f-4e7d-8c6b-5a4f3e2d1c04")

WALL_TIME = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)

_ticks = count(1)


def stamp() -> dict[str, Any]:
    """What every event has, half a second after the one before."""
    tick = next(_ticks)
    return {"time": tick / 2, "wall_time": datetime(2026, 1, 2, 3, 4, tick, tzinfo=UTC), "run": RUN}


def node() -> dict[str, Any]:
    return {**stamp(), "node": "/1/0", "name": "pink_bar"}


def robot() -> dict[str, Any]:
    return {**stamp(), "robot": "robot"}


def work() -> dict[str, Any]:
    return {**node(), "robot": "robot", "execution": EXECUTION}


def talk() -> dict[str, Any]:
    return {
        **node(),
        "dialogue": DIALOGUE,
        "robot": "robot",
        "issue": "dropped",
        "object": "pink_bar",
    }


def answers() -> list[ev.AnswerOption]:
    return [
        ev.AnswerOption(value="yes", effect="The robot tries again."),
        ev.AnswerOption(value="no", effect="You put the pink bar to its place."),
    ]


def every_event() -> list[ev.Event]:
    """One event of every type that a run has, in an order that could be."""
    leaf = {"behavior": "pick_and_place", "object": "pink_bar", "place": "pink_place"}
    candidate = ev.Candidate(node="/1/0", name="pink_bar", level=0.5, potential=1.7, attempts=0)
    missing = ev.MissingPart(node="/1/0", name="pink_bar", object="pink_bar", place="pink_place")
    detection = Detection(
        camera="forearm", expected=(160.0, 120.0), tolerance_px=40.0, explanation="no blob is left"
    )
    return [
        ev.RunStarted(
            **stamp(),
            tree_name="eket",
            tree={"name": "eket", "scene": "eket", "then": [leaf]},
            scene={"name": "eket", "objects": {}, "places": {}},
            world="workcell",
            robots=["robot"],
            seed=7,
            speed="max",
            scenario="eket_paper",
            script={"name": "eket_paper", "tree": "eket"},
            options={"max_attempts": 3},
        ),
        ev.NodeStarted(**work(), boot="boot-1", attempt=1, candidates=[candidate]),
        ev.StepStarted(**work(), step=4, step_name="above pick"),
        ev.IssueRaised(
            **work(),
            issue="dropped",
            object="pink_bar",
            place="pink_place",
            step=4,
            interrupts=True,
            detection=detection,
            picture=PICTURE,
        ),
        ev.RobotHolding(**robot(), at="neutral"),
        ev.DialogueOpened(**talk()),
        ev.Prompt(
            **talk(),
            prompt=PROMPT,
            version=1,
            kind="ask",
            text="I dropped the pink bar. Shall I try again?",
            answers=answers(),
            deadline=40.0,
            to="anna",
        ),
        ev.FirstLook(**talk(), fulfilled=[], position=(0.6, -0.2, 0.7)),
        ev.ClipRecorded(
            **work(),
            issue="dropped",
            dialogue=DIALOGUE,
            pictures=[ev.ClipPicture(time=1.0, picture=PICTURE)],
        ),
        ev.Claimed(**talk(), helper="anna", lease_until=datetime(2026, 1, 2, 3, 5, tzinfo=UTC)),
        ev.Released(**talk(), helper="anna", expired=True),
        ev.Escalated(**talk(), channel="mail", to="operators@example.com"),
        ev.HandedOn(**talk(), helper="anna", to="ben"),
        ev.DeadlineExtended(
            **talk(),
            prompt=PROMPT,
            version=2,
            deadline=80.0,
            extensions_left=9,
            helper="ben",
        ),
        ev.Answered(**talk(), prompt=PROMPT, version=2, answer="yes", helper="ben"),
        ev.HelpAwaited(**talk(), help=Help.PUT_BACK, helper="ben", until=90.0),
        ev.HelpReported(**talk(), help=Help.PUT_BACK, helper="anna"),
        ev.HelpNotSeenYet(**talk(), help=Help.PUT_BACK, sight=Sight.UNMOVED, picture=PICTURE),
        ev.LookedAnew(**talk(), fulfilled=[], position=None),
        ev.HelpNotSeen(**talk(), help=Help.PUT_BACK),
        ev.PromiseTakenBack(**talk(), help=Help.PUT_BACK, helper="ben"),
        ev.InterventionDone(
            **stamp(),
            act="put_back",
            object="pink_bar",
            intervention=Intervention(act=Act.PUT_BACK, object="pink_bar"),
            by="helper",
        ),
        ev.HelpVerified(**talk(), help=Help.PUT_BACK),
        ev.Resolved(**talk(), resolution=Resolution.ROBOT_RETRY, helped=True),
        ev.DialogueClosed(**talk(), reason=CloseReason.RESOLVED),
        ev.NodeReset(**node(), robot="robot", reason="robot_retry", failed_attempt=False),
        ev.RobotLost(**robot(), reason="the process ended"),
        ev.RobotBack(**robot(), boot="boot-2", continues=False),
        ev.RobotResumed(**robot(), step=1),
        ev.NodeDone(**node(), robot="robot", by="robot"),
        ev.NodeUndone(**node(), robot="robot", reason="the pink bar is gone"),
        ev.NodeLeftOut(**node(), robot="robot", helper="ben"),
        ev.NodeReturned(**node(), robot="robot"),
        ev.NodeTaken(**node(), helper="ben", until=120.0, was_at=(0.6, -0.2, 0.7)),
        ev.WayFound(**robot(), finding="blocked", between=["F1-101", "F1-102"]),
        ev.NodeAbandoned(**node(), leaf="/1/0", reason="no robot can reach it"),
        ev.SuspectedFalseAlarm(
            **node(), robot="robot", issue="dropped", object="pink_bar", times=3, told=["operators"]
        ),
        ev.RunPaused(**stamp()),
        ev.RunResumed(**stamp()),
        ev.RunFinished(**stamp(), missing=[missing]),
        ev.RunFailed(**stamp(), reason="the leaf /1/0 could not be done", node="/1/0"),
        ev.RunAborted(**stamp(), reason="by the operator"),
        ev.InterventionAccepted(
            **stamp(),
            act="steal",
            object="pink_bar",
            intervention=Intervention(act=Act.STEAL, object="pink_bar"),
            by="api",
            command="7f6e5d4c-3b2a-4190-8f7e-6d5c4b3a2905",
        ),
    ]


async def record(path: Path) -> None:
    journal = SqliteJournal(path, wall_time_s=WALL_TIME.timestamp)
    for number, event in enumerate(every_event(), 1):
        entry = Entry(
            events=[event],
            receipt=Receipt("robot", "boot-1", number),
            world_run=RUN,
            world={"clock": event.time},
            pictures={PICTURE: b"\xff\xd8\xff\xd9"} if isinstance(event, ev.IssueRaised) else {},
        )
        await journal.append(entry)
    text = "then:\n- {behavior: pick_and_place, object: pink_bar}\n"
    await journal.append(Entry(document=Document("tree", "mine", text)))
    journal.close()


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "journal.db"
        asyncio.run(record(path))
        connection = sqlite3.connect(path)
        sample = "\n".join(connection.iterdump()) + "\n"
        connection.close()
    (Path(__file__).parent / f"v{len(MIGRATIONS)}.sql").write_text(sample)


if __name__ == "__main__":
    main()
