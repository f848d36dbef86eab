"""A site tells its robots which ways are closed and what was taken out of their baskets, those
that know of such things."""

from collections.abc import Callable
from typing import Any, NoReturn
from uuid import UUID

from mend.robots.link.messages import (
    Avoid,
    BaseLimits,
    ClosedWay,
    FailedRobot,
    Hello,
    Intervened,
    MakeWay,
    NoteTaken,
)
from mend.server.runtime.clock import WorldTime
from mend.server.sites.site import Site
from mend.tasks.frames import Frame

LANE = frozenset(("F1/b", "F1/a"))
TOLD = Avoid(ways=[ClosedWay(between=["F1/a", "F1/b"], until=90.0)])


class FakeRegistry:
    """Robots that are connected, and what they are told of ways and of their baskets."""

    def __init__(self) -> None:
        self.hellos: dict[str, Hello] = {}
        self.told: list[tuple[str, Avoid | MakeWay | NoteTaken]] = []

    def connected(self, robot: str) -> bool:
        return robot in self.hellos

    def hello(self, robot: str) -> Hello | None:
        return self.hellos.get(robot)

    def poses(self, _: str) -> None:
        """Nobody says where it is."""

    def send(self, robot: str, _: str, body: Any, **__: object) -> None:
        if isinstance(body, Avoid | MakeWay | NoteTaken):
            self.told.append((robot, body))


class FakeWorld:
    time = WorldTime()

    def came(self, robot: str) -> None:
        """Nothing."""


def hello(robot: str, *, knows: bool = True, boot: str = "1") -> Hello:
    return Hello(
        protocol=1,
        robot=robot,
        boot=boot,
        behaviors=["go_to"],
        cameras=[],
        time=0.0,
        avoids_ways=knows,
        notes_taken=knows,
        base=BaseLimits(radius_m=0.25, speed_m_s=1.0) if knows else None,
    )


async def site_of(*hellos: Hello) -> tuple[Site, FakeRegistry]:
    registry: Any = FakeRegistry()
    journal: Any = None
    world: Callable[..., Any] = lambda _: FakeWorld()  # noqa: E731
    robots = {name: Frame() for name in ("ada", "bob")}
    site = Site(UUID(int=1), robots, world, registry, journal, lambda _: None, _no_event)
    for each in hellos:
        await come(site, registry, each)
    return site, registry


def _no_event(done: Intervened, at_s: float) -> NoReturn:
    raise AssertionError(f"{done} at {at_s} s, though nobody is there")


async def come(site: Site, registry: FakeRegistry, said: Hello) -> None:
    registry.hellos[said.robot] = said
    await site.robot_connected(said.robot, said)


async def test_those_that_know_of_such_things_are_told_once() -> None:
    site, registry = await site_of(hello("ada"), hello("bob", knows=False))
    assert not registry.told, "nothing is closed"
    site.keep_off({LANE: 90.0})
    site.keep_off({LANE: 90.0})
    assert registry.told == [("ada", TOLD)]
    site.keep_off({})
    assert registry.told[1:] == [("ada", Avoid())]


async def test_who_comes_later_is_told_then_and_who_comes_again_anew() -> None:
    site, registry = await site_of(hello("ada"))
    site.keep_off({LANE: 90.0})
    await come(site, registry, hello("bob"))
    await come(site, registry, hello("ada", boot="2"))
    assert registry.told == [("ada", TOLD), ("bob", TOLD), ("ada", TOLD)]


async def test_who_has_a_basket_is_told_once_what_was_taken_out_and_anew_when_it_comes() -> None:
    site, registry = await site_of(hello("ada"), hello("bob", knows=False))
    site.note_taken({"ada": ["mail"], "bob": ["keys"]})
    site.note_taken({"ada": ["mail"], "bob": ["keys"]})
    mail = NoteTaken(items=["mail"])
    assert registry.told == [("ada", mail)]
    await come(site, registry, hello("ada", boot="2"))
    assert registry.told[1:] == [("ada", mail)]
    site.note_taken({"ada": ["mail", "tea"]})
    assert registry.told[2:] == [("ada", NoteTaken(items=["mail", "tea"]))]
    site.note_taken({})
    await come(site, registry, hello("ada", boot="3"))
    assert len(registry.told) == 3


async def test_who_does_not_know_of_making_way_is_not_told_to() -> None:
    site, registry = await site_of(hello("ada"), hello("bob", knows=False))
    told = MakeWay(other="carl", until=9.0)
    for robot in ("ada", "bob", "carl"):
        site.make_way(robot, told)
    assert registry.told == [("ada", told)]


async def test_who_is_heard_of_ways_is_told_to_wait_before_it_asks() -> None:
    site, registry = await site_of(hello("ada"))
    site.hear_of_ways(3.0)
    await come(site, registry, hello("bob"))
    assert registry.told == [(name, Avoid(asks_after_s=3.0)) for name in ("ada", "bob")]
    site.keep_off({LANE: 90.0})
    assert registry.told[2:] == [
        (name, TOLD.model_copy(update={"asks_after_s": 3.0})) for name in ("ada", "bob")
    ]


async def test_where_robots_stand_that_have_failed_the_others_are_told_in_their_own_frames() -> (
    None
):
    site, registry = await site_of(hello("ada"), hello("bob"))
    site._seen_at["bob"] = (4.04, 2.0, 3.5)
    site.keep_off({}, ["bob"])
    stands = FailedRobot(robot="bob", x=4.0, y=2.0, z=3.5)
    assert registry.told == [("ada", Avoid(failed=[stands])), ("bob", Avoid())]
    site.keep_off({}, ["bob"])
    await come(site, registry, hello("ada", boot="2"))
    assert registry.told[2:] == [("ada", Avoid(failed=[stands]))]
    site.keep_off({})
    assert registry.told[3:] == [("ada", Avoid()), ("bob", Avoid())]
