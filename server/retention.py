"""How long ended runs are kept, and pruning what is not, again and again."""

import asyncio
import logging
from collections.abc import Awaitable, Callable
from datetime import datetime, timedelta
from typing import Annotated
from uuid import UUID

from pydantic import BaseModel, ConfigDict, Field

from mend.server.background import Endless
from mend.server.journal.journal import JournalClosedError, JournalWriteError
from mend.server.journal.pruning import Keep, Pruned

log = logging.getLogger(__name__)

EVERY_S = 600.0

ForgetPoses = Callable[[UUID], None]
PruneJournal = Callable[[Keep, datetime, ForgetPoses], Awaitable[Pruned]]


class KeepSettings(BaseModel):
    """What is kept of ended runs; None keeps all. Runs that go on are always kept."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    days: Annotated[float, Field(gt=0, le=36_500, allow_inf_nan=False)] | None = None
    """Runs that ended within so many days."""
    runs: Annotated[int, Field(ge=1, le=2**31 - 1)] | None = None
    """So many of those that ended last."""
    pictures_mb: Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False)] | None = None
    """So many megabytes of pictures, the newest."""

    def keep(self) -> Keep:
        return Keep(
            ended_within=None if self.days is None else timedelta(days=self.days),
            ended_runs=self.runs,
            picture_bytes=None if self.pictures_mb is None else int(self.pictures_mb * 1e6),
        )


async def prune_regularly(
    prune: PruneJournal,
    forget_poses: ForgetPoses,
    keep: Keep,
    utc_now: Callable[[], datetime],
    sleep: Callable[[float], Awaitable[None]] = asyncio.sleep,
) -> None:
    """Prune at once and every ten minutes, whatever fails, until the journal is closed."""
    pruning = Endless("pruning")
    while not keep.all:
        with pruning.one_pass():
            try:
                pruned = await prune(keep, utc_now(), forget_poses)
            except JournalWriteError as error:
                log.warning("what is not kept was not pruned: %s", error)
            except JournalClosedError:
                return
            else:
                if pruned.runs or pruned.pictures:
                    log.info("pruned %d runs, %d events and %d pictures", len(pruned.runs),
                             pruned.events, pruned.pictures)  # fmt: skip
        await sleep(EVERY_S)
