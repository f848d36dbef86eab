"""Cameras are recorded around faults and on demand, for so long, in so much room, and no more."""

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from itertools import pairwise
from types import SimpleNamespace
from typing import Any, cast
from uuid import UUID

import pytest

from mend.errors import ConflictError, NotFoundError
from mend.server.camera_picture import CameraPicture
from mend.server.journal import events as ev
from mend.server.limits import Limits
from mend.server.refusals import Refusals
from mend.server.runtime.camera_recorder import CameraRecorder, CameraSource
from mend.server.runtime.context import RunContext, RunSettings
from mend.server.runtime.inbox import Task
from mend.server.runtime.robot_proxy import RobotActivity
from mend.server.runtime.views import RunStatus

JPEG_BYTES = 100
CAMERAS = ["forearm", "head"]


@dataclass
class Filmed:
    """A run on a clock that the recorder itself moves, as it waits."""

    settings: RunSettings
    speed: Any = 1.0
    cameras: dict[str, list[str]] = field(default_factory=lambda: {"arm": CAMERAS})
    time_s: float = 0.0
    gone: set[str] = field(default_factory=set)
    busy: set[str] = field(default_factory=set)
    takes_s: float = 0.0
    asked: list[float] = field(default_factory=list)
    turn: asyncio.Lock = field(default_factory=asyncio.Lock)
    may_commit: asyncio.Event = field(default_factory=asyncio.Event)
    events: list[ev.Event] = field(default_factory=list)
    pictures: dict[UUID, bytes] = field(default_factory=dict)
    doing: list[asyncio.Task[None]] = field(default_factory=list)

    def __post_init__(self) -> None:
        started = SimpleNamespace(speed=self.speed)
        self.state = SimpleNamespace(started=started, recorded_bytes=0, status=RunStatus.RUNNING)
        self.clock = SimpleNamespace(now=lambda: self.time_s)
        self.refusals = Refusals()
        proxies = {
            name: SimpleNamespace(hello=SimpleNamespace(cameras=each), doing=RobotActivity.IDLE)
            for name, each in self.cameras.items()
        }
        self.proxies = proxies
        self.may_commit.set()
        source = CameraSource(
            self.take_picture, lambda robot: robot not in self.busy, lambda: self.time_s, self.sleep
        )
        self.recorder = CameraRecorder(
            cast(RunContext, self), cast(Any, proxies), source, self.tell
        )

    async def take_picture(self, robot: str, camera: str) -> CameraPicture:
        self.asked.append(self.time_s)
        self.time_s += self.takes_s
        if robot in self.gone:
            raise ConflictError("it is not there")
        if camera == "broken":
            raise NotFoundError("there is no such camera")
        return CameraPicture(bytes(JPEG_BYTES))

    async def sleep(self, seconds: float) -> None:
        self.time_s += seconds
        # Once for what it told, and once for whoever watches.
        await asyncio.sleep(0)
        await asyncio.sleep(0)

    def tell(self, task: Task) -> None:
        self.doing.append(asyncio.create_task(self.do_in_turn(task)))

    async def do_in_turn(self, task: Task) -> None:
        async with self.turn:
            await task()

    def stamp(self) -> dict[str, Any]:
        now = datetime(2026, 1, 2, tzinfo=UTC)
        return {"time": self.time_s, "wall_time": now, "run": UUID(int=7)}

    async def commit(
        self, events: Sequence[ev.Event], *, pictures: Mapping[UUID, bytes] | None = None
    ) -> None:
        await self.may_commit.wait()
        self.events += events
        self.pictures.update(pictures or {})
        for each in events:
            if isinstance(each, ev.CamerasRecorded):
                self.state.recorded_bytes += each.size_bytes

    def kept(self, robot: str = "arm", camera: str = "head") -> list[float]:
        """When the pictures of a camera were taken."""
        return [
            picture.time
            for each in self.events
            if isinstance(each, ev.CamerasRecorded) and each.robot == robot
            for picture in each.pictures
            if picture.camera == camera
        ]

    async def passes(self, seconds: float) -> None:
        """Wait while the recorder films for so long, or until it films no more."""
        end_s, idle = self.time_s + seconds, 0
        while self.time_s < end_s and idle < 20:
            before = self.time_s
            await asyncio.sleep(0)
            idle = idle + 1 if self.time_s == before else 0

    async def comes_to_an_end(self) -> None:
        await self.passes(1e6)


def settings(before_s: float = 0.0, after_s: float = 0.0, **limits: int) -> RunSettings:
    return RunSettings(
        record_before_fault_s=before_s, record_after_fault_s=after_s, limits=Limits(**limits)
    )


async def test_all_cameras_are_recorded_after_a_fault() -> None:
    run = Filmed(settings(after_s=3.0))
    run.recorder.begin()
    await run.comes_to_an_end()
    assert run.kept() == []
    run.recorder.fault("arm")
    await run.comes_to_an_end()
    assert run.kept() == run.kept(camera="forearm") == [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]
    named = [each.picture for event in run.events for each in getattr(event, "pictures", ())]
    assert set(named) == set(run.pictures)


async def test_what_was_seen_before_a_fault_is_kept_once_there_is_one() -> None:
    run = Filmed(settings(before_s=2.0, after_s=1.0))
    run.recorder.begin()
    await run.passes(10.0)
    assert run.kept() == []
    fault_s = run.time_s
    run.recorder.fault("arm")
    await run.passes(3.0)
    run.recorder.end()
    kept = run.kept()
    assert fault_s - 2.5 <= kept[0] <= fault_s - 1.5
    assert fault_s <= kept[-1] <= fault_s + 1.0
    assert kept == sorted(kept)
    assert {round(b - a, 6) for a, b in pairwise(kept)} == {0.5}


async def test_a_fault_during_a_film_makes_it_longer_and_nothing_twice() -> None:
    run = Filmed(settings(after_s=2.0))
    run.recorder.fault("arm")
    await run.passes(1.0)
    run.recorder.fault("arm")
    await run.comes_to_an_end()
    kept = run.kept()
    assert len(kept) == len(set(kept))
    assert 2.5 <= kept[-1] <= 3.5


async def test_a_run_as_fast_as_it_can_is_not_recorded_around_faults() -> None:
    run = Filmed(settings(before_s=2.0, after_s=2.0), speed="max")
    run.recorder.begin()
    run.recorder.fault("arm")
    await run.comes_to_an_end()
    assert run.events == []


async def test_somebody_has_the_cameras_of_all_robots_recorded() -> None:
    run = Filmed(settings(), cameras={"left": CAMERAS, "right": ["head"], "blind": []})
    begun = await run.recorder.record(4.0, "anna")
    await run.comes_to_an_end()
    assert (begun.robots, begun.seconds, begun.by) == (["left", "right"], 4.0, "anna")
    assert run.events[0] == begun
    # Both films move the clock.
    assert all(3.0 <= run.kept(each)[-1] < 4.0 for each in ("left", "right"))
    assert run.kept("blind") == []
    # What the service has when it is killed is never more than two seconds behind.
    assert len([each for each in run.events if isinstance(each, ev.CamerasRecorded)]) >= 4


async def test_without_cameras_nothing_can_be_recorded() -> None:
    run = Filmed(settings(), cameras={"blind": []})
    with pytest.raises(ConflictError, match="no robot of this run that is there has a camera"):
        await run.recorder.record(4.0, "anna")


async def test_a_robot_that_gives_no_picture_now_gives_the_next() -> None:
    run = Filmed(settings(), cameras={"arm": ["broken", "head"]})
    run.gone.add("arm")
    await run.recorder.record(4.0, "anna")
    await run.passes(2.0)
    run.gone.clear()
    await run.comes_to_an_end()
    assert run.kept(camera="broken") == []
    assert run.kept()[0] >= 2.0


async def test_a_run_has_so_much_room_for_pictures() -> None:
    run = Filmed(settings(after_s=2.0, recorded_bytes=10 * JPEG_BYTES))
    await run.recorder.record(60.0, "anna")
    await run.comes_to_an_end()
    assert len(run.pictures) == 9
    assert run.refusals.counts["recorded_bytes"] > 0
    run.state.recorded_bytes = 10 * JPEG_BYTES
    with pytest.raises(ConflictError, match="may have 1000 bytes") as refused:
        await run.recorder.record(1.0, "anna")
    assert refused.value.limit == "recorded_bytes"
    told = len(run.events)
    run.recorder.fault("arm")
    await run.comes_to_an_end()
    assert len(run.events) == told


async def test_nothing_is_kept_once_the_run_has_ended() -> None:
    run = Filmed(settings())
    await run.recorder.record(10.0, "anna")
    await run.passes(1.0)
    run.state.status = RunStatus.FINISHED
    run.recorder.end()
    await run.comes_to_an_end()
    assert run.kept() == []


async def test_a_robot_that_has_not_taken_its_commands_is_asked_for_nothing() -> None:
    run = Filmed(settings(after_s=4.0))
    run.busy.add("arm")
    run.recorder.fault("arm")
    await run.passes(2.0)
    assert run.asked == []
    run.busy.clear()
    await run.comes_to_an_end()
    assert run.kept()[0] >= 2.0


async def test_a_robot_is_told_what_follows_from_its_fault_before_it_is_asked() -> None:
    run = Filmed(settings(after_s=4.0))
    turn = list[Task]()
    run.recorder._tell = turn.append
    run.recorder.fault("arm")
    await run.comes_to_an_end()
    assert run.asked == []
    assert len(turn) == 1
    await turn[0]()
    await run.comes_to_an_end()
    assert run.asked != []


async def test_a_slow_robot_has_most_of_its_time_for_itself() -> None:
    run = Filmed(settings(), takes_s=0.5)
    await run.recorder.record(40.0, "anna")
    await run.comes_to_an_end()
    assert 5 <= len(run.asked) * run.takes_s <= 11


async def test_a_robot_that_never_answers_is_asked_ever_more_rarely() -> None:
    run = Filmed(settings(before_s=2.0), cameras={"arm": ["broken"]})
    run.recorder.begin()
    await run.passes(300.0)
    run.recorder.end()
    assert 5 <= len(run.asked) <= 20


async def test_pictures_that_wait_for_the_journal_have_no_more_room_than_a_run() -> None:
    run = Filmed(settings(recorded_bytes=20 * JPEG_BYTES))
    await run.recorder.record(60.0, "anna")
    run.may_commit.clear()
    await run.comes_to_an_end()
    assert len(run.asked) < 40
    run.may_commit.set()
    await asyncio.gather(*run.doing)
    assert len(run.pictures) == 19


async def test_a_robot_that_has_gone_is_not_recorded() -> None:
    run = Filmed(settings())
    run.proxies["arm"].doing = RobotActivity.ABSENT
    with pytest.raises(ConflictError, match="no robot of this run that is there has a camera"):
        await run.recorder.record(4.0, "anna")
