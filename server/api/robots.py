"""Robots over REST."""

from fastapi import APIRouter

from server.api.parts import Limit, Offset, WithParts
from server.api.problems import documented
from server.runtime.views import RobotView

router = APIRouter(prefix="/api/robots", tags=["robots"])


@router.get("", operation_id="list_robots", responses=documented(401, 421, 422))
async def list_robots(parts: WithParts, limit: Limit = 1000, offset: Offset = 0) -> list[RobotView]:
    """Every robot that is connected or known, with its state."""
    return parts.runs.robots()[offset : offset + limit]
