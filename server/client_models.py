"""What robots are drawn from, for the client of a service."""

from urllib.parse import quote

from mend.server.client_wire import Wire
from mend.server.models.views import ModelView


class ModelCalls(Wire):
    """Reads, keeps and deletes the models of robots."""

    async def models(self) -> list[ModelView]:
        return await self._get("/api/models", list[ModelView])

    async def put_model(self, name: str, archive: bytes) -> ModelView:
        """Keep a ZIP with `robot.urdf` and its meshes; replaces an uploaded one of the name."""
        kind = {"Content-Type": "application/zip"}
        kept = await self._request("PUT", _at(name), content=archive, headers=kind)
        return ModelView.model_validate_json(kept.content)

    async def delete_model(self, name: str) -> None:
        await self._request("DELETE", _at(name))


def _at(name: str) -> str:
    return f"/api/models/{quote(name, safe='')}"
