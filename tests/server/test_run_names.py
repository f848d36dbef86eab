"""Runs are found by what people call them, and never another one than they mean."""

from collections.abc import Iterable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, cast
from uuid import UUID

import pytest

from mend.server.cli.failures import CommandLineError
from mend.server.cli.run_names import find_run
from mend.server.client import MendClient
from mend.server.runtime.views import RunStatus

BED, CAFE = UUID("bed00000-0000-4000-8000-000000000000"), UUID(int=0xCAFE << 112)


def run(name: UUID, tree: str, status: RunStatus = RunStatus.RUNNING) -> Any:
    return SimpleNamespace(id=name, tree=tree, status=status)


@dataclass
class Listing:
    """A service with these runs, which lists so many of them at a time."""

    all: list[Any]

    async def runs(self, *, status: Iterable[RunStatus] = (), limit: int = 100) -> list[Any]:
        wanted = set(status) or set(RunStatus)
        return [each for each in self.all if each.status in wanted][:limit]


async def found(runs: list[Any], said: str | None) -> UUID:
    return (await find_run(cast(MendClient, Listing(runs)), said)).id


async def test_a_run_is_found_however_many_have_ended_since() -> None:
    ended = [run(UUID(int=each), "eket", RunStatus.FINISHED) for each in range(200)]
    assert await found([*ended, run(BED, "eket")], None) == BED
    assert await found([*ended, run(BED, "eket", RunStatus.PAUSED)], "eket") == BED


async def test_a_run_that_nobody_can_read_is_not_meant() -> None:
    torn = run(CAFE, "eket", RunStatus.UNREADABLE)
    assert await found([torn, run(BED, "eket")], None) == BED
    with pytest.raises(CommandLineError, match="no run goes on"):
        await found([torn], None)


async def test_a_tree_that_is_called_as_an_id_begins_is_told_from_it() -> None:
    runs = [run(BED, "table"), run(CAFE, "bed")]
    with pytest.raises(CommandLineError, match="may be any of the runs"):
        await found(runs, "bed")
    assert await found(runs, "BED0") == BED
    assert await found(runs, "cafe") == CAFE
    assert await found(runs, str(BED)) == BED
