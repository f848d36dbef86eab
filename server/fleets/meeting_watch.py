"""Looks whether robots of a site have met whenever one says that it does not get on."""

import asyncio
import math
from collections.abc import Awaitable, Callable

from mend.fleet.right_of_way.right_of_way import Yielding
from mend.robots.link.messages import MakeWay, Poses
from mend.server.background import Endless
from mend.server.fleets.meetings import Meetings

EVERY_S = 0.5
"""It looks no more often, by the site's clock."""


class MeetingWatch:
    """Has `met` hear of who makes way, and then robots that drive `told` what to do.

    Of robots that rest with the place where they are to go. `now_s`: the site's clock, as far as
    robots tell of it.
    """

    def __init__(
        self,
        meetings: Meetings,
        told: Callable[[str, MakeWay], None],
        met: Callable[[Yielding, str | None], Awaitable[None]],
        now_s: Callable[[], float],
    ) -> None:
        self._meetings, self._told, self._met, self._now_s = meetings, told, met, now_s
        self._news = asyncio.Event()
        self._looks_s = -math.inf

    def take(self, robot: str, poses: Poses) -> None:
        """A robot says where it is."""
        if self._meetings.take(robot, poses) and self._now_s() >= self._looks_s:
            self._news.set()

    async def run(self) -> None:
        """Until it is cancelled."""
        watching = Endless("who makes way for whom")
        while True:
            await self._news.wait()
            self._news.clear()
            with watching.one_pass():
                await self._resolve()

    async def _resolve(self) -> None:
        now_s, standings = self._now_s(), self._meetings.standings()
        self._looks_s = now_s + EVERY_S
        decided = await asyncio.to_thread(self._meetings.decide, standings, now_s)
        if decided is None:
            return
        if not self._meetings.rests(decided.robot):
            # By the clocks of robots as they are now: until then time passes.
            all_told = self._meetings.told(decided, now_s)
            await self._met(decided, None)
            for robot, told in all_told:
                self._told(robot, told)
        elif (place := self._meetings.place_to_rest(decided, standings)) is not None:
            await self._met(decided, place)
        else:
            self._meetings.take_back(decided, now_s)
