"""The task trees, scenes and scenarios of a service, for its client."""

from mend.server.client_wire import Wire
from mend.server.documents import (
    DocumentCheck,
    DocumentSummary,
    DocumentView,
    KeptDocument,
    ScenarioSummary,
    SceneSummary,
)


class DocumentCalls(Wire):
    """Reads, checks and keeps documents."""

    async def trees(self) -> list[DocumentSummary]:
        return await self._get("/api/trees", list[DocumentSummary])

    async def tree(self, name: str) -> DocumentView:
        return await self._get(f"/api/trees/{name}", DocumentView)

    async def upload_tree(self, text: str, name: str | None = None) -> KeptDocument:
        """Keep a task file (YAML or JSON); replaces an uploaded one of the same name."""
        return await self._upload("/api/trees", text, name)

    async def check_tree(self, text: str) -> DocumentCheck:
        """Find the mistakes of a task file, and what keeps a world's robot from doing it."""
        return await self._post("/api/trees/check", DocumentCheck, {"text": text})

    async def delete_tree(self, name: str) -> None:
        await self._request("DELETE", f"/api/trees/{name}")

    async def scenes(self) -> list[SceneSummary]:
        return await self._get("/api/scenes", list[SceneSummary])

    async def scene(self, name: str) -> DocumentView:
        return await self._get(f"/api/scenes/{name}", DocumentView)

    async def upload_scene(self, text: str, name: str | None = None) -> KeptDocument:
        """Keep a scene file (YAML or JSON); replaces an uploaded one of the same name."""
        return await self._upload("/api/scenes", text, name)

    async def check_scene(self, text: str) -> DocumentCheck:
        """Find the mistakes of a scene file, and what keeps a world's robot from doing it."""
        return await self._post("/api/scenes/check", DocumentCheck, {"text": text})

    async def delete_scene(self, name: str) -> None:
        await self._request("DELETE", f"/api/scenes/{name}")

    async def scenarios(self) -> list[ScenarioSummary]:
        return await self._get("/api/scenarios", list[ScenarioSummary])

    async def scenario(self, name: str) -> DocumentView:
        return await self._get(f"/api/scenarios/{name}", DocumentView)

    async def upload_scenario(self, text: str, name: str | None = None) -> KeptDocument:
        """Keep a scenario file (YAML or JSON); replaces an uploaded one of the same name."""
        return await self._upload("/api/scenarios", text, name)

    async def check_scenario(self, text: str) -> DocumentCheck:
        """Find the mistakes of a scenario file, and what keeps a world's robot from doing it."""
        return await self._post("/api/scenarios/check", DocumentCheck, {"text": text})

    async def delete_scenario(self, name: str) -> None:
        await self._request("DELETE", f"/api/scenarios/{name}")

    async def _upload(self, path: str, text: str, name: str | None) -> KeptDocument:
        body = {"text": text} if name is None else {"text": text, "name": name}
        return await self._post(path, KeptDocument, body)
