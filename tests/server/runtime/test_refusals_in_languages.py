"""What helpers are refused while they answer is in every language that the console speaks."""

import asyncio
from collections.abc import AsyncIterator, Awaitable
from importlib.metadata import entry_points
from uuid import uuid4

import pytest
from answer_races import ONE_PART
from languages_of_console import LANGUAGES, untold
from pretend_service import PretendService, pretend_service
from test_helping import FAULT, open_question, prompt_in
from test_words_on_help import events_of, of_type, promised

from mend.dialogue.script import CloseReason
from mend.errors import RefusalError
from mend.server.access.roles import Role
from mend.server.api.helper_connection import NO_LONGER_SIGNED_IN
from mend.server.api.problems import forbidden
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_dialogues import RunDialogues
from mend.server.runtime.views import DialogueView


async def refusal(asked: Awaitable[object]) -> str:
    with pytest.raises(RefusalError) as refused:
        await asked
    return str(refused.value)


@pytest.fixture
async def service() -> AsyncIterator[PretendService]:
    async with pretend_service(ONE_PART, FAULT, patient=True) as service:
        yield service


async def of_an_open_question(dialogues: RunDialogues, view: DialogueView) -> list[str]:
    dialogue, prompt = view.dialogue, prompt_in(view).prompt
    await dialogues.claim(dialogue, "ann")
    told = [
        await refusal(dialogues.answer(dialogue, uuid4(), "yes", "ben")),
        await refusal(dialogues.answer(uuid4(), prompt, "yes", "ben")),
        await refusal(dialogues.choose(dialogue, prompt, "juggle", "ben")),
        await refusal(dialogues.choose_for_all("no", [uuid4()], "ben")),
        await refusal(dialogues.claim(dialogue, "ben")),
        await refusal(dialogues.release(dialogue, "ben")),
        await refusal(dialogues.said_done(dialogue, "ben")),
        await refusal(dialogues.take_back(dialogue, "ben")),
    ]
    for _ in range(10):
        await dialogues.extend(dialogue, prompt, "ann")
    return [*told, await refusal(dialogues.extend(dialogue, prompt, "ann"))]


async def test_refusals_while_a_question_is_open(service: PretendService) -> None:
    view = await open_question(service)
    assert untold(await of_an_open_question(service.runtime.dialogues, view)) == []


async def test_refusals_while_promised_help_is_awaited(service: PretendService) -> None:
    view, dialogues = await promised(service), service.runtime.dialogues
    (asked,) = of_type(await events_of(service), ev.Answered)
    told = [
        await refusal(dialogues.answer(view.dialogue, asked.prompt, "no", "ben")),
        await refusal(dialogues.extend(view.dialogue, asked.prompt, "ben")),
        await refusal(dialogues.take_back(view.dialogue, "ben")),
    ]
    # Both at once: before the robot has looked.
    words = [dialogues.said_done(view.dialogue, helper) for helper in ("ann", "ben")]
    _, refused = await asyncio.gather(*words, return_exceptions=True)
    assert isinstance(refused, RefusalError)
    told.append(str(refused))
    assert untold(told) == []


async def test_refusals_of_what_is_over_or_is_a_scripts(service: PretendService) -> None:
    view, dialogues = await open_question(service), service.runtime.dialogues
    dialogue, prompt = view.dialogue, prompt_in(view).prompt
    while (now := await dialogues.view(dialogue)).status == "open":
        await dialogues.answer(dialogue, prompt_in(now).prompt, "no", "ann")
    told = [
        await refusal(dialogues.answer(dialogue, prompt, "no", "ben")),
        await refusal(dialogues.claim(dialogue, "ben")),
        await refusal(dialogues.said_done(dialogue, "ben")),
    ]
    if not (await service.runtime.run(view.run)).status.ended:
        await service.runtime.abort(view.run)
    await service.runtime.wait_for_end(view.run)
    told.append(await refusal(dialogues.claim(dialogue, "ben")))
    assert untold(told) == []


async def test_refusals_of_a_scripts_questions(service: PretendService) -> None:
    request = {"tree": "tree", "world": "tabletop", "answers": ["silence"] * 9}
    await service.runtime.start_run(RunRequest.model_validate(request))
    view = await open_question(service)
    assert untold([await refusal(service.runtime.dialogues.claim(view.dialogue, "ben"))]) == []


@pytest.mark.parametrize("reason", CloseReason)
def test_every_way_in_which_a_dialogue_closes(reason: CloseReason) -> None:
    assert untold([f"this dialogue is closed ({reason})"]) == []


@pytest.mark.parametrize("role", [Role.VIEWER, Role.OPERATOR])
def test_who_may_not(role: Role) -> None:
    assert untold([forbidden(Role.HELPER, role).detail, NO_LONGER_SIGNED_IN]) == []


def test_every_kind_of_issue_has_a_name() -> None:
    kinds = entry_points(group="mend.dialogues").names
    assert untold([each.replace("_", " ") for each in kinds]) == []


def test_what_nobody_has_put_into_a_language_is_found() -> None:
    assert untold(["the moon is made of cheese"]) == ["the moon is made of cheese"] * len(LANGUAGES)
