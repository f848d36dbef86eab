"""A robot that fails in a shift: the one that is named, or the next one that brings something."""

from collections.abc import Callable, Collection
from functools import partial
from typing import TYPE_CHECKING

from mend.errors import ConflictError
from mend.fleet.happenings import RobotFails
from mend.fleet.requests import LegAction
from mend.server.cli.local_user import local_author
from mend.server.cli.shift_timeline import Deed

if TYPE_CHECKING:
    from mend.fleet.dispatch.dispatcher import Dispatcher
    from mend.server.fleets.fleet_at_work import FleetAtWork

BRINGS_WITHIN_S, LOOKS_EVERY_S = 1800.0, 5.0
"""One that brings something is looked for so long, where nothing says until when, and so often."""
_STILL_DRIVES_S = 15.0
"""So much longer it is to be on its way."""


class FailingRobot:
    """Is taken out of service, and put back in."""

    def __init__(
        self,
        fleet: "FleetAtWork",
        happening: RobotFails,
        robot: str | None,
        beside: Callable[[Deed], None],
    ) -> None:
        """`robot`: its name at the site; None for the next one that brings something, which is
        looked for `beside` all else.
        """
        self._fleet, self._happening, self._beside = fleet, happening, beside
        self._named = robot
        self._failed: str | None = None
        self.looks = False
        """Whether one is looked for that brings something."""

    async def begin(self) -> None:
        """Raises `ConflictError` where it is out of service already."""
        if self._named is None:
            self._beside(self._have_one_fail)
        else:
            await self._take_out(self._named)

    async def end(self) -> None:
        """It works again, if it has failed."""
        failed, self._failed = self._failed, None
        if failed is not None:
            await self._fleet.operators.put_back(failed, local_author())

    async def _take_out(self, robot: str) -> None:
        reason = self._happening.reason
        await self._fleet.operators.take_out(robot, reason, local_author())
        self._failed = robot

    async def _have_one_fail(self) -> None:
        """Raises `ConflictError` where no robot has brought anything until it is to work again."""
        self.looks = True
        since_s, until_s = self._happening.at_s, self._happening.until_s
        last_s = since_s + BRINGS_WITHIN_S if until_s is None else until_s
        while self._fleet.now_s < last_s:
            robot = await self._fleet.read(partial(who_brings, out=self._fleet.out_of_service))
            if robot is not None:
                self.looks = False
                await self._take_out(robot)
                if until_s is not None and self._fleet.now_s >= until_s:
                    # Its time to work again came while it was being taken out.
                    await self.end()
                return
            await self._fleet.wait_until(min(self._fleet.now_s + LOOKS_EVERY_S, last_s))
        self.looks = False
        raise ConflictError(self.why_none(last_s))

    def why_none(self, until_s: float) -> str:
        """Why no robot has failed until a moment (s) at which one was still looked for."""
        return (
            f"no robot fails ({self._happening.reason}): from {self._happening.at_s:g} to "
            f"{until_s:g} s none was on a long way with anything"
        )


def who_brings(dispatcher: "Dispatcher", out: Collection[str] = ()) -> str | None:
    """The robot with the longest way to where it hands something over; None for short ones.

    None either for who meets another robot: its failure would undo that. `out`: who is out of
    service already.
    """
    meets = {
        robot
        for robot, stops in dispatcher.stops().items()
        if any(action in (LegAction.GIVE, LegAction.TAKE) for _, action in stops)
    }
    left_s = {
        leg.robot: leg.begins_s - dispatcher.now_s
        for leg in dispatcher.legs_under_way()
        if leg.action is LegAction.HAND_OVER and leg.robot not in meets and leg.robot not in out
    }
    robot = max(left_s, key=lambda each: left_s[each], default=None)
    return None if robot is None or left_s[robot] < _STILL_DRIVES_S else robot
