"""Films with robots' cameras: around faults, and while people want it."""

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Protocol
from uuid import UUID, uuid4

from mend.errors import ConflictError, RefusalError
from mend.server.camera_picture import CameraPicture
from mend.server.journal import events as ev
from mend.server.runtime.context import RunContext
from mend.server.runtime.inbox import Task
from mend.server.runtime.robot_proxy import RobotActivity, RobotProxy

KEPT_AT_ONCE_S = 2.0
"""So much is journaled at a time: what is lost with the service, or at the end of the run."""

RESTS = 3.0
"""So many times as long as its pictures took a robot is left alone: whatever takes them may be what
drives it.
"""

FIRST_REST_S, LONGEST_REST_S = 1.0, 30.0
"""How long a camera is not asked that gave no picture; longer each time."""

MOST_BUFFERED_BYTES = 32 * 1024**2
"""What one robot's cameras saw and no fault has come of, whatever the settings say."""


class TakePicture(Protocol):
    """Asks a robot for what one of its cameras sees."""

    def __call__(self, robot: str, camera: str) -> Awaitable[CameraPicture]:
        """Raises `RefusalError` where there is none."""
        ...


@dataclass(frozen=True, slots=True)
class CameraSource:
    """Where pictures come from; `sleep` and `monotonic` are of real time, as films are.

    `has_time` tells whether a robot has taken all that it was told, and no picture is late.
    """

    take_picture: TakePicture
    has_time: Callable[[str], bool]
    monotonic: Callable[[], float]
    sleep: Callable[[float], Awaitable[None]]


@dataclass(frozen=True, slots=True)
class _Taken:
    camera: str
    time_s: float
    jpeg: bytes


@dataclass(frozen=True, slots=True)
class _Unanswered:
    """A camera that gave no picture is not asked until then."""

    rest_s: float
    until: float


class CameraRecorder:
    """The cameras of one run.

    Each robot has one film at a time, and whoever wants more of it only makes it longer. What was
    seen before a fault is in memory alone, until the fault comes. A run whose clock runs as fast as
    it can is not filmed around faults: its pictures would be of other moments than they say.

    A robot's work comes first: it is asked for one picture at a time, once it has taken all
    commands and while no picture is late, and is left alone for longer than that took.
    """

    def __init__(
        self,
        context: RunContext,
        proxies: Mapping[str, RobotProxy],
        source: CameraSource,
        tell: Callable[[Task], None],
    ) -> None:
        """`tell` has something done in the run's turn."""
        self._context = context
        self._proxies = proxies
        self._source = source
        self._tell = tell
        self._films: dict[str, _Film] = {}
        self._unanswered: dict[tuple[str, str], _Unanswered] = {}
        self._waiting_bytes = 0
        self._full = False

    def begin(self) -> None:
        """Film from now on, where the moments before a fault are wanted."""
        if self._around_faults and self._context.settings.record_before_fault_s > 0:
            for robot in self._proxies:
                self._film_of(robot).go_on()

    def fault(self, robot: str) -> None:
        """A robot has noticed a fault just now."""
        settings = self._context.settings
        wanted = settings.record_before_fault_s > 0 or settings.record_after_fault_s > 0
        if not (wanted and self._around_faults) or not self._has_room(0):
            return
        # After what the run tells the robot because of the fault.
        self._tell(partial(self._film_fault, robot))

    async def _film_fault(self, robot: str) -> None:
        after_s = self._context.settings.record_after_fault_s
        self._film_of(robot).keep_for(after_s, buffered=True)

    async def record(
        self, seconds: float, by: str, author: ev.Author | None = None
    ) -> ev.RecordingBegun:
        """Film with all cameras for so long, because somebody wants it.

        Raises `ConflictError` where no robot that is there has a camera, or no room is left.
        """
        robots = [name for name in self._proxies if self._cameras(name)]
        if not robots:
            raise ConflictError("no robot of this run that is there has a camera")
        most = self._context.settings.limits.recorded_bytes
        if not self._has_room(0):
            raise ConflictError(
                f"the pictures of a run may have {most} bytes, and this one's have as many: set "
                "'recorded_bytes' higher for longer films",
                limit="recorded_bytes",
            )
        begun = ev.RecordingBegun(
            **self._context.stamp(), robots=robots, seconds=seconds, by=by, author=author
        )
        await self._context.commit([begun])
        for robot in robots:
            self._film_of(robot).keep_for(seconds, buffered=False)
        return begun

    def end(self) -> None:
        """The run is over, or let go of."""
        for film in self._films.values():
            film.cut()

    @property
    def _around_faults(self) -> bool:
        return self._context.state.started.speed != "max"

    def _cameras(self, robot: str) -> Sequence[str]:
        proxy = self._proxies[robot]
        there = proxy.hello is not None and proxy.doing is not RobotActivity.ABSENT
        return proxy.hello.cameras if there and proxy.hello is not None else ()

    def _has_room(self, more_bytes: int) -> bool:
        """Whether so much more may be kept of this run."""
        most = self._context.settings.limits.recorded_bytes
        return self._context.state.recorded_bytes + more_bytes < most

    def _is_of_use(self) -> bool:
        """Whether there is room for another picture, with all that wait to be journaled."""
        return not self._full and self._has_room(self._waiting_bytes)

    def _film_of(self, robot: str) -> "_Film":
        if robot not in self._films:
            self._films[robot] = _Film(
                partial(self._shoot, robot),
                partial(self._hand_over, robot),
                self._source,
                self._context.settings.recording_period_s,
                self._context.settings.record_before_fault_s if self._around_faults else 0.0,
            )
        return self._films[robot]

    async def _shoot(self, robot: str) -> list[_Taken]:
        """One picture of each camera; a robot that has none to give just now gives none."""
        taken = []
        for camera in self._cameras(robot):
            if self._source.has_time(robot) and self._is_of_use():
                picture = await self._picture(robot, camera)
                if picture is not None:
                    taken.append(_Taken(camera, self._context.clock.now(), picture.jpeg))
        return taken

    async def _picture(self, robot: str, camera: str) -> CameraPicture | None:
        """What a camera sees; None also where it has not answered of late."""
        before = self._unanswered.get((robot, camera))
        if before is not None and self._source.monotonic() < before.until:
            return None
        try:
            picture = await self._source.take_picture(robot, camera)
        except RefusalError:
            rest_s = FIRST_REST_S if before is None else min(2 * before.rest_s, LONGEST_REST_S)
            until = self._source.monotonic() + rest_s
            self._unanswered[robot, camera] = _Unanswered(rest_s, until)
            return None
        self._unanswered.pop((robot, camera), None)
        return picture

    def _hand_over(self, robot: str, pictures: Sequence[_Taken]) -> None:
        size = sum(len(each.jpeg) for each in pictures)
        self._waiting_bytes += size
        self._tell(partial(self._keep_waiting, robot, pictures, size))

    async def _keep_waiting(self, robot: str, taken: Sequence[_Taken], size: int) -> None:
        try:
            await self._keep(robot, taken)
        finally:
            self._waiting_bytes -= size

    async def _keep(self, robot: str, taken: Sequence[_Taken]) -> None:
        """Journal pictures, as many as there is room for."""
        size, kept = 0, dict[UUID, _Taken]()
        for each in taken:
            if not self._has_room(size + len(each.jpeg)):
                self._context.refusals.note("recorded_bytes")
                self._full = True
                break
            size += len(each.jpeg)
            kept[uuid4()] = each
        if not kept or self._context.state.status.ended:
            return
        recorded = ev.CamerasRecorded(
            **self._context.stamp(),
            robot=robot,
            size_bytes=size,
            pictures=[
                ev.RecordedPicture(camera=each.camera, time=each.time_s, picture=picture)
                for picture, each in kept.items()
            ],
        )
        pictures = {picture: each.jpeg for picture, each in kept.items()}
        await self._context.commit([recorded], pictures=pictures)


class _Film:
    """What one robot's cameras see, for as long as somebody wants it."""

    def __init__(
        self,
        shoot: Callable[[], Awaitable[list[_Taken]]],
        hand_over: Callable[[Sequence[_Taken]], None],
        source: CameraSource,
        period_s: float,
        before_s: float,
    ) -> None:
        """Of the last `before_s` all is remembered while nothing is to be kept."""
        self._shoot = shoot
        self._hand_over = hand_over
        self._source = source
        self._period_s = period_s
        self._before_s = before_s
        self._before: deque[tuple[float, list[_Taken]]] = deque()
        self._kept: list[_Taken] = []
        self._keep_until = -1.0
        self._handed_over = 0.0
        self._filming: asyncio.Task[None] | None = None

    def keep_for(self, seconds: float, *, buffered: bool) -> None:
        """Keep what is seen for so long from now on, and, `buffered`, what was seen before."""
        now = self._source.monotonic()
        if buffered:
            self._kept += [each for _, taken in self._before for each in taken]
            self._before.clear()
        if now >= self._keep_until:
            self._handed_over = now
        self._keep_until = max(self._keep_until, now + seconds)
        self.go_on()

    def go_on(self) -> None:
        """Film, if nobody does."""
        if self._filming is None or self._filming.done():
            self._filming = asyncio.create_task(self._film(), name="camera recording")

    def cut(self) -> None:
        """Film no more."""
        if self._filming is not None:
            self._filming.cancel()

    async def _film(self) -> None:
        while self._before_s > 0 or self._kept or self._source.monotonic() < self._keep_until:
            began = self._source.monotonic()
            taken = await self._shoot() if self._wanted(began) else []
            ended = self._source.monotonic()
            rest_s = max(self._period_s - (ended - began), RESTS * (ended - began))
            self._take(began, taken)
            self._hand_over_before(ended + rest_s)
            await self._source.sleep(rest_s)

    def _wanted(self, now: float) -> bool:
        return self._before_s > 0 or now < self._keep_until

    def _take(self, now: float, taken: list[_Taken]) -> None:
        if now < self._keep_until:
            self._kept += taken
        elif self._before_s > 0:
            self._remember(now, taken)

    def _hand_over_before(self, then: float) -> None:
        """Hand over what would be too old by the next picture, or is not followed by any."""
        last = then >= self._keep_until
        if self._kept and (last or then - self._handed_over > KEPT_AT_ONCE_S):
            self._hand_over(self._kept)
            self._kept, self._handed_over = [], self._source.monotonic()

    def _remember(self, now: float, taken: list[_Taken]) -> None:
        self._before.append((now, taken))
        while self._before and (
            now - self._before[0][0] > self._before_s or self._size() > MOST_BUFFERED_BYTES
        ):
            self._before.popleft()

    def _size(self) -> int:
        return sum(len(each.jpeg) for _, taken in self._before for each in taken)
