"""What is asked about past runs and dialogues folds no run, and views no more than is asked for."""

from pathlib import Path
from typing import Any
from uuid import UUID

import pytest
from made_up_history import run_id, write_history
from pretend_service import PretendService, pretend_service
from task_documents import definition_of

from mend.errors import ConflictError, NotFoundError
from mend.server.errors import LostRaceError
from mend.server.journal import events as ev
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.history import MOST_KEPT
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_views import dialogue_view
from mend.server.runtime.views import DialogueView

RUNS = MOST_KEPT + 4
TREE = definition_of(
    {"then": [{"behavior": "pick_and_place", "object": name} for name in ("red", "blue")]}
)
FAULTS = {"red": [("dropped", 5)], "blue": [("missed", 3), ("dropped", 5)]}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "journal.db"
    write_history(path, RUNS)
    return path


async def folded_views(service: PretendService, run: UUID) -> dict[UUID, Any]:
    """The run's dialogues as a fold of all its events has them."""
    state = await service.runtime._states._history.read(run)
    return {each.id: dialogue_view(each) for each in state.dialogues.values()}


@pytest.mark.parametrize("status", [None, "closed"])
async def test_a_page_of_dialogues_folds_no_run(
    path: Path, folded: list[UUID], status: Any
) -> None:
    async with pretend_service(TREE, journal=path) as service:
        page = await service.runtime.dialogues.page(status, 1000, 0)
        one = await service.runtime.dialogues.view(page[3].dialogue)
    assert folded == []
    assert [each.run for each in page] == [run_id(number) for number in range(RUNS)]
    assert one == page[3]


async def test_a_past_dialogue_is_seen_as_a_fold_of_its_whole_run_has_it() -> None:
    async with pretend_service(TREE, FAULTS) as service:
        first, _ = await service.run_to_end(answers=["yes"] * 9)
        second, _ = await service.run_to_end(answers=["no"] * 9)
        page = await service.runtime.dialogues.page("closed", 100, 0)
        whole = await folded_views(service, first.id) | await folded_views(service, second.id)
    assert len(page) > 3
    assert {each.dialogue: each for each in page} == whole


async def test_who_comes_too_late_is_told_so_without_folding_the_run(
    path: Path, folded: list[UUID]
) -> None:
    async with pretend_service(TREE, journal=path) as service:
        runtime = service.runtime
        late = (await runtime.dialogues.page("closed", 1, 3))[0]
        assert late.prompt is not None
        with pytest.raises(LostRaceError, match="already answered by anna"):
            await runtime.dialogues.answer(late.dialogue, late.prompt.prompt, "yes", "bert")
        with pytest.raises(ConflictError, match="the run has ended"):
            await runtime.dialogues.answer(late.dialogue, ev.NO_RUN, "yes", "bert")
        with pytest.raises(ConflictError, match="the run has ended"):
            await runtime.dialogues.claim(late.dialogue, "bert")
        with pytest.raises(ConflictError, match="the run has ended"):
            await runtime.abort(late.run)
    assert folded == []


async def test_a_dialogue_that_cannot_be_read_is_left_out_and_takes_no_other_with_it(
    path: Path,
) -> None:
    async with pretend_service(TREE, journal=path) as service:
        bad = (await service.runtime.dialogues.page("closed", 1, 2))[0]
        connection = service.journal._write_connection
        connection.execute(
            "UPDATE events SET body = replace(body, '\"answer\":', '\"answered\":')"
            " WHERE type = 'answered' AND run = ?",
            (str(bad.run),),
        )
        connection.commit()
        page = await service.runtime.dialogues.page("closed", 1000, 0)
    assert [each.run for each in page] == [run_id(n) for n in range(RUNS) if n != 2]


async def test_dialogues_of_runs_that_cannot_be_read_are_not_listed(path: Path) -> None:
    async with pretend_service(TREE, journal=path) as service:
        await service.journal.mark_unreadable(run_id(2), "it is damaged")
        page = await service.runtime.dialogues.page("closed", 3, 0)
    assert [each.run for each in page] == [run_id(0), run_id(1), run_id(3)]


async def test_a_dialogue_that_there_never_was_is_not_found(path: Path) -> None:
    async with pretend_service(TREE, journal=path) as service:
        with pytest.raises(NotFoundError, match="there is no dialogue"):
            await service.runtime.dialogues.view(ev.NO_RUN)


async def test_an_ended_run_is_summed_up_without_being_folded(
    path: Path, folded: list[UUID]
) -> None:
    async with pretend_service(TREE, journal=path) as service:
        line = await service.runtime.run_summary(run_id(3))
        assert folded == []
        view = await service.runtime.run(run_id(3))
    assert line.model_dump() == view.model_dump(include=set(type(line).model_fields))


async def test_only_the_open_dialogues_of_a_page_are_viewed_and_none_to_be_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    viewed: list[UUID] = []

    def view(dialogue: DialogueState) -> DialogueView:
        viewed.append(dialogue.id)
        return dialogue_view(dialogue)

    monkeypatch.setattr("mend.server.runtime.run_dialogues.dialogue_view", view)
    slow = {"tree": "tree", "world": "tabletop", "speed": 1.0, "answers": "none"}
    async with pretend_service(TREE, FAULTS) as service:
        for _ in range(3):
            await service.runtime.start_run(RunRequest.model_validate(slow))
        with service.journal.subscribe(0) as subscription:
            async for record in subscription:
                if service.runtime.dialogues.count_open() == 3:
                    break
                assert record.seq < 1000
        assert viewed == []
        page = await service.runtime.dialogues.page("open", 1, 1)
    assert [each.dialogue for each in page] == viewed
    assert len(page) == 1
