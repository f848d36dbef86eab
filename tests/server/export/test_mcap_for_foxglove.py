"""What is exported for Foxglove keeps to its rules, whatever a run has and things are called."""

import io
from collections.abc import AsyncIterator, Sequence
from datetime import UTC, datetime
from uuid import UUID

import pytest
from foxglove_rules import mistakes_in
from mcap.reader import make_reader
from mcap.writer import Writer
from recorded_service import recorded_events
from shown_run import SHOWS, hello, poses, run_state

from mend.robots.link.messages import ShownObject
from mend.server.export.foxglove import Log, Time
from mend.server.export.mcap_file import McapFile
from mend.server.export.run_file import ShownPicture
from mend.server.export.run_order import AHEAD_S, ToldEvent, in_order
from mend.server.journal import events as ev
from mend.server.journal.subscriptions import Record
from mend.server.poses.bases import NEVER_SEEN, SeenBase
from mend.server.poses.frame import Frame, encode
from mend.server.poses.layout import Layout, lay_out

BEGAN = datetime(2026, 1, 2, tzinfo=UTC)
RAISED = next(each for each in recorded_events() if isinstance(each, ev.IssueRaised))
AT = (1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def layout(*names: str, drives: bool = False) -> Layout:
    objects = [ShownObject(name=each, size=(0.1, 0.1, 0.1)) for each in names]
    shows = SHOWS.model_copy(update={"objects": objects})
    laid = lay_out(run_state(), hello(), shows, None)
    return laid.model_copy(update={"robots": ["arm"] if drives else []})


def file_of(of: Layout, frames: Sequence[Frame]) -> bytes:
    file = McapFile(BEGAN, 0.0, of)
    for each in frames:
        file.add_frame(each)
    return file.end()


def frame(number: int, time_s: float, things: int, base: SeenBase | None = None) -> Frame:
    shown = poses()
    told = shown.model_copy(update={"objects": shown.objects * things})
    return encode(number, time_s, told, [] if base is None else [base])


def times_of(file: bytes, topic: str) -> list[float]:
    messages = make_reader(io.BytesIO(file)).iter_messages(topics=[topic], log_time_order=False)
    return [message.log_time / 1e9 - BEGAN.timestamp() for _, _, message in messages]


def test_things_may_be_called_as_what_is_there_anyway() -> None:
    names = ("scene", "table", "cup")
    assert mistakes_in(file_of(layout(*names), [frame(1, 0.0, 3)])) == []


def test_what_hangs_at_a_robot_that_is_nowhere_yet_is_nowhere_yet() -> None:
    of = layout("cup", drives=True)
    frames = [frame(1, 0.0, 1, NEVER_SEEN), frame(2, 1.0, 1, SeenBase(AT, 0.0))]
    assert mistakes_in(file_of(of, frames)) == []


def test_what_a_service_that_was_started_again_records_once_more_goes_not_back() -> None:
    times = (0.0, 1.0, 2.0, 1.5, 1.9, 2.1)
    frames = [frame(number, each, 1) for number, each in enumerate(times)]
    file = file_of(layout("cup"), frames)
    assert times_of(file, "/tf") == pytest.approx([0.0, 1.0, 2.0, 2.1])
    assert mistakes_in(file) == []


def event(seq: int, time_s: float) -> ev.IssueRaised:
    return RAISED.model_copy(update={"seq": seq, "time": time_s, "picture": None})


def clip(seq: int, time_s: float, *of_s: float) -> ev.ClipRecorded:
    """A clip that is told of at a time, with pictures of others."""
    pictures = [
        ev.ClipPicture(picture=UUID(int=100 * seq + number), time=each)
        for number, each in enumerate(of_s)
    ]
    raised = RAISED.model_dump(include={"node", "name", "robot", "issue"})
    return ev.ClipRecorded(
        **raised, seq=seq, time=time_s, wall_time=BEGAN, run=RAISED.run,
        execution=UUID(int=1), dialogue=UUID(int=2), pictures=pictures,
    )  # fmt: skip


async def order_of(*events: ev.Event) -> list[float | str]:
    """Times of events, and of pictures with a `p` before them, in the order of a file."""
    by_seq = {each.seq: each for each in events}

    async def records() -> AsyncIterator[Record]:
        for each in events:
            yield Record(each.seq, "{}")

    async def read(record: Record) -> ev.Event:
        return by_seq[record.seq]

    return [
        each.time_s if isinstance(each, ToldEvent) else f"p{each.time_s:g}"
        async for each in in_order(records(), read)
    ]


async def test_pictures_come_at_their_time_though_a_clip_is_told_of_later() -> None:
    told = await order_of(event(1, 0.0), event(2, 3.0), event(3, 4.0), clip(4, 5.0, 2.0, 3.5))
    assert told == [0.0, "p2", 3.0, "p3.5", 4.0, 5.0]


async def test_a_file_begins_with_the_run_whatever_was_seen_before() -> None:
    assert await order_of(event(1, 10.0), clip(2, 11.0, 9.0)) == [10.0, "p9", 11.0]


async def test_nothing_waits_for_pictures_for_ever() -> None:
    late = AHEAD_S + 1.0
    told = await order_of(event(1, 0.0), event(2, 1.0), event(3, late), clip(4, late, 0.5))
    assert told == [0.0, "p0.5", 1.0, late, late]
    told = await order_of(event(1, 0.0), event(2, 1.0), event(3, 2 * late), clip(4, 2 * late, 0.5))
    assert told == [0.0, 1.0, "p0.5", 2 * late, 2 * late]


def test_a_schema_with_references_is_found_as_no_reader_follows_them() -> None:
    written = io.BytesIO()
    writer = Writer(written)
    writer.start()
    schema = str(Log.model_json_schema()).replace("'", '"').replace("False", "false")
    number = writer.register_schema("foxglove.Log", "jsonschema", schema.encode())
    channel = writer.register_channel("/log", "json", number)
    log = Log(timestamp=Time(sec=0, nsec=0), level=2, message="a", name="b")
    writer.add_message(channel, 5, log.model_dump_json().encode(), 5)
    writer.add_message(channel, 4, log.model_dump_json().encode(), 4)
    writer.finish()
    found = mistakes_in(written.getvalue())
    assert "foxglove.Log is not Foxglove's" in found
    assert "foxglove.Log.timestamp is of no type: ['$ref']" in found
    assert "/log goes back by 1 ns" in found


def test_a_picture_that_is_none_is_found() -> None:
    file = McapFile(BEGAN, 0.0, None)
    file.add_picture(ShownPicture(UUID(int=1), "arm", "head", 1.0), b"no picture")
    assert mistakes_in(file.end()) == ["/pictures/arm/head has a picture that is none"]
