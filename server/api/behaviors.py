"""The behaviors that leaves may name, over REST."""

from typing import Any

from fastapi import APIRouter

from mend.server.api.problems import documented
from mend.server.api.services import Limit, Offset
from mend.server.behaviors import behavior_parameters
from mend.server.runtime.views import View

router = APIRouter(prefix="/api", tags=["behaviors"])


class BehaviorView(View):
    """A behavior, and its parameters as a JSON Schema."""

    name: str
    parameters: dict[str, Any]


@router.get("/behaviors", operation_id="list_behaviors", responses=documented(401, 421, 422))
async def list_behaviors(limit: Limit = 1000, offset: Offset = 0) -> list[BehaviorView]:
    """The behaviors that are installed, by name."""
    models = sorted(behavior_parameters().items())
    return [
        BehaviorView(name=name, parameters=model.model_json_schema())
        for name, model in models[offset : offset + limit]
    ]
