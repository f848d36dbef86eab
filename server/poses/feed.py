"""Poses on their way from robots to those who watch a run, and to its record."""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager, contextmanager
from typing import Protocol
from uuid import UUID

from mend.robots.link.messages import IDENTITY, Hello, PoseLayout, Poses
from mend.server.models.robot_models import DrawnModel
from mend.server.poses.arms import OtherArms
from mend.server.poses.bases import Bases, in_scene
from mend.server.poses.frame import Frame, encode
from mend.server.poses.layout import RATE_HZ, Layout, lay_out
from mend.server.poses.record import (
    PoseRecord,
    PoseRecords,
    ReadFrames,
    RecordedPoses,
    no_frames,
)
from mend.server.runtime.run_state import RunState

ShowPoses = Callable[[str, float], None]
"""Has a robot send its poses so often per second of its clock; 0 is not at all."""

FindModel = Callable[[str], DrawnModel | None]
"""How the model of a name is drawn, if its files are here."""


ROUND_S = 0.1
"""So long (of real time) the robots of a run wait for each other with where they are."""


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
    """The poses of one run that goes on: those of the first of its robots that shows any.

    And the arms of the others, and, where robots drive, the base frames of all that do. A frame is
    made once each of those has shown where it is, or as one does so again, or `ROUND_S` later.
    """

    def __init__(
        self, state: RunState, show: ShowPoses, model: FindModel, records: PoseRecords | None
    ) -> None:
        self._state = state
        self._show = show
        self._model = model
        self._records = records
        self._record: PoseRecord | None = records.open(state.id) if records else None
        self._watchers: set[Watcher] = set()
        self._number = 0
        self._shown: tuple[Hello, PoseLayout] | None = None
        self._poses: Poses | None = None
        self._bases = Bases(state.frames)
        self._arms = OtherArms(state.frames)
        self._driving: set[str] = set()
        self._round: set[str] = set()
        self._round_s = 0.0
        self._timer: asyncio.TimerHandle | None = None
        self.layout: Layout | None = None
        self.frame: Frame | None = None

    def robot_connected(self, hello: Hello) -> None:
        """A robot of the run is there (again)."""
        shows = hello.shows
        if shows is None:
            return
        if shows.drives:
            self._driving.add(hello.robot)
        self._arms.connect(hello, shows)
        if self._shown is None or self._shown[0].robot == hello.robot:
            self._shown = hello, shows
        self._lay_out(*self._shown)
        self._ask()

    def _lay_out(self, hello: Hello, shows: PoseLayout) -> None:
        model = None if shows.model is None else self._model(shows.model)
        arms = self._arms.layouts(hello.robot, self._model)
        drives = bool(self._driving)
        layout = lay_out(self._state, hello, shows, model, drives=drives, arms=arms)
        if layout == self.layout:
            return
        self.layout, self.frame, self._poses = layout, None, None
        if self._records is not None:
            self._records.keep_layout(layout)
        for watcher in self._watchers:
            watcher.lay_out(layout)

    def models_changed(self) -> None:
        """There are other models than before: whoever watches draws the robots anew."""
        if self._shown is not None:
            self._lay_out(*self._shown)

    def take(self, robot: str, time_s: float, poses: Poses) -> None:
        """Pass poses on; `time_s` is of the run's clock. What fits no layout is left out."""
        layout = self.layout
        if layout is None or robot not in self._showing(layout):
            return
        if robot in self._round:
            self._end_round()
        if robot == layout.robot:
            if not layout.fits(poses):
                return
            self._poses = poses
        if robot in self._driving:
            self._bases.take(robot, time_s, poses.base)
        self._arms.take(robot, time_s, poses)
        self._round.add(robot)
        self._round_s = time_s
        if self._round >= self._showing(layout):
            self._end_round()
        elif self._timer is None:
            self._timer = asyncio.get_running_loop().call_later(ROUND_S, self._end_round)

    def _showing(self, layout: Layout) -> set[str]:
        return {layout.robot, *self._driving, *(each.robot for each in layout.arms)}

    def _end_round(self) -> None:
        """Make a frame of what has come, but for robots whose parts nobody knows yet."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        self._round.clear()
        layout = self.layout
        assert layout is not None, "poses are taken once there is a layout"
        poses = self._poses or Poses(time=0.0, tool=IDENTITY, opening_m=0.0)
        if not layout.fits(poses):
            return
        base = self._bases.of(layout.robot)
        here = base or in_scene(self._state.frames[layout.robot], poses.base)
        bases = self._bases.at(self._round_s, layout.robots)
        arms = self._arms.at(self._round_s, layout.arms, here)
        held = self._arms.held(layout.arms, arms)
        objects = [
            shown if shown.held else held.get(each.name, shown)
            for each, shown in zip(layout.objects, poses.objects, strict=True)
        ]
        poses = poses.model_copy(update={"base": base or poses.base, "objects": objects})
        self._pass_on(encode(self._number, self._round_s, poses, bases, arms))

    def _pass_on(self, frame: Frame) -> None:
        self.frame = frame
        self._number += 1
        if self._record is not None:
            self._record.add(frame)
        for watcher in self._watchers:
            watcher.show(frame)

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
        if self._round:
            self._end_round()
        for watcher in self._watchers:
            watcher.end()

    def _ask(self) -> None:
        """Poses cost nothing while nobody watches and nothing is recorded."""
        if self.layout is None:
            return
        wanted = bool(self._watchers) or self._record is not None
        for robot in sorted(self._showing(self.layout)):
            self._show(robot, RATE_HZ if wanted else 0.0)


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

    def all_recorded(self, run: UUID) -> AbstractAsyncContextManager[ReadFrames]:
        """Has all recorded frames of a run read, a page after the other."""
        ...


class PoseFeed:
    """The poses of every run; implements `PoseSource`. Without `records` none are kept."""

    def __init__(
        self, show: ShowPoses, model: FindModel, records: PoseRecords | None = None
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
        """Delete what was recorded of a run that is over, or of a site that is closed."""
        if self._records is not None:
            self._records.close(run)
            self._records.forget(run)

    def models_changed(self) -> None:
        """There are other models of robots than before."""
        for poses in self._runs.values():
            poses.models_changed()

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

    @asynccontextmanager
    async def all_recorded(self, run: UUID) -> AsyncIterator[ReadFrames]:
        """Has all recorded frames of a run read, a page after the other."""
        if self._records is None:
            yield no_frames
            return
        async with self._records.all_of(run) as read:
            yield read

    def record(self, site: UUID) -> PoseRecord | None:
        """The record to which frames of a site are added, if any are kept."""
        return None if self._records is None else self._records.open(site)

    async def last(self, run: UUID) -> Frame | None:
        """The last recorded frame of a run."""
        return None if self._records is None else await self._records.last(run)

    def shut(self) -> None:
        """Write what waits."""
        for run in list(self._runs):
            self.close(run)
        if self._records is not None:
            self._records.shut()
