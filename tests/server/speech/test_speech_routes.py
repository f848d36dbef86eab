"""The sound of prompts and phrases over REST, and what the service says that it can do."""

import asyncio
from collections.abc import AsyncIterator
from uuid import uuid4

import httpx
import pytest
from scripted_ears import ScriptedEars, ToneVoice
from service_under_test import ServiceUnderTest, build

from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView
from mend.server.speech.abilities import SpeechAbilities
from mend.server.speech.phrases import FIXED
from mend.server.speech.rendering import SpokenTexts, render_prompts


@pytest.fixture
def voice() -> ToneVoice:
    return ToneVoice()


@pytest.fixture
async def service(voice: ToneVoice) -> AsyncIterator[ServiceUnderTest]:
    service = build(SpeechAbilities(SpokenTexts(voice), ScriptedEars()))
    yield service
    service.journal.close()


@pytest.fixture
async def client(service: ServiceUnderTest) -> AsyncIterator[httpx.AsyncClient]:
    async with service.client() as client:
        yield client


@pytest.fixture
async def question(service: ServiceUnderTest) -> DialogueView:
    run = await service.runs.start_run(RunRequest(tree="eket", world="tabletop", speed="max"))
    return await service.runs.raise_issue(run.id)


def address(view: DialogueView) -> str:
    assert view.prompt is not None
    return f"/api/dialogues/{view.dialogue}/prompts/{view.prompt.prompt}/speech"


async def test_it_says_what_it_can_do(client: httpx.AsyncClient) -> None:
    told = (await client.get("/api/speech")).json()
    assert told["language"] == "en"
    assert told["voice"] == {"available": True, "engine": "tone", "why_not": None}
    assert told["recognition"]["available"]
    assert "yes please" in told["commands"]["yes"]
    assert told["phrases"] == dict(FIXED)


async def test_a_service_without_speech_says_why_not() -> None:
    service = build()
    async with service.client() as client:
        told = (await client.get("/api/speech")).json()
        assert not told["voice"]["available"]
        assert told["voice"]["why_not"]
        assert not told["recognition"]["available"]
        refused = await client.get("/api/speech/phrases/sorry")
    assert refused.status_code == 409
    assert "no voice" in refused.json()["detail"]
    service.journal.close()


async def test_a_prompt_and_its_help_can_be_heard(
    client: httpx.AsyncClient, question: DialogueView, voice: ToneVoice
) -> None:
    for path in (address(question), address(question) + "/help"):
        response = await client.get(path)
        assert response.status_code == 200
        assert response.headers["content-type"] == "audio/wav"
        assert response.content.startswith(b"RIFF")
    assert question.prompt is not None
    assert voice.rendered[0] == question.prompt.text
    assert "If you say yes: The robot tries again." in voice.rendered[1]


async def test_what_an_answer_will_do_can_be_heard(
    client: httpx.AsyncClient, question: DialogueView, voice: ToneVoice
) -> None:
    assert (await client.get(address(question) + "/no")).status_code == 200
    assert voice.rendered == ["No. You put the pink bar to its place."]
    assert (await client.get(address(question) + "/maybe")).status_code == 422


async def test_an_old_prompt_can_still_be_heard(
    service: ServiceUnderTest, client: httpx.AsyncClient, question: DialogueView
) -> None:
    assert question.prompt is not None
    newer = question.prompt.model_copy(update={"prompt": uuid4()})
    service.runs._change(question.dialogue, prompt=newer)
    assert (await client.get(address(question))).status_code == 200


@pytest.mark.parametrize("name", FIXED)
async def test_fixed_phrases_can_be_heard(client: httpx.AsyncClient, name: str) -> None:
    assert (await client.get(f"/api/speech/phrases/{name}")).status_code == 200


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/api/speech/phrases/unheard_of", 404),
        ("/api/speech/phrases/Say%20this", 422),
        (f"/api/dialogues/{uuid4()}/prompts/{uuid4()}/speech", 404),
        ("/api/dialogues/x/prompts/y/speech", 422),
    ],
)
async def test_what_is_not_there_is_a_problem(
    client: httpx.AsyncClient, path: str, status: int
) -> None:
    response = await client.get(path)
    assert response.status_code == status
    assert response.headers["content-type"] == "application/problem+json"


async def test_another_prompt_of_the_same_dialogue_is_not_there(
    client: httpx.AsyncClient, question: DialogueView
) -> None:
    path = f"/api/dialogues/{question.dialogue}/prompts/{uuid4()}/speech"
    assert (await client.get(path)).status_code == 404


async def test_a_voice_that_fails_is_a_problem(
    client: httpx.AsyncClient, question: DialogueView, voice: ToneVoice
) -> None:
    voice.broken = True
    response = await client.get(address(question))
    assert response.status_code == 409
    assert response.json()["detail"] == "tone failed"


async def test_a_prompt_is_rendered_when_it_is_published(
    service: ServiceUnderTest, voice: ToneVoice
) -> None:
    texts = service.app.state.services.speech.texts
    rendering = asyncio.create_task(render_prompts(texts, service.journal))
    run = await service.runs.start_run(RunRequest(tree="eket", world="tabletop", speed="max"))
    async with asyncio.timeout(60):
        await voice.has_rendered(len(FIXED))
        view = await service.runs.raise_issue(run.id)
        await voice.has_rendered(len(FIXED) + 2)
    assert view.prompt is not None
    assert voice.rendered[len(FIXED)] == view.prompt.text
    rendering.cancel()
    await asyncio.gather(rendering, return_exceptions=True)
