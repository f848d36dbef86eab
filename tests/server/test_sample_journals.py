"""Journals that earlier versions of Mend wrote are read for ever."""

import json
import sqlite3
from pathlib import Path

import pytest

from mend.server.journal.events import AnyEvent
from mend.server.journal.migrations import MIGRATIONS
from mend.server.journal.run_index import RunPage
from mend.server.journal.sqlite import SqliteJournal
from mend.server.journal.upgrades import (
    UnknownEventVersionError,
    current_version,
    upgrade_text,
)

SAMPLES = sorted((Path(__file__).parent / "journals").glob("v*.sql"))

OF_NO_RUN = {
    "access_changed",
    "document_deleted",
    "document_kept",
    "model_kept",
    "model_deleted",
    "fleet_told",
    "leg_begun",
    "leg_ended",
    "errand_begun",
    "errand_ended",
    "plan_changed",
    "push_ended",
    "push_subscribed",
    "request_changed",
    "sign_in_failed",
    "signed_in",
    "signed_out",
    "site_closed",
    "site_given_back",
    "site_intervention",
    "site_opened",
    "site_restarted",
}
OF_STEERING = {
    "autonomy_set",
    "breakpoint_removed",
    "breakpoint_set",
    "leaf_held",
    "leaf_let_go",
    "leaf_not_preferred",
    "leaf_preferred",
    "leaf_tried_again",
}
OF_CAMERAS = {"recording_begun", "cameras_recorded"}
OF_CALLING = {"handed_on"}
OF_PROMISES = {"help_not_seen_yet", "help_reported", "promise_taken_back"}
OF_PEOPLE = {*OF_PROMISES, *OF_STEERING}
ADDED_SINCE: dict[str, set[str]] = {
    "v1": {
        *OF_NO_RUN,
        *OF_PEOPLE,
        *OF_CAMERAS,
        *OF_CALLING,
        "clip_recorded",
        "deadline_extended",
        "first_look",
        "looked_anew",
        "node_left_out",
        "node_returned",
        "node_taken",
        "node_undone",
        "suspected_false_alarm",
        "way_found",
    },
    "v2": {
        *OF_NO_RUN,
        *OF_PEOPLE,
        *OF_CAMERAS,
        *OF_CALLING,
        "node_taken",
        "first_look",
        "looked_anew",
        "suspected_false_alarm",
        "way_found",
    },
    "v3": {
        *OF_NO_RUN,
        *OF_PEOPLE,
        *OF_CAMERAS,
        *OF_CALLING,
        "node_taken",
        "looked_anew",
        "way_found",
    },
    "v4": {
        *OF_NO_RUN,
        *OF_PEOPLE,
        *OF_CAMERAS,
        *OF_CALLING,
        "node_taken",
        "looked_anew",
        "way_found",
    },
    "v5": {
        *OF_NO_RUN,
        *OF_PEOPLE,
        *OF_CAMERAS,
        *OF_CALLING,
        "node_taken",
        "looked_anew",
        "way_found",
    },
    "v6": {*OF_NO_RUN, *OF_STEERING, *OF_CAMERAS, *OF_CALLING},
    "v7": {*OF_NO_RUN, *OF_STEERING, *OF_CAMERAS, *OF_CALLING},
}
"""The types of events that came after a sample was written."""


def test_there_is_a_sample_of_every_schema_version() -> None:
    assert [sample.stem for sample in SAMPLES] == [f"v{n}" for n in range(1, len(MIGRATIONS) + 1)]


@pytest.fixture(params=SAMPLES, ids=lambda sample: sample.stem)
def sample_journal(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    path = tmp_path / f"{request.param.stem}.db"
    connection = sqlite3.connect(path)
    connection.executescript(request.param.read_text())
    connection.close()
    return path


async def test_sample_is_read_completely(sample_journal: Path) -> None:
    journal = SqliteJournal(sample_journal)
    events = await journal.read(0, 10_000)
    assert [event.seq for event in events] == list(range(1, journal.head + 1))
    assert {event.type for event in events} == every_event_type() - ADDED_SINCE[sample_journal.stem]
    (indexed,) = await journal.index.page(RunPage())
    run = indexed.run
    assert (indexed.status, indexed.tree) == ("aborted", "eket")
    assert journal.damage == []
    assert await journal.read(0, 10_000, run) == events
    assert await journal.world(run) is not None
    issue = next(event for event in events if event.type == "issue_raised")
    assert await journal.picture(issue.picture) is not None
    assert await journal.received(issue.robot, "boot-1") > 0
    assert await journal.documents("tree")
    journal.close()


def every_event_type() -> set[str]:
    union = AnyEvent.__origin__  # type: ignore[attr-defined]
    return {each.model_fields["type"].default for each in union.__args__}


def test_event_of_an_older_version_goes_through_every_upgrade_in_turn() -> None:
    upgrades = (
        lambda event: {"second": event["first"]},
        lambda event: {**event, "third": event["second"] + 1},
    )
    assert current_version(upgrades) == 3
    assert json.loads(upgrade_text('{"first": 1}', 1, upgrades)) == {"second": 1, "third": 2}
    assert json.loads(upgrade_text('{"second": 5}', 2, upgrades)) == {"second": 5, "third": 6}
    assert upgrade_text('{"third": 9}', 3, upgrades) == '{"third": 9}'


def test_event_of_a_newer_version_is_refused() -> None:
    with pytest.raises(UnknownEventVersionError, match="version 4"):
        upgrade_text("{}", 4, ())
