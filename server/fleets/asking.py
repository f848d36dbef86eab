"""How people ask the robots of a fleet in words, also at the touch screen of one of them."""

import asyncio
from typing import TYPE_CHECKING, Annotated, Any
from uuid import UUID, uuid4

from pydantic import BaseModel, ConfigDict, Field

from mend.documents.spellings import CLOCK
from mend.fleet.asking.deadline import By, Deadline, minutes_left
from mend.fleet.asking.understanding import AskedBack, understood
from mend.fleet.requests import LAST_S, RequestKind
from mend.server.fleets.item_names import made_name
from mend.server.runtime.views import View

if TYPE_CHECKING:
    from mend.server.fleets.fleet_at_work import FleetAtWork

MOST_CHARACTERS = 500
_SPEED_OF_DAYS = 1.0
_MARK_DIGITS = 8


class WordsAsked(BaseModel):
    """What somebody says that they want.

    `robot`: at whose touch screen, so that it is known where "here" is; `clock`: how late it is
    there, so that it is known which three o'clock is the next.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    words: Annotated[str, Field(min_length=1, max_length=MOST_CHARACTERS)]
    robot: Annotated[str, Field(max_length=128)] | None = None
    clock: Annotated[str, Field(pattern=CLOCK)] | None = None


class UnderstoodView(View):
    """A request to be made once somebody has said yes to `read_back`, or the `question` to answer
    first: either both of the former or the latter is there."""

    request: dict[str, Any] | None = None
    read_back: str | None = None
    question: str | None = None


class AskedRobotView(View):
    """A robot at whose touch screen somebody may ask: where it is (`here`, as `FLOOR/PLACE`; None
    where no robot is sent), and for what kinds of requests. Where one that is not `connected` is,
    nobody knows: `here` is where it was last."""

    site: UUID
    robot: str
    connected: bool
    here: str | None
    kinds: list[RequestKind]


def asked_robot(fleet: "FleetAtWork", robot: str) -> AskedRobotView:
    """What somebody finds at a robot's touch screen. Raises `NotFoundError`."""
    return AskedRobotView(
        site=fleet.site,
        robot=robot,
        here=fleet.stands_at(robot),
        connected=fleet.is_connected(robot),
        kinds=fleet.requesters.kinds,
    )


async def understand(fleet: "FleetAtWork", asked: WordsAsked) -> UnderstoodView:
    """What is asked for, with a name and by the clock of the site. Raises `NotFoundError`."""
    here = None if asked.robot is None else fleet.stands_at(asked.robot)
    now_min = None if asked.clock is None else _minute_of(asked.clock)
    places = fleet.requesters.spoken_places
    found = await asyncio.to_thread(understood, asked.words, places, here=here, now_min=now_min)
    if isinstance(found, AskedBack):
        return UnderstoodView(question=found.question)
    latest_s = None
    if found.deadline is not None:
        question = _no_time_of_day(fleet, found.deadline, now_min)
        if question is not None:
            return UnderstoodView(question=question)
        latest_s = _latest_s(fleet, found.deadline, now_min or 0)
    name = made_name(found.request, uuid4().hex[:_MARK_DIGITS])
    request = found.request.model_copy(update={"name": name, "latest_s": latest_s})
    return UnderstoodView(
        request=request.model_dump(mode="json", exclude_none=True), read_back=found.read_back
    )


def _minute_of(clock: str) -> int:
    hour, minute = clock.split(":")
    return int(hour) * 60 + int(minute)


def _no_time_of_day(fleet: "FleetAtWork", deadline: Deadline, now_min: int | None) -> str | None:
    """What to ask where a time of the day says nothing."""
    if not isinstance(deadline, By) or (fleet.pace is not None and now_min is not None):
        return None
    return "I do not know how late it is: say in how many minutes you want it."


def _latest_s(fleet: "FleetAtWork", deadline: Deadline, now_min: int) -> float:
    """When that is by the site's clock, which may go faster than days do."""
    pace = fleet.pace if isinstance(deadline, By) and fleet.pace else _SPEED_OF_DAYS
    return min(fleet.now_s + 60.0 * minutes_left(deadline, now_min) * pace, LAST_S)
