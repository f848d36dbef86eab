"""The speech socket from outside: conversations, half duplex, refusals and admission."""

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any
from uuid import uuid4

import pytest
from scripted_ears import ScriptedEars, ToneVoice
from service_under_test import TOKEN, ServiceUnderTest, serving
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from mend.server.journal.events import WayOption
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView
from mend.server.speech.abilities import SpeechAbilities
from mend.server.speech.rendering import SpokenTexts
from mend.server.speech.vocabulary import Vocabulary
from mend.server.speech.voice import NoVoice

REQUEST = RunRequest(tree="eket", world="tabletop", speed="max")
BEGINS, ENDS = b"\1\0" * 320, b"\2\0" * 320


@pytest.fixture
def ears() -> ScriptedEars:
    return ScriptedEars()


@pytest.fixture
async def service(ears: ScriptedEars) -> AsyncIterator[ServiceUnderTest]:
    async with serving(SpeechAbilities(SpokenTexts(ToneVoice()), ears)) as service:
        yield service


@pytest.fixture
async def question(service: ServiceUnderTest) -> DialogueView:
    run = await service.runs.start_run(REQUEST)
    return await service.runs.raise_issue(run.id)


def microphone(service: ServiceUnderTest, query: str = "helper=anna", **more: Any) -> connect:
    return connect(service.url.replace("http", "ws", 1) + f"/ws/speech?{query}", **more)


async def receive(socket: ClientConnection) -> Any:
    async with asyncio.timeout(60):
        return json.loads(await socket.recv())


async def exchange(socket: ClientConnection, message: str | bytes) -> Any:
    await socket.send(message)
    return await receive(socket)


def listen(view: DialogueView) -> str:
    assert view.prompt is not None
    return json.dumps(
        {"type": "listen", "dialogue": str(view.dialogue), "prompt": str(view.prompt.prompt)}
    )


async def say_something(socket: ClientConnection) -> Any:
    """Play what is asked, speak, and return what comes after `hearing`."""
    assert await exchange(socket, '{"type": "spoken"}') == {"type": "listening"}
    assert await exchange(socket, BEGINS) == {"type": "hearing"}
    return await exchange(socket, ENDS)


async def test_a_yes_is_heard_and_ends_the_conversation(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    ears.hears.append("yes")
    assert question.prompt is not None
    async with microphone(service) as socket:
        address = f"/api/dialogues/{question.dialogue}/prompts/{question.prompt.prompt}/speech"
        assert await exchange(socket, listen(question)) == {
            "type": "say",
            "what": "question",
            "text": question.prompt.text,
            "audio": address,
        }
        heard = await say_something(socket)
        assert heard == {
            "type": "heard",
            "command": "yes",
            "phrase": "yes",
            "latency_ms": 250.0,
            "way": None,
        }
        assert await receive(socket) == {"type": "ended", "reason": "heard"}


async def test_after_two_apologies_it_gives_up(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    ears.hears.extend([None, None, None])
    async with microphone(service) as socket:
        await exchange(socket, listen(question))
        for _ in range(2):
            assert (await say_something(socket))["command"] is None
            sorry = await receive(socket)
            assert (sorry["what"], sorry["audio"]) == ("sorry", "/api/speech/phrases/sorry")
        assert (await say_something(socket))["command"] is None
        assert await receive(socket) == {"type": "gave_up"}
        assert await receive(socket) == {"type": "ended", "reason": "gave_up"}


async def test_help_says_what_yes_and_no_will_do_and_repeat_asks_again(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    ears.hears.extend(["help", "repeat"])
    async with microphone(service) as socket:
        asked = await exchange(socket, listen(question))
        assert (await say_something(socket))["command"] == "help"
        told = await receive(socket)
        assert told["what"] == "help"
        assert "If you say yes: The robot tries again." in told["text"]
        assert "If you say no: You put the pink bar to its place." in told["text"]
        assert told["audio"] == asked["audio"] + "/help"
        assert (await say_something(socket))["command"] == "repeat"
        assert await receive(socket) == asked


async def test_sound_counts_only_while_it_listens(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    ears.hears.append("no")
    async with microphone(service) as socket:
        await socket.send(BEGINS)
        await exchange(socket, listen(question))
        await socket.send(BEGINS + ENDS)
        assert (await say_something(socket))["command"] == "no"
    assert ears.opened[0].heard == BEGINS + ENDS


async def test_an_empty_frame_is_a_gap_and_no_sound(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    ears.hears.append("no")
    async with microphone(service) as socket:
        await exchange(socket, listen(question))
        await socket.send(b"")
        assert await exchange(socket, '{"type": "spoken"}') == {"type": "listening"}
        await socket.send(b"")
        assert await exchange(socket, BEGINS) == {"type": "hearing"}
        assert (await exchange(socket, ENDS))["command"] == "no"
    assert (ears.opened[0].heard, ears.opened[0].gaps) == (BEGINS + ENDS, 1)


async def test_noise_is_no_answer(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    ears.hears.extend(["", "yes"])
    async with microphone(service) as socket:
        await exchange(socket, listen(question))
        assert await say_something(socket) == {"type": "listening"}
        assert await exchange(socket, BEGINS) == {"type": "hearing"}
        assert (await exchange(socket, ENDS))["command"] == "yes"


@pytest.mark.parametrize("command", ["done", "cannot"])
async def test_whoever_promised_help_says_that_it_is_done_or_cannot_be(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView, command: str
) -> None:
    await service.runs.await_help(question.dialogue, "anna")
    ears.hears.extend([None, "help", command])
    async with microphone(service) as socket:
        said = await exchange(socket, listen(question))
        assert said["what"] == "question"
        assert (await say_something(socket))["command"] is None
        sorry = await receive(socket)
        assert (sorry["text"], sorry["audio"]) == (
            "Sorry, please say done, or I can't.",
            "/api/speech/phrases/promise_sorry",
        )
        assert (await say_something(socket))["command"] == "help"
        assert (await receive(socket))["audio"] == "/api/speech/phrases/promise_help"
        assert (await say_something(socket))["command"] == command
        assert await receive(socket) == {"type": "ended", "reason": "heard"}
    assert [each.vocabulary for each in ears.opened] == [Vocabulary.PROMISE]


WAYS = [
    WayOption(way="put_back", deed="", label="", effect="", answers=["yes"]),
    WayOption(way="place", deed="", label="", effect="", answers=["no", "yes"]),
    WayOption(way="later", deed="", label="", effect="", answers=["no", "no"]),
]


@pytest.mark.parametrize(("command", "way"), [("place", "place"), ("not_now", "later")])
async def test_a_way_of_help_is_chosen_by_the_words_for_it(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView, command: str, way: str
) -> None:
    service.runs.offer_ways(question.dialogue, WAYS)
    ears.hears.extend(["leave_out", command])
    async with microphone(service) as socket:
        await exchange(socket, listen(question))
        not_there = await say_something(socket)
        assert (not_there["command"], not_there["phrase"]) == (None, None)
        assert (await receive(socket))["what"] == "sorry"
        heard = await say_something(socket)
        assert (heard["command"], heard["way"]) == (command, way)
        assert await receive(socket) == {"type": "ended", "reason": "heard"}
    assert [each.vocabulary for each in ears.opened] == [Vocabulary.WAYS]


async def test_help_says_which_ways_can_be_chosen(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    service.runs.offer_ways(question.dialogue, WAYS)
    ears.hears.append("help")
    async with microphone(service) as socket:
        await exchange(socket, listen(question))
        await say_something(socket)
        said = await receive(socket)
        assert said["text"].endswith(
            "You can also say: I'll place it myself, not now, repeat, or stop."
        )


async def test_it_ends_when_somebody_else_answers(
    service: ServiceUnderTest, question: DialogueView
) -> None:
    assert question.prompt is not None
    async with microphone(service) as socket:
        await exchange(socket, listen(question))
        await service.runs.dialogues.answer(question.dialogue, question.prompt.prompt, "yes", "ben")
        assert await receive(socket) == {"type": "ended", "reason": "answered"}
        assert (await exchange(socket, '{"type": "spoken"}'))["status"] == 409
        assert (await exchange(socket, listen(question)))["status"] == 409


async def test_a_new_conversation_replaces_the_one_that_goes_on(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    async with microphone(service) as socket:
        await exchange(socket, listen(question))
        assert await exchange(socket, listen(question)) == {"type": "ended", "reason": "replaced"}
        assert (await receive(socket))["type"] == "say"
        assert await exchange(socket, '{"type": "cancel"}') == {
            "type": "ended",
            "reason": "cancelled",
        }
    assert all(ear.closed for ear in ears.opened)


async def test_a_recognizer_that_fails_is_said_to_be_lost(
    service: ServiceUnderTest, ears: ScriptedEars, question: DialogueView
) -> None:
    async with microphone(service) as socket:
        await exchange(socket, listen(question))
        await exchange(socket, '{"type": "spoken"}')
        ears.opened[0].lose()
        assert await receive(socket) == {"type": "ended", "reason": "lost"}


async def test_one_conversation_too_many_is_refused() -> None:
    abilities = SpeechAbilities(NoVoice("no voice here"), ScriptedEars(at_once=1))
    async with serving(abilities) as service:
        run = await service.runs.start_run(REQUEST)
        view = await service.runs.raise_issue(run.id)
        async with microphone(service) as anna, microphone(service, "helper=ben") as ben:
            assert (await exchange(anna, listen(view)))["audio"] is None
            assert await exchange(anna, '{"type": "spoken"}') == {"type": "listening"}
            refused = await exchange(ben, listen(view))
            assert (refused["type"], refused["status"]) == ("error", 503)


@pytest.mark.parametrize(
    ("message", "status"),
    [
        ("not json", 422),
        ('{"type": "sing"}', 422),
        ('{"type": "spoken", "more": 1}', 422),
        ('{"type": "spoken"}', 409),
        (json.dumps({"type": "listen", "dialogue": str(uuid4()), "prompt": str(uuid4())}), 404),
        ("x" * 5000, 413),
        (b"\0" * 17_000, 413),
        (b"\0\0\0", 422),
    ],
    ids=["no_json", "unknown", "too_much", "too_early", "no_dialogue", "long", "loud", "odd"],
)
async def test_what_cannot_be_done_gets_an_error_and_the_connection_stays(
    service: ServiceUnderTest, message: str | bytes, status: int
) -> None:
    async with microphone(service) as socket:
        error = await exchange(socket, message)
        assert (error["type"], error["status"]) == ("error", status)
        assert (await exchange(socket, '{"type": "spoken", "id": 3}'))["id"] == 3


async def test_what_is_too_long_is_counted(service: ServiceUnderTest) -> None:
    async with microphone(service) as socket:
        for message in ("x" * 5000, b"\0" * 17_000):
            await exchange(socket, message)
    counts = service.refusals.counts
    assert (counts["helper_message_chars"], counts["sound_bytes"]) == (1, 1)


async def test_a_prompt_that_is_not_the_open_one_is_refused(
    service: ServiceUnderTest, question: DialogueView
) -> None:
    message = {"type": "listen", "dialogue": str(question.dialogue), "prompt": str(uuid4())}
    async with microphone(service) as socket:
        assert (await exchange(socket, json.dumps(message)))["status"] == 409


async def test_without_recognition_it_is_refused_and_says_why() -> None:
    async with serving() as service:
        run = await service.runs.start_run(REQUEST)
        view = await service.runs.raise_issue(run.id)
        async with microphone(service) as socket:
            error = await exchange(socket, listen(view))
            assert error["status"] == 503
            assert "nothing can be recognized" in error["detail"]


async def test_the_token_is_shown_as_on_the_other_sockets() -> None:
    async with serving(token=TOKEN) as service:
        right = {"Authorization": f"Bearer {TOKEN}"}
        async with microphone(service, additional_headers=right) as socket:
            assert (await exchange(socket, '{"type": "spoken"}'))["status"] == 409
        async with microphone(service) as socket:
            await socket.send(json.dumps({"type": "auth", "token": TOKEN}))
            assert (await exchange(socket, '{"type": "spoken"}'))["status"] == 409
        async with microphone(service) as socket:
            with pytest.raises(ConnectionClosed) as closed:
                await exchange(socket, b"\0\0")
            assert closed.value.rcvd is not None
            assert closed.value.rcvd.code == 1008
        with pytest.raises(InvalidStatus):
            async with microphone(service, origin="https://evil.example"):
                pass


async def test_a_helper_needs_a_name(service: ServiceUnderTest) -> None:
    async with microphone(service, "") as socket:
        assert (await receive(socket))["status"] == 422
        with pytest.raises(ConnectionClosed):
            await receive(socket)
