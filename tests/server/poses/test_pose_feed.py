"""Poses reach everybody who watches, only the latest, and are asked for only if anybody does."""

import asyncio
import math
import struct
from pathlib import Path

import pytest
from sample_events import RUN
from shown_run import SHOWS, driving_state, hello, poses, run_state

from mend.robots.link.messages import IDENTITY, PoseLayout, Poses
from mend.server.models.robot_models import DrawnModel
from mend.server.poses.feed import PoseFeed, RunPoses, Watcher
from mend.server.poses.frame import time_of
from mend.server.poses.layout import Layout
from mend.server.poses.record import PoseRecords
from mend.tasks.scene import Base


class Asked(list[tuple[str, float]]):
    """What robots were asked for."""

    def show(self, robot: str, rate_hz: float) -> None:
        self.append((robot, rate_hz))


@pytest.fixture
def asked() -> Asked:
    return Asked()


def drawn(model: str) -> DrawnModel:
    return DrawnModel(f"/api/models/{model}/robot.urdf", own_colors=False)


@pytest.fixture
def feed(asked: Asked) -> PoseFeed:
    return PoseFeed(asked.show, drawn)


@pytest.fixture
def run(feed: PoseFeed) -> RunPoses:
    return feed.open(run_state())


async def layout_from(watcher: Watcher) -> Layout:
    news = await watcher.next()
    assert isinstance(news, Layout)
    return news


async def time_from(watcher: Watcher) -> float:
    news = await watcher.next()
    assert isinstance(news, bytes)
    return time_of(news)


async def test_a_watcher_gets_the_layout_then_the_frames(run: RunPoses) -> None:
    run.robot_connected(hello())
    with run.watched() as watcher:
        layout = await layout_from(watcher)
        run.take("arm", 1.5, poses())
        assert await time_from(watcher) == 1.5
    assert layout.model == "/api/models/pr2/robot.urdf"
    assert layout.joints == ["elbow"]
    assert layout.objects[0].color == (1.0, 0.0, 0.0)
    assert layout.places[0].position == (0.5, 0.1, 0.7)


async def test_a_slow_watcher_gets_only_the_latest_frame(run: RunPoses) -> None:
    run.robot_connected(hello())
    with run.watched() as slow:
        await layout_from(slow)
        for step in range(1000):
            run.take("arm", float(step), poses())
        assert await time_from(slow) == 999.0
        run.take("arm", 1000.0, poses())
        assert await time_from(slow) == 1000.0


async def test_who_comes_late_sees_the_last_frame_at_once(run: RunPoses) -> None:
    run.robot_connected(hello())
    run.take("arm", 3.0, poses())
    with run.watched() as watcher:
        await layout_from(watcher)
        assert await time_from(watcher) == 3.0


async def test_poses_are_asked_for_while_somebody_watches_and_no_longer(
    run: RunPoses, asked: Asked
) -> None:
    run.robot_connected(hello())
    with run.watched(), run.watched():
        pass
    assert asked == [("arm", 0.0), ("arm", 20.0), ("arm", 20.0), ("arm", 20.0), ("arm", 0.0)]


async def test_poses_are_asked_for_while_they_are_recorded(asked: Asked, tmp_path: Path) -> None:
    feed = PoseFeed(asked.show, lambda _: None, PoseRecords(tmp_path))
    run = feed.open(run_state())
    run.robot_connected(hello())
    run.take("arm", 2.0, poses())
    assert asked == [("arm", 20.0)]
    feed.close(RUN)
    assert [time_of(each) for each in (await feed.recorded(RUN, 0.0, 9.0, 10)).frames] == [2.0]
    assert await feed.layout(RUN) == run.layout
    feed.shut()


async def test_a_robot_that_shows_nothing_is_asked_for_nothing(
    run: RunPoses, asked: Asked, feed: PoseFeed
) -> None:
    run.robot_connected(hello(None))
    run.take("arm", 1.0, poses())
    assert run.layout is None
    assert run.frame is None
    assert asked == []
    assert await feed.layout(RUN) is None


async def test_poses_that_do_not_fit_the_layout_or_are_of_another_robot_are_left_out(
    run: RunPoses,
) -> None:
    run.robot_connected(hello())
    run.robot_connected(hello(PoseLayout(), robot="other"))
    run.take("arm", 1.0, poses(joints=2))
    run.take("other", 1.0, poses())
    assert run.frame is None
    assert run.layout is not None
    assert run.layout.robot == "arm"


async def test_a_robot_that_comes_back_with_another_layout_tells_it_before_new_frames(
    run: RunPoses,
) -> None:
    run.robot_connected(hello())
    with run.watched() as watcher:
        await layout_from(watcher)
        run.take("arm", 1.0, poses())
        run.robot_connected(hello(SHOWS.model_copy(update={"joints": ["a", "b"]}), boot="b2"))
        run.take("arm", 2.0, poses(joints=2))
        assert (await layout_from(watcher)).joints == ["a", "b"]
        assert await time_from(watcher) == 2.0


async def test_a_restart_with_the_same_layout_is_no_news(run: RunPoses) -> None:
    run.robot_connected(hello())
    with run.watched() as watcher:
        await layout_from(watcher)
        run.robot_connected(hello(boot="b2"))
        run.take("arm", 2.0, poses())
        assert await time_from(watcher) == 2.0


async def test_the_end_of_a_run_ends_the_watching_after_the_last_frame(
    run: RunPoses, feed: PoseFeed
) -> None:
    run.robot_connected(hello())
    with run.watched() as watcher:
        await layout_from(watcher)
        waiting = asyncio.create_task(watcher.next())
        run.take("arm", 1.0, poses())
        feed.close(RUN)
        assert await waiting is not None
        assert await watcher.next() is None
    assert feed.of(RUN) is None


class Driven:
    """A run with two robots that drive, the second of which begins at (10, 4), turned to y."""

    def __init__(self, asked: Asked) -> None:
        self.feed = PoseFeed(asked.show, lambda _: None)
        self.run = self.feed.open(driving_state(("first", Base(x=0, y=0)), ("second", TURNED)))
        for each in ("first", "second"):
            self.run.robot_connected(hello(PoseLayout(drives=True), robot=each))

    def at(self, robot: str, time_s: float, x: float, y: float = 0.0, z: float = 0.0) -> None:
        base = (x, y, z, 0.0, 0.0, 0.0, 1.0)
        self.run.take(robot, time_s, Poses(time=0.0, base=base, tool=IDENTITY, opening_m=0.0))

    def bases(self) -> list[tuple[float, ...]]:
        """Of each robot x, y, z, the quaternion, and how old that is."""
        assert self.run.frame is not None
        values = struct.unpack("<16f", self.run.frame[76:])
        return [values[:8], values[8:]]


TURNED = Base(x=10.0, y=4.0, yaw=math.pi / 2)


async def test_bases_of_all_robots_are_in_the_scenes_frame(asked: Asked) -> None:
    driven = Driven(asked)
    driven.at("first", 1.0, 2.0)
    driven.at("second", 1.0, 3.0, z=3.5)
    first, second = driven.bases()
    assert first == (2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    half = math.sqrt(0.5)
    assert second == pytest.approx((10.0, 7.0, 3.5, 0.0, 0.0, half, half, 0.0))
    assert driven.run.layout is not None
    assert driven.run.layout.robots == ["first", "second"]
    assert set(asked) == {("first", 0.0), ("second", 0.0)}


async def test_a_frame_waits_for_all_who_drive(asked: Asked) -> None:
    driven = Driven(asked)
    driven.at("second", 1.0, 3.0)
    assert driven.run.frame is None
    driven.at("first", 1.0, 2.0)
    assert driven.run.frame is not None


async def test_a_robot_that_says_nothing_more_is_shown_where_it_was_and_how_long_ago(
    asked: Asked,
) -> None:
    driven = Driven(asked)
    driven.at("first", 1.0, 2.0)
    driven.at("first", 2.0, 3.0)
    assert driven.bases()[1][7] == math.inf
    driven.at("second", 2.0, 5.0)
    for time_s in (6.0, 7.0, 8.0):
        driven.at("first", time_s, 4.0)
    first, second = driven.bases()
    assert (first[0], first[7]) == (4.0, 0.0)
    assert (second[1], second[7]) == (9.0, 5.0)


async def test_a_frame_comes_although_a_robot_stays_silent(asked: Asked) -> None:
    driven = Driven(asked)
    with driven.run.watched() as watcher:
        await layout_from(watcher)
        driven.at("first", 1.0, 2.0)
        assert await time_from(watcher) == 1.0


async def test_the_last_that_was_shown_is_passed_on_at_the_end(asked: Asked) -> None:
    driven = Driven(asked)
    with driven.run.watched() as watcher:
        await layout_from(watcher)
        driven.at("first", 1.0, 2.0)
        driven.feed.close(RUN)
        assert await time_from(watcher) == 1.0


async def test_another_model_has_the_robot_drawn_anew(asked: Asked) -> None:
    found: dict[str, DrawnModel] = {}
    feed = PoseFeed(asked.show, found.get)
    run = feed.open(run_state())
    run.robot_connected(hello())
    with run.watched() as watcher:
        assert (await layout_from(watcher)).model is None
        found["pr2"] = DrawnModel("/api/models/pr2/1/robot.urdf", own_colors=True)
        feed.models_changed()
        layout = await layout_from(watcher)
    assert (layout.model, layout.own_colors) == ("/api/models/pr2/1/robot.urdf", True)
