"""Recorded poses: one file of frames per run beside the journal, bounded, written off the loop."""

import asyncio
import logging
from collections import deque
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar
from uuid import UUID

from pydantic import ValidationError

from mend.server.poses.frame import Frame, framed, time_of, unframed
from mend.server.poses.layout import Layout

log = logging.getLogger(__name__)

T = TypeVar("T")

ReadFrames = Callable[[float], Awaitable[list[Frame]]]
"""The next frames up to a time of the run's clock; none where there are none."""

WriteLater = Callable[[Callable[[], None], Callable[[], None]], None]
"""Has the records' thread do the first, and then the second, whatever became of the first."""

MOST_BYTES = 32 * 1024 * 1024
SHORTEST_INTERVAL_S = 0.049
"""Of the run's clock: no more than 20 frames per second are kept."""
FLUSH_S = 1.0
PAGE_BYTES = 128 * 1024
"""So much of a record is read at a time."""
MOST_WAITING = 4096
"""So many frames of a run may wait to be written; a disk that is slower than that loses some."""


@dataclass(frozen=True, slots=True)
class RecordedPoses:
    """Frames in order; `span_s` has the run's first and last recorded time, if there are any."""

    frames: Sequence[Frame]
    span_s: tuple[float, float] | None


class RecordedFrames:
    """The frames of a record from its beginning, read in pieces.

    What is recorded meanwhile comes too, unless it is thinned out: then they are those of before.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("rb") if path.exists() else None
        self._bytes = b""
        self._waiting: deque[Frame] = deque()

    def until(self, time_s: float) -> list[Frame]:
        """The next frames up to a time of the run's clock, not all at once; none if there are none.

        Raises `OSError`.
        """
        if not self._waiting:
            self._read()
        page: list[Frame] = []
        while self._waiting and time_of(self._waiting[0]) <= time_s:
            page.append(self._waiting.popleft())
        return page

    def _read(self) -> None:
        while self._file is not None and not self._waiting:
            read = self._file.read(PAGE_BYTES)
            if not read:
                return
            self._bytes += read
            self._waiting.extend(unframed(self._bytes))
            self._bytes = self._bytes[len(framed(self._waiting)) :]

    def close(self) -> None:
        if self._file is not None:
            self._file.close()


async def no_frames(_time_s: float) -> list[Frame]:
    """What there is to read where nothing is recorded."""
    return []


class PoseRecord:
    """The record of one run that goes on. Its file is touched by the records' thread alone.

    `lost` is how many frames did not get there, as so many were waiting for the disk.
    """

    def __init__(self, path: Path, write: WriteLater, most: int) -> None:
        self.lost = 0
        self._path = path
        self._write = write
        self._most_bytes = most
        self._waiting: list[Frame] = []
        # The first is counted in the loop, the second in the thread: neither needs a lock.
        self._handed_over = 0
        self._dealt_with = 0
        self._timer: asyncio.TimerHandle | None = None
        self._last_s: float | None = None
        self._interval_s = SHORTEST_INTERVAL_S
        self._size: int | None = None

    def add(self, frame: Frame) -> None:
        """Keep a frame, unless it follows the last one too soon."""
        time_s = time_of(frame)
        if self._last_s is not None and 0.0 <= time_s - self._last_s < self._interval_s:
            return
        self._last_s = time_s
        if len(self._waiting) + self._handed_over - self._dealt_with >= MOST_WAITING:
            self.lost += 1
            return
        self._waiting.append(frame)
        if self._timer is None:
            self._timer = asyncio.get_running_loop().call_later(FLUSH_S, self.flush)

    def flush(self) -> None:
        """Have what waits written."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        if self._waiting:
            waiting, self._waiting = self._waiting, []
            self._handed_over += len(waiting)
            self._write(partial(self._append, waiting), partial(self._dealt, len(waiting)))

    def _dealt(self, frames: int) -> None:
        self._dealt_with += frames

    def _append(self, frames: Sequence[Frame]) -> None:
        if self._size is None:
            self._size = _without_torn_end(self._path)
        data = framed(frames)
        with self._path.open("ab") as file:
            file.write(data)
        self._size += len(data)
        if self._size > self._most_bytes:
            self._thin_out()

    def _thin_out(self) -> None:
        """Keep every other frame, and from now on half as many."""
        kept = list(unframed(self._path.read_bytes()))[::2]
        self._size = _replace(self._path, framed(kept))
        self._interval_s *= 2


class PoseRecords:
    """The records of all runs, in one folder."""

    def __init__(self, folder: Path, most_bytes: int = MOST_BYTES) -> None:
        self._folder = folder
        self._most_bytes = most_bytes
        self._records: dict[UUID, PoseRecord] = {}
        self._lost = 0
        self._shut = False
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="poses")

    @property
    def lost(self) -> int:
        """Frames that were not recorded, as the disk was too slow for them."""
        return self._lost + sum(record.lost for record in self._records.values())

    def open(self, run: UUID) -> PoseRecord:
        """The record to which a run's frames are added; it goes on where an earlier one ended."""
        if run not in self._records:
            path = self._path(run)
            self._records[run] = PoseRecord(path, self._do_later, self._most_bytes)
        return self._records[run]

    def close(self, run: UUID) -> None:
        """A run is over."""
        record = self._records.pop(run, None)
        if record is not None:
            self._lost += record.lost
            record.flush()

    def keep_layout(self, layout: Layout) -> None:
        """Keep the last layout of a run."""
        path, text = self._layout_path(layout.run), layout.model_dump_json()
        self._do_later(lambda: _write_text(path, text))

    def forget(self, run: UUID) -> None:
        """Delete the record of a run that is over."""
        for path in (self._path(run), self._layout_path(run)):
            self._do_later(partial(path.unlink, missing_ok=True))

    async def layout(self, run: UUID) -> Layout | None:
        """The last layout of a run."""
        path = self._layout_path(run)
        return await self._do(lambda: read_layout(path))

    async def read(self, run: UUID, from_s: float, to_s: float, limit: int) -> RecordedPoses:
        """The frames of a span, evenly thinned out to `limit`."""
        if run in self._records:
            self._records[run].flush()
        path = self._path(run)

        def read() -> RecordedPoses:
            frames = list(unframed(path.read_bytes())) if path.exists() else []
            if not frames:
                return RecordedPoses([], None)
            span_s = time_of(frames[0]), time_of(frames[-1])
            chosen = [each for each in frames if from_s <= time_of(each) <= to_s]
            every = -(-len(chosen) // limit) or 1
            return RecordedPoses(chosen[::every], span_s)

        return await self._do(read)

    @asynccontextmanager
    async def all_of(self, run: UUID) -> AsyncIterator[ReadFrames]:
        """Has the frames of a run read from the first on, a page after the other."""
        if run in self._records:
            self._records[run].flush()
        frames = await self._do(lambda: RecordedFrames(self._path(run)))
        try:
            yield lambda time_s: self._do(lambda: frames.until(time_s))
        finally:
            frames.close()

    async def last(self, run: UUID) -> Frame | None:
        """The last frame of a run."""
        path = self._path(run)

        def read() -> Frame | None:
            frames = deque(unframed(path.read_bytes() if path.exists() else b""), maxlen=1)
            return frames[0] if frames else None

        return await self._do(read)

    def shut(self) -> None:
        """Write what waits, and end; what still comes is not recorded."""
        for run in list(self._records):
            self.close(run)
        self._shut = True
        self._thread.shutdown()

    def _path(self, run: UUID) -> Path:
        return record_path(self._folder, run)

    def _layout_path(self, run: UUID) -> Path:
        return layout_path(self._folder, run)

    def _do_later(self, work: Callable[[], None], then: Callable[[], None] = lambda: None) -> None:
        if not self._shut:
            self._thread.submit(self._try, work, then)

    def _try(self, work: Callable[[], None], then: Callable[[], None]) -> None:
        try:
            self._in_folder(work)
        except OSError as error:
            log.warning("some poses could not be recorded: %s", error)
        finally:
            then()

    def _in_folder(self, work: Callable[[], T]) -> T:
        self._folder.mkdir(parents=True, exist_ok=True)
        return work()

    async def _do(self, work: Callable[[], T]) -> T:
        return await asyncio.get_running_loop().run_in_executor(
            self._thread, lambda: self._in_folder(work)
        )


def record_path(folder: Path, run: UUID) -> Path:
    """Where the frames of a run are."""
    return folder / f"{run}.poses"


def layout_path(folder: Path, run: UUID) -> Path:
    """Where what they hold is told."""
    return folder / f"{run}.layout.json"


def read_layout(path: Path) -> Layout | None:
    """A layout that was kept; None where there is none. Raises `OSError`."""
    try:
        return Layout.model_validate_json(path.read_bytes()) if path.exists() else None
    except ValidationError:
        # Of another version of Mend: what is only for display is not worth an upgrade.
        return None


def _without_torn_end(path: Path) -> int:
    """Cut off what a kill left half written; returns the size of the rest."""
    if not path.exists():
        return 0
    data = path.read_bytes()
    whole = framed(unframed(data))
    return len(data) if len(whole) == len(data) else _replace(path, whole)


def _replace(path: Path, data: bytes) -> int:
    draft = path.with_suffix(".draft")
    draft.write_bytes(data)
    draft.replace(path)
    return len(data)


def _write_text(path: Path, text: str) -> None:
    _replace(path, text.encode())
