"""A service with a bench of two boxes, whose runs tests steer."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from uuid import UUID

from awaited_events import when
from broken_constraints import broken_constraints
from two_boxes import BENCH, BOTH
from untruths import kinds_of

from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.journal.sqlite import IN_MEMORY
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.steering_views import SetAutonomy, SteerNode
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings
from mend.tasks.autonomy import AutonomyLevel

IN_ORDER = BOTH.replace("name: both", "name: in_order").replace("and:", "then:")


@asynccontextmanager
async def bench(journal: Path = Path(IN_MEMORY), **settings: object) -> AsyncIterator[Service]:
    values = {"port": 0, "log_level": "error", "speech_voice": "none", "journal": journal}
    async with open_service(Settings.model_validate({**values, **settings})) as service:
        if "both" not in await service.journal.documents("tree"):
            await service.library.scenes.save("small_bench", BENCH)
            await service.library.trees.save("both", BOTH)
            await service.library.trees.save("in_order", IN_ORDER)
        yield service


async def begin(service: Service, tree: str = "both", autonomy: str = "off") -> UUID:
    """A run that begins nothing by itself before the test has said how it is steered."""
    request = RunRequest(
        tree=tree,
        world="tabletop",
        speed="max",
        seed=2,
        answers="none",
        autonomy=AutonomyLevel(autonomy),
    )
    return (await service.runtime.start_run(request)).id


async def steer(service: Service, run: UUID, act: str, node: str, reason: str = "") -> None:
    wish = SteerNode.model_validate({"act": act, "node": node, "reason": reason})
    await service.runtime.steer(run, wish, "ann")


async def set_autonomy(service: Service, run: UUID, level: str) -> None:
    wish = SetAutonomy.model_validate({"act": "set_autonomy", "level": level})
    await service.runtime.steer(run, wish, "ann")


async def waits_before(service: Service, node: str) -> ev.LeafHeld:
    held = await when(service, lambda each: isinstance(each, ev.LeafHeld) and each.node == node)
    assert isinstance(held, ev.LeafHeld)
    return held


async def to_the_end(service: Service, run: UUID) -> Sequence[ev.Event]:
    view = await asyncio.wait_for(service.runtime.wait_for_end(run), 60.0)
    assert view.status is RunStatus.FINISHED, view.result
    events = await service.journal.read(0, 100_000, run)
    begun = events[0]
    assert isinstance(begun, ev.RunStarted)
    assert broken_constraints(events, kinds_of(begun)) == []
    return events


def started(events: Sequence[ev.Event]) -> list[str]:
    return [each.node for each in events if isinstance(each, ev.NodeStarted)]
