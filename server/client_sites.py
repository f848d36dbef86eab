"""The sites of a service, for its client, and what people ask of their robots."""

from typing import TYPE_CHECKING
from urllib.parse import quote
from uuid import UUID

from mend.server.client_wire import Wire
from mend.server.fleets.asking import AskedRobotView, UnderstoodView, WordsAsked
from mend.server.fleets.operator_requests import WayReport
from mend.server.fleets.views import FleetView, RequestView
from mend.server.sites.requests import SiteRequest
from mend.server.sites.views import SiteView

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import AnyRequest


class SiteCalls(Wire):
    """Opens sites, and makes requests there."""

    async def open_site(self, request: SiteRequest) -> SiteView:
        """Start a simulated world that stays, with its robots, for runs to come."""
        return await self._post("/api/sites", SiteView, request.model_dump(mode="json"))

    async def sites(self) -> list[SiteView]:
        return await self._get("/api/sites", list[SiteView])

    async def site(self, site: UUID) -> SiteView:
        return await self._get(f"/api/sites/{site}", SiteView)

    async def close_site(self, site: UUID) -> None:
        """Stop a site's world for good; no run may be using it."""
        await self._request("DELETE", f"/api/sites/{site}")

    async def make_request(self, request: "AnyRequest", site: UUID | None = None) -> RequestView:
        """Ask robots of a building for something; `site` says whose, where several take requests.

        Refused with status 409 is what they cannot do in time.
        """
        path = _at_site("/api/requests", site)
        return await self._post(path, RequestView, request.model_dump(mode="json"))

    async def requests(self, site: UUID | None = None) -> list[RequestView]:
        return await self._get(_at_site("/api/requests", site), list[RequestView])

    async def request(self, name: str, site: UUID | None = None) -> RequestView:
        return await self._get(_at_site(f"/api/requests/{name}", site), RequestView)

    async def change_request(
        self, name: str, request: "AnyRequest", site: UUID | None = None
    ) -> RequestView:
        """Ask for something else instead; refused, or once a robot has set out, all stays.

        One occurrence of what recurs keeps its time where `request` was given none.
        """
        path = _at_site(f"/api/requests/{name}", site)
        given = request.model_dump(mode="json", exclude_unset=True)
        sent = await self._request("PUT", path, json={"kind": request.kind, **given})
        return RequestView.model_validate_json(sent.content)

    async def understand_request(
        self, asked: WordsAsked, site: UUID | None = None
    ) -> UnderstoodView:
        """What somebody asks for in words, as a request to be made once they have confirmed it."""
        path = _at_site("/api/requests/understand", site)
        return await self._post(path, UnderstoodView, asked.model_dump(mode="json"))

    async def asked_robot(self, site: UUID, robot: str) -> AskedRobotView:
        """Where a robot of a fleet is, and what it may be asked for."""
        return await self._get(
            f"/api/sites/{site}/fleet/robots/{quote(robot)}/asking", AskedRobotView
        )

    async def cancel_request(self, name: str, site: UUID | None = None) -> None:
        """Want it no more; what is fetched goes back to where it came from."""
        await self._request("DELETE", _at_site(f"/api/requests/{name}", site))

    async def fleet(self, site: UUID) -> FleetView:
        """What the robots of a site are still to do, and why."""
        return await self._get(f"/api/sites/{site}/fleet", FleetView)

    async def take_robot_out(self, site: UUID, robot: str, reason: str) -> None:
        """Have a robot of a fleet do nothing more for now; others fetch what it has."""
        path = f"/api/sites/{site}/fleet/robots/{quote(robot)}/out_of_service"
        await self._request("POST", path, json={"reason": reason})

    async def put_robot_back(self, site: UUID, robot: str) -> None:
        """Have it work again, from where it stands."""
        await self._request(
            "POST", f"/api/sites/{site}/fleet/robots/{quote(robot)}/back_in_service"
        )

    async def send_robot(self, site: UUID, robot: str, place: str) -> None:
        """Have a robot that carries out no leg go to a place, as `FLOOR/PLACE`."""
        path = f"/api/sites/{site}/fleet/robots/{quote(robot)}/go"
        await self._request("POST", path, json={"place": place})

    async def tell_of_way(self, site: UUID, way: WayReport) -> None:
        """Say that a way is blocked, a door closed, or open again."""
        path = f"/api/sites/{site}/fleet/ways"
        await self._request("POST", path, json=way.model_dump(mode="json"))


def _at_site(path: str, site: UUID | None) -> str:
    return path if site is None else f"{path}?site={site}"
