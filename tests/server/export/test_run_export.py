"""A run as a file: what other programs read in it is what the journal has."""

import base64
import csv
import io
import json
import struct
from collections import defaultdict
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import jsonschema_rs
import pytest
from fake_runs import FakeRuns
from foxglove_rules import mistakes_in
from mcap.reader import make_reader
from recorded_service import recorded_events
from service_under_test import build
from shown_run import hello, poses, run_state

from mend.errors import NotFoundError
from mend.server.export.csv_file import COLUMNS
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal
from mend.server.poses.bases import SeenBase
from mend.server.poses.frame import decode, encode
from mend.server.poses.layout import lay_out
from mend.server.poses.record import PoseRecords
from mend.server.runtime.run_views import summary_of_indexed
from mend.server.runtime.views import RunSummary
from mend.server.transcript import Transcript

RECORDED = recorded_events()
RUN = RECORDED[0].run
END_S = RECORDED[-1].time


class IndexedRuns(FakeRuns):
    """The runs that the journal's index has."""

    async def run_summary(self, run: UUID) -> RunSummary:
        found = await self._journal.index.find(run)
        if found is None:
            raise NotFoundError(f"there is no run {run}")
        return summary_of_indexed(found)


@dataclass(frozen=True)
class Exported:
    """A service with a run that has ended, its events and the pictures that are kept."""

    client: httpx.AsyncClient
    journal: SqliteJournal
    events: Sequence[ev.Event]
    pictures: dict[UUID, bytes]
    times: Sequence[float]

    async def file(self, form: str) -> bytes:
        response = await self.client.get(f"/api/runs/{RUN}/export", params={"format": form})
        assert response.status_code == 200, response.text
        name = response.headers["content-disposition"]
        assert name.startswith('attachment; filename="eket-2026')
        assert name.endswith(f'.{form}"')
        return response.content


@pytest.fixture
async def exported(tmp_path: Path) -> AsyncIterator[Exported]:
    records = PoseRecords(tmp_path / "poses")
    service = build(runs_in=IndexedRuns, records=records)
    named = [each.picture for each in RECORDED if isinstance(each, ev.IssueRaised) and each.picture]
    pictures = {each: b"\xff\xd8 jpeg %d" % number for number, each in enumerate(named)}
    await service.journal.append(Entry(events=RECORDED, pictures=pictures))
    record = records.open(RUN)
    times = [step / 10 for step in range(round(END_S * 10))]
    for number, time_s in enumerate(times):
        record.add(encode(number, time_s, poses(time_s / 100)))
    shows = hello().shows
    assert shows is not None
    records.keep_layout(lay_out(run_state(RUN), hello(), shows, None))
    events = await service.journal.read(0, 10_000, RUN)
    async with service.client() as client:
        yield Exported(client, service.journal, events, pictures, times)
    service.poses.shut()
    service.journal.close()


async def test_the_table_has_a_row_for_each_event_in_columns_that_stay(exported: Exported) -> None:
    told = (await exported.file("csv")).decode()
    rows = list(csv.DictReader(io.StringIO(told, newline="")))
    assert told.splitlines()[0] == ",".join(COLUMNS)
    assert ",".join(COLUMNS) == (
        "seq,time_s,wall_time,type,node,name,robot,issue,object,place,step,dialogue,helper,"
        "told,more"
    )
    assert [(int(row["seq"]), row["type"]) for row in rows] == [
        (each.seq, vars(each)["type"]) for each in exported.events
    ]
    transcript = Transcript()
    for row, event in zip(rows, exported.events, strict=True):
        assert float(row["time_s"]) == event.time
        wanted = event.model_dump(mode="json")
        for column in ("node", "name", "robot", "issue", "object", "place", "dialogue", "helper"):
            assert row[column] == (wanted.get(column) or "")
        assert row["told"] == "; ".join(
            f"{each.opening}{each.text}" for each in transcript.lines(event)
        )
        more = json.loads(row["more"] or "{}")
        assert all(wanted[name] == value for name, value in more.items())
        assert set(wanted) <= {
            *row, *more, "time", "run", "tree", "scene", "script",
        }  # fmt: skip


@dataclass(frozen=True)
class Message:
    schema: str
    time_s: float
    said: dict[str, Any]


def messages_of(file: bytes, began: ev.Event) -> dict[str, list[Message]]:
    """What the library reads in the file, by topic, each checked against its own schema."""
    found = defaultdict(list)
    zero_ns = began.wall_time.timestamp() - began.time
    for schema, channel, message in make_reader(io.BytesIO(file)).iter_messages():
        assert schema is not None
        assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
        said = json.loads(message.data)
        jsonschema_rs.validate(json.loads(schema.data), said)
        time_s = message.log_time / 1e9 - zero_ns
        found[channel.topic].append(Message(schema.name, time_s, said))
    return found


async def test_foxglove_reads_the_events_and_what_the_transcript_tells(exported: Exported) -> None:
    found = messages_of(await exported.file("mcap"), exported.events[0])
    records = await exported.journal.read_records(0, 10_000, RUN)
    assert [each.said for each in found["/events"]] == [json.loads(each.text) for each in records]
    for message, event in zip(found["/events"], exported.events, strict=True):
        assert message.time_s == pytest.approx(event.time, abs=1e-5)
    transcript = Transcript()
    lines = [line for each in exported.events for line in transcript.lines(each)]
    told = found["/log"]
    assert [each.said["message"] for each in told] == [line.opening + line.text for line in lines]
    assert {each.schema for each in told} == {"foxglove.Log"}
    assert {each.said["level"] for each in told} == {1, 2, 3}


async def test_and_the_pictures_that_are_kept(exported: Exported) -> None:
    found = messages_of(await exported.file("mcap"), exported.events[0])
    images = [
        each for topic, some in found.items() if topic.startswith("/pictures/") for each in some
    ]
    assert {each.schema for each in images} == {"foxglove.CompressedImage"}
    kept = [base64.b64decode(each.said["data"]) for each in images]
    assert sorted(kept) == sorted(exported.pictures.values())
    raised = [each.time for each in exported.events if isinstance(each, ev.IssueRaised)]
    assert sorted(each.time_s for each in images) == pytest.approx(raised, abs=1e-5)


async def test_and_where_everything_was(exported: Exported) -> None:
    found = messages_of(await exported.file("mcap"), exported.events[0])
    assert [each.time_s for each in found["/tf"]] == pytest.approx(exported.times, abs=1e-5)
    [base, tool, cup] = found["/tf"][0].said["transforms"]
    assert (base["parent_frame_id"], base["child_frame_id"]) == ("scene", "arm/base")
    assert (tool["parent_frame_id"], tool["child_frame_id"]) == ("arm/base", "arm/tool")
    assert (cup["parent_frame_id"], cup["child_frame_id"]) == ("arm/base", "cup")
    assert cup["translation"] == {"x": 0.5, "y": 0.1, "z": 0.7}
    joints = [each.said["joints"][0]["position"] for each in found["/joints"]]
    assert joints == pytest.approx([each / 100 for each in exported.times], abs=1e-6)
    assert {each.said["opening_m"] for each in found["/arm/gripper"]} == {0.05}
    [scene] = found["/scene"]
    assert {each["id"] for each in scene.said["entities"]} == {"cup", "arm/table"}


async def test_there_is_nothing_in_it_that_foxglove_would_not_show(exported: Exported) -> None:
    assert mistakes_in(await exported.file("mcap"), decodes=False) == []


async def test_a_run_of_which_nothing_was_recorded_has_its_events(exported: Exported) -> None:
    other = UUID(int=9)
    events = [each.model_copy(update={"run": other, "seq": 0}) for each in RECORDED]
    await exported.journal.append(Entry(events=events))
    response = await exported.client.get(f"/api/runs/{other}/export", params={"format": "mcap"})
    found = messages_of(response.content, events[0])
    assert set(found) == {"/events", "/log"} | {
        topic for topic in found if topic.startswith("/pictures/")
    }
    assert len(found["/events"]) == len(events)


@pytest.mark.parametrize(
    ("run", "form", "status"), [(UUID(int=7), "csv", 404), (RUN, "xlsx", 422), (RUN, "", 422)]
)
async def test_what_there_is_not_is_refused(
    exported: Exported, run: UUID, form: str, status: int
) -> None:
    response = await exported.client.get(f"/api/runs/{run}/export", params={"format": form})
    assert response.status_code == status


def test_a_frame_is_read_as_it_was_made() -> None:
    base = SeenBase((1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0), 0.5)
    made = poses(0.25, joints=3, held=True)
    read = decode(encode(7, 12.5, made, [base]))
    assert (read.time_s, list(read.joints)) == (12.5, [0.25] * 3)
    assert read.base == made.base
    assert read.tool == pytest.approx(made.tool)
    assert read.opening_m == pytest.approx(made.opening_m)
    [held] = read.objects
    assert (held.held, held.gone, held.hidden) == (True, False, False)
    [seen] = read.robots
    assert (seen.pose, seen.age_s) == (base.pose, 0.5)
    with pytest.raises(struct.error):
        decode(b"\0" * 20)
