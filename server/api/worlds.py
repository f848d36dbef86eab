"""The worlds that runs may name, over REST."""

from fastapi import APIRouter

from mend.server.api.problems import documented
from mend.server.api.services import Limit, Offset, WithServices
from mend.server.runtime.views import WorldView

router = APIRouter(prefix="/api", tags=["worlds"])


@router.get("/worlds", operation_id="list_worlds", responses=documented(401, 421, 422))
async def list_worlds(
    services: WithServices, limit: Limit = 1000, offset: Offset = 0
) -> list[WorldView]:
    """The worlds that a run may be in, and why one cannot run here."""
    return services.worlds.worlds()[offset : offset + limit]
