"""Whether the service lives, and whether it can work."""

from typing import Literal

from fastapi import APIRouter
from pydantic import BaseModel

from server.api.parts import WithParts
from server.api.problems import documented
from server.journal.journal import JournalWriteError

router = APIRouter(tags=["health"])


class Health(BaseModel):
    """`status` is always `ok`: anything else is a problem document."""

    status: Literal["ok"] = "ok"


class Readiness(BaseModel):
    """`degraded`: it works, but some of what was kept is damaged; `damage` has a sentence for each.

    `unreadable_runs` says how many runs cannot be read, `unreadable_events` how many events that
    belong to no run.
    """

    status: Literal["ok", "degraded"]
    unreadable_runs: int
    unreadable_events: int
    damage: list[str]


@router.get("/healthz", operation_id="healthz", responses=documented(421))
async def healthz() -> Health:
    """The process answers."""
    return Health()


@router.get("/readyz", operation_id="readyz", responses=documented(421, 503))
async def readyz(parts: WithParts) -> Readiness:
    """The journal can be read and written, so runs can be started and watched."""
    await parts.journal.look()
    if parts.journal.trouble.reason is not None:
        raise JournalWriteError(parts.journal.trouble.reason)
    await parts.journal.read_records(parts.journal.head, 1)
    unreadable = await parts.journal.index.count_unreadable()
    events = len(parts.deeds.unreadable)
    damage = [each.sentence for each in parts.journal.damage]
    return Readiness(
        status="degraded" if unreadable or events or damage else "ok",
        unreadable_runs=unreadable,
        unreadable_events=events,
        damage=damage,
    )
