"""A file of a run is made piece by piece, however long the run is."""

import csv
import io
import json
import math
from collections.abc import AsyncIterator
from contextlib import closing
from pathlib import Path
from uuid import UUID

import pytest
from fake_runs import FakeRuns
from long_run import long_run
from mcap.reader import make_reader
from service_under_test import ServiceUnderTest, build
from shown_run import hello, poses, run_state

from mend.errors import NotFoundError
from mend.server.export.mcap_file import CHUNK_BYTES
from mend.server.export.run_file import Format
from mend.server.export.run_pieces import PIECE_BYTES, RunSource, pieces_of
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.stored_event import read_event
from mend.server.journal.subscriptions import Record
from mend.server.off_loop import MUCH_CHARS
from mend.server.poses.frame import Frame, encode, framed
from mend.server.poses.layout import lay_out
from mend.server.poses.record import RecordedFrames
from mend.server.runtime.run_views import summary_of_indexed
from mend.server.runtime.views import RunSummary

RUN_EVENTS = [
    each.model_copy(update={"seq": number})
    for number, each in enumerate(long_run(groups=5, leaves=20), 1)
]
FRAMES = 3000
LONGEST = PIECE_BYTES + CHUNK_BYTES


class LongRun:
    """A long run with recorded poses, which counts the events that were read of it."""

    def __init__(self, path: Path) -> None:
        every_s = RUN_EVENTS[-1].time / FRAMES
        path.write_bytes(
            framed([encode(number, number * every_s, poses()) for number in range(FRAMES)])
        )
        self._frames = RecordedFrames(path)
        self.read = 0
        shows = hello().shows
        assert shows is not None
        layout = lay_out(run_state(), hello(), shows, None)
        self.source = RunSource(self._records(), self._event, self._picture, self._until, layout)

    async def _records(self) -> AsyncIterator[Record]:
        for each in RUN_EVENTS:
            self.read += 1
            yield Record(each.seq, each.model_dump_json())

    async def _event(self, record: Record) -> ev.Event:
        return read_event(record.seq, record.text)

    async def _picture(self, picture: UUID) -> bytes | None:  # noqa: ARG002 - none is kept
        return None

    def close(self) -> None:
        self._frames.close()

    async def _until(self, time_s: float) -> list[Frame]:
        return self._frames.until(time_s)


@pytest.mark.parametrize("form", Format)
async def test_no_more_of_it_is_ever_there_than_a_piece(form: Format, tmp_path: Path) -> None:
    pieces: list[bytes] = []
    with closing(LongRun(tmp_path / "run.poses")) as run:
        async for piece in pieces_of(run.source, form):
            if not pieces:
                # The first goes out long before the last event is read.
                assert run.read < len(RUN_EVENTS) / 2
            pieces.append(piece)
    assert len(pieces) > 3
    assert max(map(len, pieces)) < LONGEST
    whole = io.BytesIO(b"".join(pieces))
    if form is Format.CSV:
        rows = list(csv.DictReader(io.TextIOWrapper(whole, "utf-8", newline="")))
        assert [int(each["seq"]) for each in rows] == [each.seq for each in RUN_EVENTS]
    else:
        reader = make_reader(whole)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        topics = {channel.topic: number for number, channel in summary.channels.items()}
        counts = summary.statistics.channel_message_counts
        assert counts[topics["/events"]] == len(RUN_EVENTS)
        assert counts[topics["/tf"]] == FRAMES
        # In the order of their times, so that a reader needs little of it at once.
        times = [each.message_start_time for each in summary.chunk_indexes]
        assert times == sorted(times)


class OneRun(FakeRuns):
    """The run that the journal's index has."""

    async def run_summary(self, run: UUID) -> RunSummary:
        found = await self._journal.index.find(run)
        if found is None:
            raise NotFoundError(f"there is no run {run}")
        return summary_of_indexed(found)


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    service = build(runs_in=OneRun)
    yield service
    service.journal.close()


async def test_a_beginning_of_megabytes_is_read_elsewhere_and_whole_in_the_file(
    service: ServiceUnderTest,
) -> None:
    begun = run_state().started
    large = {"name": "bench", "objects": {}, "places": {}, "words": "x" * (MUCH_CHARS + 1)}
    began = begun.model_copy(update={"scene": large})
    ended = ev.RunAborted(time=math.pi, wall_time=began.wall_time, run=began.run)
    await service.journal.append(Entry(events=[began, ended]))
    async with service.client() as client:
        table = await client.get(f"/api/runs/{began.run}/export", params={"format": "csv"})
        file = await client.get(f"/api/runs/{began.run}/export", params={"format": "mcap"})
    rows = list(csv.DictReader(io.StringIO(table.text, newline="")))
    assert [row["type"] for row in rows] == ["run_started", "run_aborted"]
    assert "scene" not in json.loads(rows[0]["more"])
    reader = make_reader(io.BytesIO(file.content))
    first = next(iter(reader.iter_messages(topics=["/events"])))[2]
    assert json.loads(first.data)["scene"] == large
