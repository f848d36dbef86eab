"""The worlds and scenes that runs may name, over REST."""

from fastapi import APIRouter

from server.api.parts import Limit, Offset, SceneName, WithParts
from server.api.problems import documented
from server.runtime.views import View, WorldView
from tasks.scene import Scene

router = APIRouter(prefix="/api", tags=["worlds"])


class SceneSummary(View):
    """One line about a scene: how many objects and places it has."""

    name: str
    objects: int
    places: int


@router.get("/worlds", operation_id="list_worlds", responses=documented(401, 421, 422))
async def list_worlds(parts: WithParts, limit: Limit = 1000, offset: Offset = 0) -> list[WorldView]:
    """The worlds that a run may be in, and why one cannot run here."""
    return parts.worlds.worlds()[offset : offset + limit]


@router.get("/scenes", operation_id="list_scenes", responses=documented(401, 421, 422))
async def list_scenes(
    parts: WithParts, limit: Limit = 1000, offset: Offset = 0
) -> list[SceneSummary]:
    """The scenes that task trees may name."""
    scenes = (parts.scenes.scene(name) for name in parts.scenes.names()[offset : offset + limit])
    return [
        SceneSummary(name=each.name, objects=len(each.objects), places=len(each.places))
        for each in scenes
    ]


@router.get("/scenes/{name}", operation_id="get_scene", responses=documented(401, 404, 421, 422))
async def get_scene(name: SceneName, parts: WithParts) -> Scene:
    """One scene: its table, objects and places."""
    return parts.scenes.scene(name)
