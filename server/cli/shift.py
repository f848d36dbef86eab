"""A shift in a building: a site of its own, the requests of a file, and what happens meanwhile."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Literal
from uuid import UUID

from mend.errors import ConflictError, RefusalError
from mend.fleet.happenings import (
    Cancelled,
    Happening,
    NobodyAnswers,
    RobotFails,
    WayBarred,
    WrongFloor,
)
from mend.fleet.requests import LegAction
from mend.server.cli.failures import NOT_FINISHED
from mend.server.cli.local_user import local_author
from mend.server.cli.shift_transcript import ShiftTranscript
from mend.server.documents import DocumentKind
from mend.server.fixed_documents import GivenFiles
from mend.server.journal import events as ev
from mend.server.journal.stored_event import read_event
from mend.server.journal.subscriptions import SubscriptionOverflowError
from mend.server.settings import Settings
from mend.server.sites.requests import FleetOptions, SiteRequest
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import Scene

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import AnyRequest
    from mend.fleet.dispatch.dispatcher import Dispatcher
    from mend.fleet.request_file import RequestsDocument
    from mend.server.composition import Service
    from mend.server.fleets.fleet_at_work import FleetAtWork


_BRINGS_WITHIN_S, _LOOKS_EVERY_S, _STILL_DRIVES_S = 1800.0, 5.0, 15.0
"""A robot that is to fail while it brings something is looked for so long, so often, and is one
that drives so much longer."""


@dataclass(frozen=True, slots=True)
class Due:
    """Something to be done at a moment of the site's clock."""

    at_s: float
    do: Callable[[], Awaitable[None]]


class Shift:
    """Has the robots of a scene meet requests, whatever happens, and prints that."""

    def __init__(
        self,
        scene: Scene,
        document: "RequestsDocument",
        *,
        seed: int,
        options: dict[str, Any],
        fleet: FleetOptions,
        speed: float | Literal["max"],
    ) -> None:
        self._scene = scene
        self._document = document
        self._site = SiteRequest(
            scene=scene.name,
            world="building",
            speed=speed,
            seed=seed,
            world_options=options,
            fleet=fleet,
            interventions=_interventions(document.happenings),
        )
        self._told = ShiftTranscript([each.name for each in document.requests])
        self._to_come = len(document.requests)
        self._over = asyncio.Event()

    @property
    def ended(self) -> Mapping[str, str]:
        """What became of each request that is over, by its name."""
        return self._told.ended

    async def carry_out(self, settings: Settings) -> int:
        """Run it to its end and return the exit code: 0 where everything was done."""
        from mend.server.composition import open_service

        text = self._scene.model_dump_json(exclude_defaults=True)
        given = GivenFiles({DocumentKind.SCENE: {self._scene.name: text}})
        async with open_service(settings, recover=False, given=given) as service:
            view = await service.sites.open_site(self._site, local_author())
            robots = {each.stands: each.robot for each in view.robots}
            async with asyncio.TaskGroup() as tasks:
                telling = tasks.create_task(self._tell(service))
                happening = tasks.create_task(self._have_happen(service, view.id, robots))
                await self._over.wait()
                telling.cancel()
                happening.cancel()
            await self._close(service, view.id)
        return 0 if self._told.sum_up() else NOT_FINISHED

    async def _close(self, service: "Service", site: UUID) -> None:
        """Robots that still make way do so no more."""
        await service.fleets.close_site(site)
        with suppress(ConflictError):
            await service.sites.close_site(site, local_author())

    async def _tell(self, service: "Service") -> None:
        async for event in _events(service):
            self._told.tell(event)
            self._end_if_over()

    def _end_if_over(self) -> None:
        if not self._to_come and not self._told.open:
            self._over.set()

    # --- What happens ---------------------------------------------------------------------------

    async def _have_happen(self, service: "Service", site: UUID, robots: Mapping[str, str]) -> None:
        fleet = await service.fleets.fleet(site)
        asked_s = self._document.asked_s
        due = [
            Due(asked_s.get(each.name, 0.0), partial(self._ask, service, site, each))
            for each in self._document.requests
        ]
        for happening in self._document.happenings:
            due += _moments(happening, fleet, robots)
        for each in sorted(due, key=lambda each: each.at_s):
            await fleet.wait_until(each.at_s)
            try:
                await each.do()
            except RefusalError as error:
                self._told.say(str(error))

    async def _ask(self, service: "Service", site: UUID, request: "AnyRequest") -> None:
        try:
            _, booked = await service.fleets.submit(site, request, local_author())
            self._told.booked(booked.name)
        except RefusalError as error:
            self._told.refused(request.name, str(error))
        self._to_come -= 1
        self._end_if_over()


def _interventions(happenings: tuple[Happening, ...]) -> list[ScriptedIntervention]:
    """What people do in the building itself."""
    done = []
    for each in happenings:
        if isinstance(each, WayBarred):
            bar = Intervention(act=Act.BAR, between=each.between)
            done.append(ScriptedIntervention(at_s=each.at_s, do=bar))
            if each.until_s is not None:
                clear = Intervention(act=Act.CLEAR, between=each.between)
                done.append(ScriptedIntervention(at_s=each.until_s, do=clear))
        elif isinstance(each, WrongFloor):
            press = Intervention(act=Act.MISDIRECT, elevator=each.elevator)
            done.append(ScriptedIntervention(at_s=each.at_s, do=press))
    return done


def _moments(happening: Happening, fleet: "FleetAtWork", robots: Mapping[str, str]) -> list[Due]:
    """What is to be told to the fleet, and when."""
    author = local_author()
    match happening:
        case WayBarred() | WrongFloor():
            return []
        case Cancelled(at_s=at_s, request=request):

            async def cancel() -> None:
                await fleet.cancel(request, author)

            return [Due(at_s, cancel)]
        case RobotFails(robot=robot, reason=reason):
            failing = _Failing(fleet, None if robot is None else robots.get(robot, robot), reason)
            begin, end = failing.begin, failing.end
        case NobodyAnswers():
            begin = partial(fleet.have_answered, "late")
            end = partial(fleet.have_answered, "yes")
    over = [] if happening.until_s is None else [Due(happening.until_s, end)]
    return [Due(happening.at_s, begin), *over]


class _Failing:
    """A robot that fails, and works again; where none is named, one that brings something."""

    def __init__(self, fleet: "FleetAtWork", robot: str | None, reason: str) -> None:
        self._fleet, self._robot, self._reason = fleet, robot, reason

    async def begin(self) -> None:
        """Raises `ConflictError` where no robot brings anything for long."""
        until_s = self._fleet.now_s + _BRINGS_WITHIN_S
        while self._robot is None:
            self._robot = await self._fleet.read(who_brings)
            if self._robot is None:
                if self._fleet.now_s >= until_s:
                    raise ConflictError("no robot fails: none was on its way with anything")
                await self._fleet.wait_until(self._fleet.now_s + _LOOKS_EVERY_S)
        await self._fleet.operators.take_out(self._robot, self._reason, local_author())

    async def end(self) -> None:
        if self._robot is not None:
            await self._fleet.operators.put_back(self._robot, local_author())


def who_brings(dispatcher: "Dispatcher") -> str | None:
    """The robot with the longest way to where it hands something over; None for short ones.

    None either for who meets another robot: its failure would undo that.
    """
    meets = {
        robot
        for robot, stops in dispatcher.stops().items()
        if any(action in (LegAction.GIVE, LegAction.TAKE) for _, action in stops)
    }
    left_s = {
        leg.robot: leg.begins_s - dispatcher.now_s
        for leg in dispatcher.legs_under_way()
        if leg.action is LegAction.HAND_OVER and leg.robot not in meets
    }
    robot = max(left_s, key=lambda each: left_s[each], default=None)
    return None if robot is None or left_s[robot] < _STILL_DRIVES_S else robot


async def _events(service: "Service") -> AsyncIterator[ev.Event]:
    after = 0
    while True:
        with suppress(SubscriptionOverflowError), service.journal.subscribe(after) as records:
            async for record in records:
                after = record.seq
                yield read_event(record.seq, record.text)
            return
