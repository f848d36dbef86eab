"""One drawn building whose service is killed while anything happens there, and what was found."""

import asyncio
import json
import os
import signal
import sqlite3
import sys
import time
from collections import Counter
from collections.abc import Awaitable, Callable
from contextlib import closing, suppress
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any, Literal, TypeVar
from uuid import UUID

import ordeal_world
from chaos_witness import Witness
from ordeal_happenings import OVER, NothingToDoError, SiteHappenings
from ordeal_kills import draw_kills, kills_so_far, write_kills
from ordeal_ledger import OrdealLedger, Setting
from ordeal_people import People, is_near
from ordeal_truth import Truth
from service_process import ServiceProcess

from mend.errors import MendError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.setting import FleetSetting, Policy, ServiceRobot
from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.random_building import random_building
from mend.server.client import MendClient
from mend.server.client_errors import RefusedError, UnreachableError
from mend.server.fleets.fleet_opening import KEPT
from mend.server.fleets.fleet_record import FleetRecord
from mend.server.fleets.views import FleetView
from mend.server.sites.requests import FleetOptions, SiteRequest
from mend.server.sites.views import SiteView
from mend.sim.building.scene import scene_of

T = TypeVar("T")

CAPACITY = 3.0
GAP_S = 6.0
"""Something happens about so often, by the site's clock."""
LOOKS_EVERY_S = 0.2
BOUND_S = 2 * 3600.0
"""By the site's clock everything is over so long after the last thing that happens."""
STARTS_S = 300.0
"""Patience with a start, on a machine that is busy."""
PATIENCE_S = 120.0
"""With one answer of the service."""
STANDS_STILL_S = 180.0
"""A site's clock that stands for so long, while something is open, hangs (wall time)."""
DIES_S = 10.0
"""What does not answer, and has not ended for so long, was not killed (wall time)."""
KILLED_AGAIN = 0.2
SMALL_BATTERY_WH = 6.0
"""Of robots that have to charge: such a one stands for 6 min."""
LATEST_S = 120.0
"""Kills come so much later than what happens at the latest, by the site's clock."""
SETTINGS = {
    "MEND_SPEECH_VOICE": "none",
    "MEND_SPEECH_RECOGNITION": "false",
    "MEND_ASK_DEADLINE_S": "6",
    "MEND_HELP_WINDOW_S": "20",
    "MEND_CLAIM_LEASE_S": "5",
    "MEND_ROBOT_LOST_TIMEOUT_S": "30",
}


@dataclass(frozen=True, slots=True)
class Drawn:
    """A building of an ordeal: how large it is, and how its robots know where they are."""

    seed: int
    floors: int
    rooms: int
    robots: int
    localizer: str
    apart: bool
    battery_wh: float

    @classmethod
    def of(cls, seed: int) -> "Drawn":
        """The one of a seed."""
        chance = Random(seed)
        return cls(
            seed=seed,
            floors=chance.choice((1, 1, 2, 2, 3)),
            rooms=chance.randint(6, 14),
            robots=chance.randint(2, 5),
            localizer="enml" if seed % 4 == 0 else "exact",
            apart=seed % 2 == 0,
            battery_wh=SMALL_BATTERY_WH if seed % 3 == 0 else 0.0,
        )

    @property
    def options(self) -> dict[str, Any]:
        """What the world has to choose."""
        return {
            "localizer": self.localizer, "unmapped": 0.1, "shut_doors": 0.3, "people": 3,
            "wrong_floors": 0.2, "forgetful": 0.1, "no_shows": 0.1, "dawdling": 0.2,
            "blocked_hallways": 0.1, "carried_every_s": 120.0, "lies": 0.1, "steals_every_s": 240.0,
            "battery_wh": self.battery_wh,
        }  # fmt: skip

    def __str__(self) -> str:
        process = "a process of its own" if self.apart else "the service's process"
        return (
            f"seed {self.seed}: {self.floors} floors, {self.rooms} rooms each, {self.robots} robots"
            f" ({self.localizer}{', small batteries' if self.battery_wh else ''}),"
            f" its world in {process}"
        )


@dataclass(slots=True)
class Outcome:
    """What one building has come to."""

    drawn: Drawn
    findings: list[str] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    simulated_s: float = 0.0
    settled_s: float = 0.0

    @property
    def events(self) -> int:
        """What happened, what robots ended, what somebody was asked, and kills."""
        happened = sum(n for what, n in self.counts.items() if what.startswith("happened: "))
        # Those that came about are among what the world has seen stolen.
        happened -= self.counts["happened: steal"]
        others = (
            "question",
            "errand ended",
            "carried",
            "stolen",
            "killed service",
            "killed robots",
        )
        legs = sum(n for what, n in self.counts.items() if what.startswith("leg "))
        return happened + legs + sum(self.counts[each] for each in others)


class BuildingOrdeal:
    """`minutes`: so long things happen there, by the site's clock; `kills`: how many meanwhile.

    `speed`: seconds of the site's clock a second at most, so that there is time for things to
    happen on any machine. `truth`: what its worlds wrote. `forked`: as `ServiceProcess` has it.
    """

    def __init__(
        self,
        drawn: Drawn,
        folder: Path,
        minutes: float,
        kills: int,
        tell: Callable[[str], None] = lambda _: None,
        speed: float | Literal["max"] = "max",
        *,
        forked: bool = False,
    ) -> None:
        self._drawn, self._folder, self._tell, self._speed = drawn, folder, tell, speed
        self._chance = Random(drawn.seed + 3)
        self._ends_s = 60.0 * minutes
        self._kills_again = Random(drawn.seed + 4)
        self.building = Building(random_building(drawn.seed, drawn.floors, drawn.rooms))
        rooms = self.building.of_kind(PlaceKind.ROOM)
        self._transfers = tuple(self._chance.sample(rooms, min(4, len(rooms))))
        self.scene = scene_of(self.building, "ordeal", drawn.robots)
        self.truth = folder / "truth.jsonl"
        self.kills = draw_kills(self._chance, kills, self._ends_s, apart=drawn.apart)
        write_kills(self.kills, self.truth)
        ordeal_world.install(folder / "worlds")
        paths = [str(folder / "worlds"), *(each for each in sys.path if each)]
        self._service = ServiceProcess(
            folder, forked=forked, PYTHONPATH=os.pathsep.join(paths), **SETTINGS,
            **{ordeal_world.TRUTH: str(self.truth)},
        )  # fmt: skip
        self._witness = Witness()
        self._people = People(self._service.url, self._witness, drawn.seed, self._is_there)
        self._plans: dict[int, str] = {}
        self._robots: list[str] = []
        self._asked: dict[str, str] = {}
        self._outcome = Outcome(drawn)
        self._moved_at, self._last_s = time.monotonic(), -1.0

    async def go_through(self) -> Outcome:
        """Raises what `MendClient` does where the service does not start."""
        outcome, happenings = self._outcome, None
        await self._start()
        following = asyncio.create_task(self._people.follow())
        try:
            async with MendClient(self._service.url, timeout_s=PATIENCE_S) as client:
                site = await self._open(client)
                happenings = SiteHappenings(
                    client,
                    self._service.url,
                    site.id,
                    self.building,
                    self._drawn.seed,
                    2 * self._drawn.robots + 2,
                )
                fleet = await self._let_happen(client, site.id, happenings)
                fleet = await self._settle(client, site.id, happenings, fleet)
                await self._close(client, site.id)
                await self._wait_for_the_news()
        except Exception as error:
            outcome.findings.append(f"{self._last_s:.1f} s: {type(error).__name__}: {error}")
        finally:
            following.cancel()
            await asyncio.gather(following, return_exceptions=True)
            code = await self._service.stop()
        if code != 0:
            outcome.findings.append(f"the service ended with {code}")
        self._judge(happenings)
        return outcome

    async def _start(self) -> None:
        """Until it is ready; one that is killed as it starts, when that is due, starts again."""
        while not await self._starts():
            self._tell(f"{self._last_s:8.1f} s  the service was killed as it started")

    async def _starts(self) -> bool:
        await self._service.spawn()
        async with MendClient(self._service.url) as client:
            ended = asyncio.create_task(self._service.process.wait())
            ready = asyncio.create_task(client.wait_until_ready(STARTS_S))
            await asyncio.wait((ended, ready), return_when=asyncio.FIRST_COMPLETED)
            for each in (ended, ready):
                each.cancel()
            await asyncio.gather(ended, ready, return_exceptions=True)
        if ready.cancelled():
            if ended.result() != -signal.SIGKILL:
                raise UnreachableError(f"the service ended with {ended.result()} as it started")
            return False
        ready.result()
        return True

    async def _open(self, client: MendClient) -> SiteView:
        await client.upload_scene(self.scene.model_dump_json(exclude_defaults=True), "ordeal")
        site = await client.open_site(
            SiteRequest(
                scene="ordeal",
                world="witnessed_apart" if self._drawn.apart else "witnessed",
                speed=self._speed,
                seed=self._drawn.seed,
                world_options=self._drawn.options,
                fleet=FleetOptions(capacity=CAPACITY, transfer_places=self._transfers),
            )
        )
        self._robots = [each.robot for each in site.robots]
        return site

    # --- What happens ---------------------------------------------------------------------------

    async def _let_happen(
        self, client: MendClient, site: UUID, happenings: SiteHappenings
    ) -> FleetView:
        fleet = await self._look(client, site)
        next_s = 0.0
        while fleet.now_s < self._ends_s or self._awaits_kills(fleet.now_s):
            if fleet.now_s >= next_s or not await self._goes_on(client, site):
                next_s = fleet.now_s + self._chance.expovariate(1.0 / GAP_S)
                try:
                    said = await happenings.happen(fleet)
                except UnreachableError as error:
                    said = f"nobody answered: {error}"
                if said:
                    self._tell(f"{fleet.now_s:8.1f} s  {said}")
            else:
                await asyncio.sleep(LOOKS_EVERY_S)
            fleet = await self._look(client, site)
        return fleet

    def _awaits_kills(self, now_s: float) -> bool:
        """Whether some that were drawn have not come: while things happen the clock goes on."""
        return now_s < self._ends_s + LATEST_S and kills_so_far(self.truth) < len(self.kills)

    async def _goes_on(self, client: MendClient, site: UUID) -> bool:
        """Whether anything is open: else its clock stands."""
        views = await self._answer(lambda: client.requests(site))
        return any(each.status not in OVER for each in views)

    async def _look(self, client: MendClient, site: UUID) -> FleetView:
        fleet = await self._answer(lambda: client.fleet(site))
        if fleet.now_s != self._last_s:
            self._last_s, self._moved_at = fleet.now_s, time.monotonic()
        elif time.monotonic() - self._moved_at > STANDS_STILL_S:
            raise TimeoutError(f"the site's clock stands still: {await _told(client, site)}")
        self._note_plan()
        return fleet

    async def _answer(self, ask: Callable[[], Awaitable[T]]) -> T:
        """What the service says, also if it is killed before it does."""
        while True:
            try:
                return await ask()
            except UnreachableError:
                if not await self._was_killed():
                    raise
                await self._start_again()

    async def _was_killed(self) -> bool:
        with suppress(TimeoutError):
            async with asyncio.timeout(DIES_S):
                return await self._service.process.wait() == -signal.SIGKILL
        return False

    async def _start_again(self) -> None:
        """At times it is killed once more while it starts."""
        self._tell(f"{self._last_s:8.1f} s  the service was killed")
        self._note_plan()
        while self._kills_again.random() < KILLED_AGAIN:
            await self._service.spawn()
            await asyncio.sleep(self._kills_again.uniform(0.2, 3.0))
            await self._service.kill()
            self._outcome.counts["killed service"] += 1
        await self._start()
        self._moved_at = time.monotonic()

    async def _settle(
        self, client: MendClient, site: UUID, happenings: SiteHappenings, fleet: FleetView
    ) -> FleetView:
        """Nothing more happens, and everybody is willing: all comes to its end."""
        began_s = fleet.now_s
        self._people.calm = True
        self.truth.with_name(self.truth.name + ordeal_world.CALM).touch()
        self._tell(f"{fleet.now_s:8.1f} s  nothing more is to happen")
        while await self._goes_on(client, site):
            with suppress(RefusedError, NothingToDoError, UnreachableError):
                await happenings.calm_down(fleet)
            await asyncio.sleep(LOOKS_EVERY_S)
            fleet = await self._look(client, site)
            if fleet.now_s - began_s > BOUND_S:
                raise TimeoutError(f"this is not over: {await _told(client, site)}")
        self._outcome.simulated_s = fleet.now_s
        self._outcome.settled_s = fleet.now_s - began_s
        return fleet

    async def _close(self, client: MendClient, site: UUID) -> None:
        """Once no robot is on its way any more, also to where it charges."""
        began_s = self._last_s
        while True:
            try:
                await self._answer(lambda: client.close_site(site))
                return
            except RefusedError as error:
                await asyncio.sleep(LOOKS_EVERY_S)
                if (await self._look(client, site)).now_s - began_s > BOUND_S:
                    raise TimeoutError(f"this is not over: {error}") from error

    async def _wait_for_the_news(self) -> None:
        """Until who follows has heard all that is in the journal."""
        with closing(self._connected()) as journal:
            (last,) = journal.execute(
                "SELECT max(seq) FROM events WHERE run != ?", (str(UUID(int=0)),)
            ).fetchone()
        async with asyncio.timeout(STANDS_STILL_S):
            while self._people.seen < (last or 0):  # noqa: ASYNC110 - as it is
                await asyncio.sleep(LOOKS_EVERY_S)

    # --- What is seen meanwhile -----------------------------------------------------------------

    def _connected(self) -> sqlite3.Connection:
        return sqlite3.connect(f"file:{self._service.journal}?mode=ro", uri=True)

    def _note_plan(self) -> None:
        """What the journal keeps of the fleet, once for each change of its plan."""
        with closing(self._connected()) as journal:
            rows = journal.execute("SELECT text FROM documents WHERE kind = 'fleet'").fetchall()
        for (text,) in rows:
            self._plans[json.loads(text)["dispatcher"]["change_count"]] = text

    def _is_there(self, robot: str, said: str) -> bool:
        if not self.truth.exists():
            return False
        with self.truth.open("rb") as file:
            file.seek(max(0, file.seek(0, os.SEEK_END) - 20_000))
            lines = file.read().decode(errors="replace").splitlines()
        states = [each for each in lines[1:] if '"what": "state"' in each and each[-1:] == "}"]
        if not states:
            return False
        at = json.loads(states[-1])["robots"][self._robots.index(robot)]
        return is_near(self.building, self.scene, at, said)

    # --- What is found --------------------------------------------------------------------------

    def _judge(self, happenings: SiteHappenings | None) -> None:
        outcome = self._outcome
        if happenings is not None:
            self._asked = happenings.asked
            outcome.counts += Counter(
                {f"happened: {what}": n for what, n in happenings.counts.items()}
            )
        outcome.counts += Counter({f"people: {k}": n for k, n in self._people.manners.items()})
        complaints = self._service.complaints
        if "Traceback" in complaints:
            at = complaints.index("Traceback")
            outcome.findings.append(f"a traceback: {complaints[max(0, at - 300) : at + 3000]}")
        ledger = self.ledger(self.truth)
        outcome.counts += ledger.counts()
        outcome.findings += ledger.faults()
        outcome.findings += self._wrong_plans()

    def ledger(self, truth: Path) -> OrdealLedger:
        """Who judges what the journal says by what really was."""
        setting = Setting(self.building, self.scene, self._robots, CAPACITY, self._asked)
        return OrdealLedger(self._service.journal, Truth(truth), setting, self._witness)

    def _wrong_plans(self) -> list[str]:
        """Plans that the journal had, and that do not pass the checker."""
        places = self.building.graph.places
        setting = FleetSetting(
            robots=tuple(
                ServiceRobot(name=each, start=places[0].name, capacity=CAPACITY)
                for each in self._robots
            ),
            transfer_places=self._transfers,
            policy=Policy(kept=KEPT),
        )
        wrong = []
        for number, text in self._plans.items():
            kept = FleetRecord.model_validate_json(text).dispatcher
            try:
                Dispatcher.restored(self.building, setting, kept).fleet.plan()
            except MendError as error:
                wrong.append(f"plan {number} does not pass the checker: {error}")
            except Exception as error:
                wrong.append(f"plan {number} does not pass the checker: {error!r}")
        self._outcome.counts["plan checked"] = len(self._plans)
        return wrong


async def _told(client: MendClient, site: UUID) -> str:
    """What is open, and what robots are at."""
    views = [e for e in await client.requests(site) if e.status not in OVER]
    fleet = await client.fleet(site)
    robots = [(e.robot, e.works, e.connected, e.at_work, e.run) for e in fleet.robots]
    dialogues = [(e.issue, e.awaiting) for e in await client.dialogues("open")]
    return f"{[(e.name, e.status, e.reason) for e in views]}; {robots}; {dialogues}"[:1500]
