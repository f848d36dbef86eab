"""Who may use a service, for the client of an admin."""

from typing import Literal
from urllib.parse import quote

from mend.server.access.views import CodeView, DeedsPage, PrincipalView, TokenView
from mend.server.client_wire import Wire


class AccessCalls(Wire):
    """Reads and changes principals. For admins."""

    async def principals(self) -> list[PrincipalView]:
        return await self._get("/api/access/principals", list[PrincipalView])

    async def add_principal(
        self,
        name: str,
        role: Literal["viewer", "helper", "operator", "admin"],
        *,
        expires_days: float | None = None,
    ) -> TokenView:
        """Add a principal and get its token, which is shown only now."""
        body = {"name": name, "role": role, "expires_days": expires_days}
        return await self._post("/api/access/principals", TokenView, body)

    async def rotate_principal(self, name: str, *, expires_days: float | None = None) -> TokenView:
        """Give a principal a new token; the old one and its sessions end."""
        path = f"/api/access/principals/{quote(name, safe='')}/rotate"
        return await self._post(path, TokenView, {"expires_days": expires_days})

    async def revoke_principal(self, name: str) -> None:
        """End a principal: its token, its sessions and its connections."""
        await self._request("DELETE", f"/api/access/principals/{quote(name, safe='')}")

    async def open_enrolment(self, robot: str, *, minutes: float = 15) -> CodeView:
        """Make a code with which a robot fetches its own credential, once."""
        body = {"robot": robot, "minutes": minutes}
        return await self._post("/api/access/enrolments", CodeView, body)

    async def deeds(self, after: int = 0, limit: int = 100, who: str | None = None) -> DeedsPage:
        """Who did what, when, and from where."""
        path = "/api/access/deeds"
        return await self._get(path, DeedsPage, after=after, limit=limit, who=who)
