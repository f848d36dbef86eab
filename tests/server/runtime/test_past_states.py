"""A past state that many ask for at once is folded once."""

import asyncio
from collections.abc import Callable
from uuid import UUID, uuid4

import pytest
from pretend_service import pretend_service
from task_documents import definition_of

from mend.errors import UnreadableError
from mend.server.runtime.history import History
from mend.server.runtime.past_states import KEPT_S, PastStates
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_state import RunState

TREE = definition_of(
    {"then": [{"behavior": "pick_and_place", "object": name} for name in ("red", "blue")]}
)


REQUEST = RunRequest(tree="tree", world="tabletop", speed="max")


@pytest.fixture
def folded(monkeypatch: pytest.MonkeyPatch) -> list[int | None]:
    """The event up to which a run is folded, each time that one is."""
    until: list[int | None] = []
    fold = History.at

    async def at(self: History, *args: object) -> object:
        until.append(args[1])
        return await fold(self, *args)

    monkeypatch.setattr(History, "at", at)
    return until


async def test_helpers_who_come_back_at_once_share_one_past(folded: list[int | None]) -> None:
    async with pretend_service(TREE) as service:
        _, events = await service.run_to_end()
        seq = events[-2].seq
        snapshots = await asyncio.gather(*(service.runtime.snapshot(seq) for _ in range(20)))
        later = await service.runtime.snapshot(seq)
    assert folded == [seq]
    assert len(snapshots[0].runs) == 1
    assert snapshots == [later] * 20


async def test_helpers_who_come_back_to_many_runs_share_the_past_of_all(
    folded: list[int | None],
) -> None:
    async with pretend_service(TREE, deaf=True) as service:
        runs = [(await service.runtime.start_run(REQUEST)).id for _ in range(12)]
        seq = service.journal.head
        for run in runs:
            await service.runtime.pause(run)
        snapshots = [await service.runtime.snapshot(seq) for _ in range(3)]
    assert folded == [seq] * 12
    assert [each.id for each in snapshots[0].runs] == runs
    assert snapshots == [snapshots[0]] * 3


async def test_an_old_run_that_many_ask_for_at_once_is_folded_once(
    folded: list[int | None],
) -> None:
    async with pretend_service(TREE) as service:
        view, _ = await service.run_to_end()
        service.runtime._states._history._kept.clear()
        views = await asyncio.gather(*(service.runtime.run(view.id) for _ in range(20)))
    assert folded == [None]
    assert views == [view] * 20


class CountedHistory(History):
    """A history of runs that had not begun, or cannot be read."""

    def __init__(self, *, readable: bool = True) -> None:
        self.asked = 0
        self._readable = readable

    async def at(self, run: UUID, until: int | None, now: RunState | None = None) -> None:  # noqa: ARG002
        self.asked += 1
        if not self._readable:
            raise UnreadableError("it cannot be read")


async def test_a_past_is_forgotten_after_a_minute() -> None:
    history, due = CountedHistory(), list[tuple[float, Callable[[], None]]]()
    past = PastStates(history, lambda *what: due.append(what))
    run = uuid4()
    for _ in range(2):
        await past.at(run, 7, None)
        await past.at(run, 7, None)
        (wait_s, forget) = due.pop()
        assert wait_s == KEPT_S
        assert not due
        forget()
    assert history.asked == 2
    assert not past._moments


async def test_a_past_that_could_not_be_read_is_read_again() -> None:
    history = CountedHistory(readable=False)
    past = PastStates(history)
    run = uuid4()
    for _ in range(2):
        with pytest.raises(UnreadableError):
            await past.at(run, 7, None)
    assert history.asked == 2


async def test_one_who_goes_away_takes_it_from_nobody() -> None:
    async with pretend_service(TREE) as service:
        _, events = await service.run_to_end()
        first, second = (
            asyncio.create_task(service.runtime.snapshot(events[-2].seq)) for _ in range(2)
        )
        while not service.runtime._states._past._moments:  # noqa: ASYNC110
            await asyncio.sleep(0)
        first.cancel()
        assert len((await second).runs) == 1
