"""Recorded poses: thinned to twenty a second and to a bounded size, whole again after a kill."""

import asyncio
import math
import threading
from collections.abc import AsyncIterator
from pathlib import Path
from uuid import UUID

import pytest
from sample_events import RUN
from shown_run import hello, poses, run_state

from mend.server.poses.frame import Frame, encode, framed, time_of
from mend.server.poses.layout import lay_out
from mend.server.poses.record import MOST_WAITING, PAGE_BYTES, PoseRecords

ALL = (0.0, 1e9, 100_000)


def frame(time_s: float) -> Frame:
    return encode(0, time_s, poses())


@pytest.fixture
async def records(tmp_path: Path) -> AsyncIterator[PoseRecords]:
    records = PoseRecords(tmp_path / "poses")
    yield records
    records.shut()


async def test_frames_are_read_in_order_before_and_after_the_end_of_the_run(
    records: PoseRecords,
) -> None:
    record = records.open(RUN)
    frames = [frame(step / 10) for step in range(30)]
    for each in frames:
        record.add(each)
    assert list((await records.read(RUN, *ALL)).frames) == frames
    records.close(RUN)
    read = await records.read(RUN, *ALL)
    assert list(read.frames) == frames
    assert read.span_s == (0.0, 2.9)
    assert await records.last(RUN) == frames[-1]


async def test_all_frames_are_read_in_pieces_up_to_one_time_after_the_other(
    records: PoseRecords,
) -> None:
    record = records.open(RUN)
    frames = [frame(step / 10) for step in range(3000)]
    for each in frames:
        record.add(each)
    async with records.all_of(RUN) as read:
        assert await read(-1.0) == []
        assert await read(1.0) == frames[:11]
        assert await read(1.0) == []
        rest = []
        while page := await read(math.inf):
            rest += page
        assert rest == frames[11:]
        assert len(framed(frames)) > 2 * PAGE_BYTES
    async with records.all_of(UUID(int=1)) as read:
        assert await read(math.inf) == []


async def test_nothing_is_recorded_of_a_run_that_showed_nothing(records: PoseRecords) -> None:
    read = await records.read(RUN, *ALL)
    assert (read.frames, read.span_s) == ([], None)
    assert await records.last(RUN) is None
    assert await records.layout(RUN) is None


async def test_no_more_than_twenty_frames_a_second_are_kept(records: PoseRecords) -> None:
    record = records.open(RUN)
    for step in range(1000):
        record.add(frame(step / 100))
    assert 180 <= len((await records.read(RUN, *ALL)).frames) <= 201


async def test_a_span_is_read_and_evenly_thinned_out_to_a_limit(records: PoseRecords) -> None:
    record = records.open(RUN)
    for step in range(100):
        record.add(frame(step / 10))
    span = await records.read(RUN, 2.0, 6.0, 1000)
    assert [time_of(each) for each in span.frames] == [step / 10 for step in range(20, 61)]
    few = [time_of(each) for each in (await records.read(RUN, 0.0, 1e9, 10)).frames]
    assert few == [float(step) for step in range(10)]


async def test_a_long_run_is_thinned_out_over_its_whole_length(tmp_path: Path) -> None:
    records = PoseRecords(tmp_path, most_bytes=50 * len(frame(0)))
    record = records.open(RUN)
    for step in range(400):
        record.add(frame(step / 10))
        if step % 20 == 0:
            record.flush()
            await records.last(RUN)
    times = [time_of(each) for each in (await records.read(RUN, *ALL)).frames]
    records.shut()
    assert (tmp_path / f"{RUN}.poses").stat().st_size <= 50 * len(frame(0))
    assert len(times) > 12
    assert times == sorted(times)
    assert times[0] == 0.0
    assert times[-1] > 35.0


async def test_a_frame_torn_by_a_kill_is_cut_off_and_the_record_goes_on(tmp_path: Path) -> None:
    first = PoseRecords(tmp_path)
    record = first.open(RUN)
    record.add(frame(1.0))
    record.add(frame(2.0))
    first.shut()
    path = tmp_path / f"{RUN}.poses"
    path.write_bytes(path.read_bytes()[:-5])
    second = PoseRecords(tmp_path)
    second.open(RUN).add(frame(3.0))
    times = [time_of(each) for each in (await second.read(RUN, *ALL)).frames]
    second.shut()
    assert times == [1.0, 3.0]


async def test_what_waits_is_written_without_anybody_asking(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.poses.record.FLUSH_S", 0.0)
    records = PoseRecords(tmp_path)
    records.open(RUN).add(frame(1.0))
    async with asyncio.timeout(60):
        while await records.last(RUN) is None:
            pass
    records.shut()


async def test_the_layout_is_kept(records: PoseRecords) -> None:
    said = hello()
    assert said.shows is not None
    layout = lay_out(run_state(), said, said.shows, None)
    records.keep_layout(layout)
    assert await records.layout(RUN) == layout


async def test_a_layout_of_another_version_is_as_good_as_none(
    records: PoseRecords, tmp_path: Path
) -> None:
    assert await records.layout(RUN) is None
    (tmp_path / "poses" / f"{RUN}.layout.json").write_text('{"type": "layout", "shape": "round"}')
    assert await records.layout(RUN) is None


async def test_of_what_a_slow_disk_does_not_take_only_so_much_waits_and_the_rest_is_counted(
    records: PoseRecords,
) -> None:
    record = records.open(RUN)
    slow = threading.Event()
    records._do_later(lambda: waited_for(slow))
    for step in range(MOST_WAITING + 100):
        record.add(frame(step / 10))
        if step % 20 == 0:
            record.flush()
    assert records.lost == 100
    slow.set()
    assert len((await records.read(RUN, *ALL)).frames) == MOST_WAITING
    record.add(frame(1000.0))
    records.close(RUN)
    assert time_of(await records.last(RUN) or b"") == 1000.0
    assert records.lost == 100


async def test_frames_that_a_disk_did_not_take_wait_no_longer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.poses.record.MOST_WAITING", 2)
    (tmp_path / "poses").write_text("a file where the folder is to be")
    records = PoseRecords(tmp_path / "poses")
    record = records.open(RUN)
    for time_s in (1.0, 2.0):
        record.add(frame(time_s))
    with pytest.raises(FileExistsError):
        await records.read(RUN, *ALL)
    (tmp_path / "poses").unlink()
    record.add(frame(3.0))
    assert len((await records.read(RUN, *ALL)).frames) == 1
    assert records.lost == 0
    records.shut()


def waited_for(event: threading.Event) -> None:
    event.wait(60)


async def test_a_disk_that_takes_nothing_costs_the_poses_and_nothing_else(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "poses").write_text("a file where the folder is to be")
    records = PoseRecords(tmp_path / "poses")
    record = records.open(RUN)
    record.add(frame(1.0))
    records.shut()
    record.add(frame(2.0))
    record.flush()
    assert "could not be recorded" in caplog.text
