"""Questions that a run's script answers: people are not asked, and cannot answer."""

from uuid import UUID

import pytest
from pretend_service import PretendService, pretend_service
from task_documents import definition_of

from mend.errors import ConflictError
from mend.server.journal import events as ev

PICK = {"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"}
TREE = definition_of({"then": [PICK]})
FAULTS = {"part_1": [("missed", 4)]}


async def asked(service: PretendService, **request: object) -> tuple[UUID, UUID]:
    """The dialogue and the prompt of a run that has ended."""
    _, events = await service.run_to_end(**request)
    [ask] = [each for each in events if isinstance(each, ev.Prompt) and each.kind == "ask"][:1]
    [opened] = [each for each in events if isinstance(each, ev.DialogueOpened)][:1]
    assert opened.scripted
    return ask.dialogue, ask.prompt


async def test_nobody_else_may_answer_them() -> None:
    async with pretend_service(TREE, FAULTS) as service:
        dialogue, prompt = await asked(service, answers=["yes", "yes"])
        dialogues = service.runtime.dialogues
        assert (await dialogues.view(dialogue)).scripted
        with pytest.raises(ConflictError, match="the script of this run answers its questions"):
            await dialogues.answer(dialogue, prompt, "yes", "ann")
        with pytest.raises(ConflictError, match="people are not asked"):
            await dialogues.extend(dialogue, prompt, "ann")
        with pytest.raises(ConflictError, match="people are not asked"):
            await dialogues.claim(dialogue, "ann")


@pytest.mark.parametrize(
    ("answers", "live"), [(None, True), ("live", True), ("none", False), (["yes"], False)]
)
async def test_a_run_says_whether_people_answer(answers: object, live: bool) -> None:
    async with pretend_service(TREE, {}) as service:
        view, _ = await service.run_to_end(answers=answers)
        assert view.live is live
