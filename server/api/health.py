"""Whether the service lives, and whether it can work."""

from typing import Literal

from fastapi import APIRouter
from pydantic import BaseModel

from mend.server.access.roles import Role
from mend.server.api.problems import ProblemError, documented
from mend.server.api.services import ObservedJournal, WithCallerIfKnown, WithServices
from mend.server.journal.journal import JournalReadError, JournalWriteError

router = APIRouter(tags=["health"])


class Health(BaseModel):
    """`status` is always `ok`: anything else is a problem document."""

    status: Literal["ok"] = "ok"


class Readiness(BaseModel):
    """`degraded`: it works, but some of what was kept is damaged, in so many `damaged` places.

    `unreadable_runs` says how many runs cannot be read, `unreadable_events` how many events that
    belong to no run. `damage` has a sentence for each damaged place, for whoever may view.
    """

    status: Literal["ok", "degraded"]
    unreadable_runs: int
    unreadable_events: int
    damaged: int
    damage: list[str] | None


@router.get("/healthz", operation_id="healthz", responses=documented(421))
async def healthz() -> Health:
    """The process answers."""
    return Health()


@router.get("/readyz", operation_id="readyz", responses=documented(421, 503))
async def readyz(services: WithServices, caller: WithCallerIfKnown) -> Readiness:
    """The journal can be read and written, so runs can be started and watched.

    Strangers hear whether that is so; why it is not is told to whoever may view.
    """
    told = caller is not None and caller.principal.role.may(Role.VIEWER)
    try:
        await _look(services.journal)
        unreadable = await services.journal.index.count_unreadable()
    except (JournalReadError, JournalWriteError) as error:
        why = str(error) if told else "the journal cannot be read or written"
        raise ProblemError(503, why) from error
    events, damage = len(services.deeds.unreadable), services.journal.damage
    return Readiness(
        status="degraded" if unreadable or events or damage else "ok",
        unreadable_runs=unreadable,
        unreadable_events=events,
        damaged=len(damage),
        damage=[each.sentence for each in damage] if told else None,
    )


async def _look(journal: ObservedJournal) -> None:
    """Raises `JournalReadError` or `JournalWriteError` where it cannot be read or written."""
    await journal.look()
    if journal.trouble.reason is not None:
        raise JournalWriteError(journal.trouble.reason)
    await journal.read_records(journal.head, 1)
