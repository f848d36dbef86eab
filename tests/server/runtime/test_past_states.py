"""A past state that many ask for at once is folded once."""

import asyncio

import pytest
from pretend_service import pretend_service
from task_documents import definition_of

from server.runtime.history import History

TREE = definition_of(
    {"then": [{"behavior": "pick_and_place", "object": name} for name in ("red", "blue")]}
)


async def test_helpers_who_come_back_at_once_share_one_past(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folded: list[int | None] = []
    fold = History.at

    async def counted(self: History, *args: object) -> object:
        folded.append(args[1])
        return await fold(self, *args)

    monkeypatch.setattr(History, "at", counted)
    async with pretend_service(TREE) as service:
        _, events = await service.run_to_end()
        seq = events[-2].seq
        snapshots = await asyncio.gather(*(service.runtime.snapshot(seq) for _ in range(20)))
        later = await service.runtime.snapshot(seq)
    assert folded == [seq]
    assert len(snapshots[0].runs) == 1
    assert snapshots == [later] * 20


async def test_one_who_goes_away_takes_it_from_nobody() -> None:
    async with pretend_service(TREE) as service:
        _, events = await service.run_to_end()
        first, second = (
            asyncio.create_task(service.runtime.snapshot(events[-2].seq)) for _ in range(2)
        )
        while not service.runtime._past._kept:  # noqa: ASYNC110
            await asyncio.sleep(0)
        first.cancel()
        assert len((await second).runs) == 1
