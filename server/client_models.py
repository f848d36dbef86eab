"""What robots are drawn from, for the client of a service."""

from urllib.parse import quote

from mend.server.client_wire import Wire
from mend.server.models.views import ModelView


class ModelCalls(Wire):
    """Reads, keeps and deletes the models of robots."""

    async def models(self) -> list[ModelView]:
        return await self._get("/api/models", list[ModelView])

    async def model(self, name: str) -> bytes:
        """An uploaded model as a ZIP, as `put_model` takes it."""
        return (await self._request("GET", _at(name))).content

    async def put_model(self, name: str, archive: bytes) -> ModelView:
        """Keep a ZIP with `robot.urdf` and its meshes; replaces an uploaded one of the name."""
        return await self._put_model(name, archive, "application/zip")

    async def put_urdf(self, name: str, description: bytes) -> ModelView:
        """Keep a URDF that needs no other files; replaces an uploaded model of the name."""
        return await self._put_model(name, description, "application/xml")

    async def _put_model(self, name: str, sent: bytes, media_type: str) -> ModelView:
        kind = {"Content-Type": media_type}
        kept = await self._request("PUT", _at(name), content=sent, headers=kind)
        return ModelView.model_validate_json(kept.content)

    async def delete_model(self, name: str) -> None:
        await self._request("DELETE", _at(name))


def _at(name: str) -> str:
    return f"/api/models/{quote(name, safe='')}"
