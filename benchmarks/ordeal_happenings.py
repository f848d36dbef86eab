"""What happens to the fleet of a service, drawn: second thoughts, failures, closed ways, thefts."""

from collections import Counter
from collections.abc import Awaitable, Callable, Sequence
from random import Random
from typing import Any
from uuid import UUID

import httpx
from dispatch_happenings import MIX, THINGS, DispatchHappenings

from mend.fleet.requests import RequestStatus, request_of
from mend.maps.building.building import Building, PlaceKind
from mend.server.client import MendClient
from mend.server.client_errors import RefusedError, UnreachableError
from mend.server.fleets.item_names import item_of
from mend.server.fleets.operator_requests import WayReport
from mend.server.fleets.views import FleetView, RequestView
from mend.tasks.intervention import Act, Intervention

OVER = frozenset({"done", "refused", "cancelled", "failed"})
MOST_BARRED = 2
SOON_S = 120.0
"""Nobody asks for anything that begins later."""
WHAT = "a parcel"


class NothingToDoError(Exception):
    """There is nothing just now to which that could happen."""


class SiteHappenings:
    """Draws what happens at a site and does it, as clients of its service do.

    `asked`: what became of asking for each request: `booked`, `refused`, or `unknown` where the
    service was killed meanwhile; `counts`: what has happened how often.
    """

    def __init__(
        self,
        client: MendClient,
        url: str,
        site: UUID,
        building: Building,
        seed: int,
        busy: int,
    ) -> None:
        """`url`: where the client's service is; `busy`: so many requests are open at most."""
        self._url = f"{url}/api/requests?site={site}"
        self._client, self._site, self._chance, self._busy = client, site, Random(seed), busy
        mix = THINGS if seed % 2 else MIX
        self._drawn = DispatchHappenings(building, Random(seed + 1), mix=mix)
        self._rooms = building.of_kind(PlaceKind.ROOM)
        self._lanes = [
            tuple(f"{each.floor}/{end}" for end in each.lane.between) for each in building.crossings
        ]
        self._elevators = list(building.document.elevators)
        self.barred: list[tuple[str, str]] = []
        self.asked: dict[str, str] = {}
        self.counts: Counter[str] = Counter()

    async def happen(self, fleet: FleetView) -> str:
        """Something happens; what it was."""
        draws: dict[Callable[[FleetView], Awaitable[str]], float] = {
            self._ask: 10, self._cancel: 1.5, self._change: 1, self._fail: 1, self._back: 2,
            self._bar: 1.5, self._clear: 1.5, self._tell_way: 1, self._step_in: 2,
            self._send: 0.5, self._be_rude: 0.5, self._steal: 0.5,
        }  # fmt: skip
        (draw,) = self._chance.choices(list(draws), weights=list(draws.values()))
        what = draw.__name__.strip("_").replace("_", " ")
        try:
            said = await draw(fleet)
        except NothingToDoError:
            return ""
        except RefusedError as error:
            self.counts[f"{what}: refused"] += 1
            return f"{what}: refused: {error}"
        self.counts[what] += 1
        return f"{what}: {said}"

    # --- What people ask ------------------------------------------------------------------------

    async def _ask(self, fleet: FleetView) -> str:
        if len(await self._open()) >= self._busy:
            raise NothingToDoError
        document = self._document(fleet.now_s)
        name = document["name"]
        self.asked[name] = "unknown"
        try:
            await self._client.make_request(request_of(document), self._site)
        except RefusedError:
            self.asked[name] = "refused"
            raise
        self.asked[name] = "booked"
        return str(document)

    def _document(self, now_s: float) -> dict[str, Any]:
        """As it may be asked for while somebody watches: soon, and once."""
        drawn = self._drawn.request(now_s)
        drawn.pop("recurrence", None)
        late_s = drawn["earliest_s"] - now_s - self._chance.uniform(0.0, SOON_S)
        if late_s > 0.0:
            drawn["earliest_s"] -= late_s
            if "latest_s" in drawn:
                drawn["latest_s"] -= late_s
        if drawn["kind"] == "transport":
            drawn["what"] = WHAT
        if "person" in drawn:
            drawn["person"] = f"Ann {drawn['name']}"
        return drawn

    async def _cancel(self, fleet: FleetView) -> str:  # noqa: ARG002 - all draw alike
        name: str = self._one(await self._open()).name
        await self._client.cancel_request(name, self._site)
        return name

    async def _change(self, fleet: FleetView) -> str:
        booked = [each for each in await self._open() if each.status is RequestStatus.BOOKED]
        name = self._one(booked).name
        document = {**self._document(fleet.now_s), "name": name}
        await self._client.change_request(name, request_of(document), self._site)
        return str(document)

    async def _open(self) -> list[RequestView]:
        views = await self._client.requests(self._site)
        return [each for each in views if each.status not in OVER]

    async def _be_rude(self, fleet: FleetView) -> str:  # noqa: ARG002 - all draw alike
        """What nobody may ask is refused, and changes nothing."""
        wrong: list[Any] = [
            {"kind": "go_to_room", "name": "x", "place": "nowhere"},
            {"kind": "transport", "name": "y", "origin": self._rooms[0], "load": -1},
            {"kind": "make_coffee", "name": "z"},
            [], "words", {"kind": "go_to_room", "name": "w" * 10_000, "place": self._rooms[0]},
        ]  # fmt: skip
        try:
            async with httpx.AsyncClient(timeout=10.0) as http:
                answer = await http.post(self._url, json=self._chance.choice(wrong))
        except httpx.HTTPError as error:
            raise UnreachableError(str(error)) from error
        assert 400 <= answer.status_code < 500, f"{answer.status_code} for what is wrong"
        return str(answer.status_code)

    # --- What becomes of robots -----------------------------------------------------------------

    async def _fail(self, fleet: FleetView) -> str:
        working = [each.robot for each in fleet.robots if each.out_of_service is None]
        if len(working) == 1 and self._chance.random() < 0.8:
            raise NothingToDoError
        robot: str = self._one(working)
        await self._client.take_robot_out(self._site, robot, "a wheel squeaks")
        return robot

    async def _back(self, fleet: FleetView) -> str:
        robot: str = self._one([e.robot for e in fleet.robots if e.out_of_service is not None])
        await self._client.put_robot_back(self._site, robot)
        return robot

    async def _send(self, fleet: FleetView) -> str:
        robot = self._one([each.robot for each in fleet.robots if each.at_work is None])
        place = self._chance.choice(fleet.places)
        await self._client.send_robot(self._site, robot, place)
        return f"{robot} to {place}"

    # --- What people do in the building ---------------------------------------------------------

    async def _bar(self, fleet: FleetView) -> str:
        if len(self.barred) >= MOST_BARRED:
            raise NothingToDoError
        between = self._chance.choice(self._lanes)
        await self._intervene(fleet, Intervention(act=Act.BAR, between=(between[0], between[1])))
        self.barred.append((between[0], between[1]))
        return f"{between}"

    async def _clear(self, fleet: FleetView) -> str:
        between = self._one(self.barred)
        await self._intervene(fleet, Intervention(act=Act.CLEAR, between=between))
        self.barred.remove(between)
        return f"{between}"

    async def _tell_way(self, fleet: FleetView) -> str:
        until_s = fleet.now_s + self._chance.choice((100.0, 600.0))
        if fleet.closed and self._chance.random() < 0.5:
            report = WayReport(
                finding="open", between=list(self._chance.choice(fleet.closed).between)
            )
        elif self._elevators and self._chance.random() < 0.2:
            elevator = self._chance.choice(self._elevators)
            report = WayReport(finding="elevator_dead", elevator=elevator, until_s=until_s)
        else:
            between = list(self._chance.choice(self._lanes))
            report = WayReport(finding="blocked", between=between, until_s=until_s)
        await self._client.tell_of_way(self._site, report)
        return report.model_dump_json(exclude_none=True)

    async def _step_in(self, fleet: FleetView) -> str:
        await self._intervene(fleet, Intervention(act=Act.BLOCK))
        return "the way of a robot"

    async def _steal(self, fleet: FleetView) -> str:
        """Out of a basket, where one is known to have something in it."""
        aboard = {name for each in fleet.robots for name in each.aboard}
        open_ = await self._open()
        things = [e.name for e in open_ if e.name in aboard and e.what["kind"] == "transport"]
        thing = item_of(WHAT, self._one(things))
        await self._intervene(fleet, Intervention(act=Act.STEAL, object=thing))
        return thing

    async def _intervene(self, fleet: FleetView, deed: Intervention) -> None:
        run = self._one([each.run for each in fleet.robots if each.run is not None])
        await self._client.intervene(run, deed)

    # --- In the end -----------------------------------------------------------------------------

    async def calm_down(self, fleet: FleetView) -> None:
        """Nothing more is to happen: robots work, and what is in the way is cleared away."""
        for each in fleet.robots:
            if each.out_of_service is not None:
                await self._client.put_robot_back(self._site, each.robot)
        if self.barred and any(each.run is not None for each in fleet.robots):
            await self._clear(fleet)

    def _one(self, among: Sequence[Any]) -> Any:
        if not among:
            raise NothingToDoError
        return self._chance.choice(among)
