"""Poses on their way from robots to those who watch a run, and to its record."""

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Protocol
from uuid import UUID

from mend.robots.link.messages import Hello, Poses
from mend.server.poses.frame import Frame, encode
from mend.server.poses.layout import RATE_HZ, Layout, lay_out
from mend.server.poses.record import PoseRecord, PoseRecords, RecordedPoses
from mend.server.runtime.run_state import RunState

ShowPoses = Callable[[str, float], None]
"""Has a robot send its poses so often per second of its clock; 0 is not at all."""

ModelAddress = Callable[[str], str | None]
"""Where the model files of a name are, if they are here."""


class Watcher:
    """One who watches a run; of what they are too slow for only the latest waits for them."""

    def __init__(self) -> None:
        self._layout: Layout | None = None
        self._frame: Frame | None = None
        self._over = False
        self._news = asyncio.Event()

    def lay_out(self, layout: Layout) -> None:
        self._layout, self._frame = layout, None
        self._news.set()

    def show(self, frame: Frame) -> None:
        self._frame = frame
        self._news.set()

    def end(self) -> None:
        self._over = True
        self._news.set()

    async def next(self) -> Layout | Frame | None:
        """The latest layout or frame that was not taken yet; None after the run's end."""
        while True:
            if self._layout is not None:
                layout, self._layout = self._layout, None
                return layout
            if self._frame is not None:
                frame, self._frame = self._frame, None
                return frame
            if self._over:
                return None
            self._news.clear()
            await self._news.wait()


class RunPoses:
    """The poses of one run that goes on: those of the first of its robots that shows any."""

    def __init__(
        self, state: RunState, show: ShowPoses, model: ModelAddress, records: PoseRecords | None
    ) -> None:
        self._state = state
        self._show = show
        self._model = model
        self._records = records
        self._record: PoseRecord | None = records.open(state.id) if records else None
        self._watchers: set[Watcher] = set()
        self._number = 0
        self.layout: Layout | None = None
        self.frame: Frame | None = None

    def robot_connected(self, hello: Hello) -> None:
        """A robot of the run is there (again)."""
        if hello.shows is None:
            return
        if self.layout is not None and self.layout.robot != hello.robot:
            return
        model = hello.shows.model
        address = None if model is None else self._model(model)
        layout = lay_out(self._state, hello, hello.shows, address)
        if layout != self.layout:
            self.layout, self.frame = layout, None
            if self._records is not None:
                self._records.keep_layout(layout)
            for watcher in self._watchers:
                watcher.lay_out(layout)
        self._ask()

    def take(self, robot: str, time_s: float, poses: Poses) -> None:
        """Pass poses on; `time_s` is of the run's clock. What fits no layout is left out."""
        layout = self.layout
        if layout is None or layout.robot != robot or not layout.fits(poses):
            return
        self.frame = encode(self._number, time_s, poses)
        self._number += 1
        if self._record is not None:
            self._record.add(self.frame)
        for watcher in self._watchers:
            watcher.show(self.frame)

    @contextmanager
    def watched(self) -> Iterator[Watcher]:
        """Watch the run."""
        watcher = Watcher()
        if self.layout is not None:
            watcher.lay_out(self.layout)
        if self.frame is not None:
            watcher.show(self.frame)
        self._watchers.add(watcher)
        self._ask()
        try:
            yield watcher
        finally:
            self._watchers.discard(watcher)
            self._ask()

    def end(self) -> None:
        """The run is over."""
        for watcher in self._watchers:
            watcher.end()

    def _ask(self) -> None:
        """Poses cost nothing while nobody watches and nothing is recorded."""
        if self.layout is not None:
            wanted = bool(self._watchers) or self._record is not None
            self._show(self.layout.robot, RATE_HZ if wanted else 0.0)


class PoseSource(Protocol):
    """Where the API finds the poses of runs."""

    @property
    def lost(self) -> int:
        """Frames that were not recorded, as the disk was too slow for them."""
        ...

    def of(self, run: UUID) -> RunPoses | None:
        """Those of a run that goes on."""
        ...

    async def layout(self, run: UUID) -> Layout | None: ...

    async def last(self, run: UUID) -> Frame | None: ...

    async def recorded(
        self, run: UUID, from_s: float, to_s: float, limit: int
    ) -> RecordedPoses: ...


class PoseFeed:
    """The poses of every run; implements `PoseSource`. Without `records` none are kept."""

    def __init__(
        self, show: ShowPoses, model: ModelAddress, records: PoseRecords | None = None
    ) -> None:
        self._show = show
        self._model = model
        self._records = records
        self._runs: dict[UUID, RunPoses] = {}

    @property
    def lost(self) -> int:
        return 0 if self._records is None else self._records.lost

    def open(self, state: RunState) -> RunPoses:
        """A run is taken up."""
        poses = RunPoses(state, self._show, self._model, self._records)
        self._runs[state.id] = poses
        return poses

    def close(self, run: UUID) -> None:
        """A run is over, or let go of."""
        poses = self._runs.pop(run, None)
        if poses is not None:
            poses.end()
        if self._records is not None:
            self._records.close(run)

    def forget(self, run: UUID) -> None:
        """Delete what was recorded of a run that is over."""
        if self._records is not None:
            self._records.forget(run)

    def of(self, run: UUID) -> RunPoses | None:
        return self._runs.get(run)

    async def layout(self, run: UUID) -> Layout | None:
        """The last layout of a run; None while its robot has not shown any."""
        poses = self._runs.get(run)
        if poses is not None and poses.layout is not None:
            return poses.layout
        return None if self._records is None else await self._records.layout(run)

    async def recorded(self, run: UUID, from_s: float, to_s: float, limit: int) -> RecordedPoses:
        """The recorded frames of a span, evenly thinned out to `limit`."""
        if self._records is None:
            return RecordedPoses([], None)
        return await self._records.read(run, from_s, to_s, limit)

    async def last(self, run: UUID) -> Frame | None:
        """The last recorded frame of a run."""
        return None if self._records is None else await self._records.last(run)

    def shut(self) -> None:
        """Write what waits."""
        for run in list(self._runs):
            self.close(run)
        if self._records is not None:
            self._records.shut()
