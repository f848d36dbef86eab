"""A shift in a building: a site of its own, the requests of a file, and what happens meanwhile."""

import asyncio
from collections.abc import AsyncIterator, Mapping
from contextlib import suppress
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any, Literal

from mend.errors import ConflictError, RefusalError
from mend.fleet.happenings import (
    Cancelled,
    Happening,
    Lasting,
    NobodyAnswers,
    RobotFails,
    WayBarred,
    WrongFloor,
)
from mend.server.cli.failing_robot import FailingRobot
from mend.server.cli.failures import NOT_FINISHED
from mend.server.cli.local_user import local_author
from mend.server.cli.run_request import checked_request
from mend.server.cli.shift_timeline import Deed, Due, Timeline
from mend.server.cli.shift_transcript import ShiftTranscript
from mend.server.cli.silence import Silence
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
    from mend.fleet.request_file import RequestsDocument
    from mend.server.composition import Service
    from mend.server.fleets.fleet_at_work import FleetAtWork


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
        """Raises `CommandLineError` for options that cannot be."""
        self._scene = scene
        self._document = document
        self._site = checked_request(
            SiteRequest,
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
        self._failing: list[FailingRobot] = []

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
            fleet = await service.fleets.fleet(view.id)
            async with asyncio.TaskGroup() as tasks:
                telling = tasks.create_task(self._tell(service))
                happening = tasks.create_task(self._have_happen(service, fleet, robots))
                await self._over.wait()
                telling.cancel()
                happening.cancel()
            self._tell_what_did_not_come(fleet.now_s)
            await self._close(service, fleet)
        return 0 if self._told.sum_up() else NOT_FINISHED

    async def _close(self, service: "Service", fleet: "FleetAtWork") -> None:
        """Robots that still make way, or charge, do so no more."""
        await fleet.break_off_errands()
        # One that has not come to rest yet keeps the site, which ends with the service then.
        with suppress(ConflictError):
            await service.fleets.close_site(fleet.site)
            await service.sites.close_site(fleet.site, local_author())

    async def _tell(self, service: "Service") -> None:
        async for event in _events(service):
            self._told.tell(event)
            self._end_if_over()

    def _tell_what_did_not_come(self, now_s: float) -> None:
        for number, each in enumerate(self._document.happenings):
            if each.at_s > now_s:
                what = f"'happenings.{number}' ({each.kind}, at {each.at_s:g} s)"
                self._told.say(f"{what} did not come: everything was over before", now_s)
            elif isinstance(each, WrongFloor):
                self._tell_if_nobody_rode(each, now_s)
            elif isinstance(each, NobodyAnswers):
                until_s = inf if each.until_s is None else each.until_s
                why = self._told.why_nobody_was_silent(each.at_s, until_s)
                if why is not None:
                    self._told.say(why, now_s)
        for failing in self._failing:
            if failing.looks:
                self._told.say(failing.why_none(now_s), now_s)

    def _tell_if_nobody_rode(self, pressed: WrongFloor, now_s: float) -> None:
        if not self._told.was_at_wrong_floor(pressed.elevator, pressed.at_s):
            since = f"since {pressed.at_s:g} s, when another button was pressed in it"
            self._told.say(f"{pressed.elevator} took no robot to a wrong floor {since}", now_s)

    def _end_if_over(self) -> None:
        if not self._to_come and not self._told.open:
            self._over.set()

    # --- What happens ---------------------------------------------------------------------------

    async def _have_happen(
        self, service: "Service", fleet: "FleetAtWork", robots: Mapping[str, str]
    ) -> None:
        asked_s = self._document.asked_s
        timeline = Timeline(fleet.wait_until, lambda why: self._told.say(why, fleet.now_s))
        due = [
            Due(asked_s.get(each.name, 0.0), partial(self._ask, service, fleet, each))
            for each in self._document.requests
        ]
        silence = Silence(fleet.have_answered)
        for happening in self._document.happenings:
            match happening:
                case Cancelled(at_s=at_s, request=request):
                    due.append(Due(at_s, partial(_cancel, fleet, request)))
                case RobotFails(robot=named):
                    robot = None if named is None else robots.get(named, named)
                    failing = FailingRobot(fleet, happening, robot, timeline.beside)
                    self._failing.append(failing)
                    due += _lasting(happening, failing.begin, failing.end)
                case NobodyAnswers():
                    due += _lasting(happening, silence.begin, silence.end)
        await timeline.run(due)

    async def _ask(self, service: "Service", fleet: "FleetAtWork", request: "AnyRequest") -> None:
        try:
            _, booked = await service.fleets.submit(fleet.site, request, local_author())
            self._told.booked(booked.name)
        except RefusalError as error:
            self._told.refused(request.name, str(error), fleet.now_s)
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


def _lasting(happening: Lasting, begin: Deed, end: Deed) -> list[Due]:
    """What is to be told to the fleet, and when."""
    over = [] if happening.until_s is None else [Due(happening.until_s, end, ends=True)]
    return [Due(happening.at_s, begin), *over]


async def _cancel(fleet: "FleetAtWork", request: str) -> None:
    await fleet.requesters.cancel(request, local_author())


async def _events(service: "Service") -> AsyncIterator[ev.Event]:
    after = 0
    while True:
        with suppress(SubscriptionOverflowError), service.journal.subscribe(after) as records:
            async for record in records:
                after = record.seq
                yield read_event(record.seq, record.text)
            return
