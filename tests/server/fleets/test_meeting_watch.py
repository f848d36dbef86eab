"""Who makes way: it is known, and in the journal, before any robot is told of it."""

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass, field

from mend.fleet.right_of_way.right_of_way import Yielding
from mend.robots.link.messages import IDENTITY, MakeWay, Poses
from mend.server.fleets.meeting_watch import MeetingWatch

MAKES_WAY = Yielding(robot="ada", other="bob", way=[(0.0, 0.0), (1.0, 0.0)], until_s=9.0)
POSES = Poses(time=1.0, base=IDENTITY, tool=IDENTITY, opening_m=0.0, barred=True)


@dataclass
class Met:
    """Meetings at which one robot is to make way, and what is done about it, in order."""

    rests_at: str | None = None
    rested: bool = False
    done: list[str] = field(default_factory=list)
    begun: asyncio.Event = field(default_factory=asyncio.Event)
    journal: asyncio.Event = field(default_factory=asyncio.Event)

    def take(self, _robot: str, _poses: Poses) -> bool:
        return True

    def standings(self) -> dict[str, object]:
        return {}

    def decide(self, _standings: object, _now_s: float) -> Yielding | None:
        return MAKES_WAY

    def rests(self, _robot: str) -> bool:
        return self.rested

    def place_to_rest(self, _decided: Yielding, _standings: object) -> str | None:
        return self.rests_at

    def take_back(self, decided: Yielding, _now_s: float) -> None:
        self.done.append(f"{decided.robot} does not make way")
        self.begun.set()

    def told(self, decided: Yielding, _now_s: float) -> Sequence[tuple[str, MakeWay]]:
        return [(decided.robot, MakeWay(other=decided.other, until=9.0))]

    def tell(self, robot: str, _told: MakeWay) -> None:
        self.done.append(f"{robot} is told")

    async def note(self, decided: Yielding, place: str | None) -> None:
        self.done.append("to be journaled")
        self.begun.set()
        await self.journal.wait()
        self.done.append(f"journaled: {decided.robot} goes to {place or 'its bay'}")


async def watched(met: Met) -> list[str]:
    """What is done once a robot says that it does not get on; the journal can be written later."""
    watch = MeetingWatch(met, met.tell, met.note, lambda: 5.0)  # type: ignore[arg-type]
    running = asyncio.create_task(watch.run())
    watch.take("ada", POSES)
    await met.begun.wait()
    assert len(met.done) == 1
    met.journal.set()
    for _ in range(20):
        await asyncio.sleep(0)
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)
    return met.done


async def test_who_makes_way_hears_of_it_once_it_is_journaled() -> None:
    assert await watched(Met()) == [
        "to be journaled",
        "journaled: ada goes to its bay",
        "ada is told",
    ]


async def test_who_rests_is_sent_elsewhere_and_told_nothing_else() -> None:
    met = Met(rests_at="F1/parking", rested=True)
    assert await watched(met) == ["to be journaled", "journaled: ada goes to F1/parking"]


async def test_who_rests_and_can_be_sent_nowhere_does_not_make_way() -> None:
    assert await watched(Met(rested=True)) == ["ada does not make way"]
