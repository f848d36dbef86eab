"""A request under an idempotency key is done once, and answered alike however often it comes."""

import asyncio
import sqlite3
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import closing
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from uuid import UUID, uuid4

import httpx
import pytest
from people import People
from service_under_test import ServiceUnderTest, build

from mend.server.access.roles import Role
from mend.server.api.repeats import Repeats
from mend.server.app import described_app
from mend.server.journal import events as ev
from mend.server.journal.journal import Document, Entry, JournalWriteError
from mend.server.journal.keyed_request import FirstAnswer, KeyedAuthor, KeyedRequest
from mend.server.journal.pruning import Keep
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.runtime.requests import RunRequest

RUN: dict[str, Any] = {"tree": "eket", "world": "tabletop", "speed": "max", "seed": 7}
STEAL = {"act": "steal", "object": "pink_bar"}
TREE = {"name": "mine", "text": "then: []"}
ONE = '"one"'
REPLAYED = "idempotency-replayed"


@dataclass
class Served:
    service: ServiceUnderTest
    client: httpx.AsyncClient

    async def post(
        self, path: str, body: Any = None, key: str = ONE, **headers: str
    ) -> httpx.Response:
        sent = {"Idempotency-Key": key, **headers}
        return await self.client.post(path, json=body, headers=sent)

    async def count(self, kind: type[ev.Event]) -> int:
        found = await self.service.journal.read(0, 1000)
        return sum(isinstance(each, kind) for each in found)

    async def run(self) -> UUID:
        return (await self.service.runs.start_run(RunRequest.model_validate(RUN))).id


@pytest.fixture
async def served() -> AsyncIterator[Served]:
    service = build()
    async with service.client() as client:
        yield Served(service, client)
    service.journal.close()


@dataclass(frozen=True)
class Asked:
    """A request, and the event that comes of it."""

    path: str
    body: Any
    event: type[ev.Event]


Ask = Callable[[Served], Awaitable[Asked]]


async def start(_: Served) -> Asked:
    return Asked("/api/runs", RUN, ev.RunStarted)


async def upload(_: Served) -> Asked:
    return Asked("/api/trees", TREE, ev.DocumentKept)


async def resume(served: Served) -> Asked:
    run = await served.run()
    await served.service.runs.pause(run)
    return Asked(f"/api/runs/{run}/resume", None, ev.RunResumed)


def of_run(what: str, event: type[ev.Event], body: Any = None) -> Ask:
    async def asked(served: Served) -> Asked:
        return Asked(f"/api/runs/{await served.run()}/{what}", body, event)

    return asked


def of_dialogue(what: str, event: type[ev.Event], **more: Any) -> Ask:
    async def asked(served: Served) -> Asked:
        view = await served.service.runs.raise_issue(await served.run())
        assert view.prompt is not None
        if what == "release":
            await served.service.runs.dialogues.claim(view.dialogue, "anna")
        if what in ("done", "take_back"):
            await served.service.runs.await_help(view.dialogue, "anna")
        body = {"helper": "anna", **more}
        if what in ("answers", "extend"):
            body["prompt"] = str(view.prompt.prompt)
        return Asked(f"/api/dialogues/{view.dialogue}/{what}", body, event)

    return asked


ASKED: dict[str, Ask] = {
    "start": start,
    "pause": of_run("pause", ev.RunPaused),
    "resume": resume,
    "abort": of_run("abort", ev.RunAborted),
    "intervene": of_run("interventions", ev.InterventionAccepted, STEAL),
    "answer": of_dialogue("answers", ev.Answered, answer="yes"),
    "claim": of_dialogue("claim", ev.Claimed),
    "release": of_dialogue("release", ev.Released),
    "extend": of_dialogue("extend", ev.DeadlineExtended),
    "done": of_dialogue("done", ev.HelpReported),
    "take back": of_dialogue("take_back", ev.PromiseTakenBack),
    "upload": upload,
}
EVERY = pytest.mark.parametrize("ask", ASKED.values(), ids=ASKED)


@EVERY
async def test_a_request_that_comes_again_does_nothing_and_is_answered_alike(
    served: Served, ask: Ask
) -> None:
    asked = await ask(served)
    first = await served.post(asked.path, asked.body)
    assert first.is_success, first.text
    assert REPLAYED not in first.headers
    count = await served.count(asked.event)
    again = await served.post(asked.path, asked.body)
    assert (again.status_code, again.content) == (first.status_code, first.content)
    assert again.headers.get("location") == first.headers.get("location")
    assert again.headers["content-type"] == first.headers["content-type"]
    assert again.headers[REPLAYED] == "true"
    assert await served.count(asked.event) == count
    more = "" if "?" in asked.path else "?once=more"
    other = await served.post(asked.path + more, asked.body)
    assert other.status_code == 422
    assert "another request came under this Idempotency-Key" in other.json()["detail"]


@EVERY
async def test_an_answer_that_was_lost_is_made_of_what_came_of_the_request(
    served: Served, ask: Ask, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def killed(*_: Any, **__: Any) -> None: ...

    asked = await ask(served)
    monkeypatch.setattr(Repeats, "keep", killed)
    first = await served.post(asked.path, asked.body)
    count = await served.count(asked.event)
    again = await served.post(asked.path, asked.body)
    assert again.headers[REPLAYED] == "true"
    assert again.status_code == first.status_code
    assert again.headers.get("location") == first.headers.get("location")
    apart = ("seq",)
    said, said_again = (
        {name: value for name, value in each.json().items() if name not in apart}
        for each in (first, again)
    )
    assert said_again == said
    assert await served.count(asked.event) == count


def test_every_post_says_that_it_takes_a_key() -> None:
    schema = described_app().openapi()
    for path, methods in schema["paths"].items():
        for method, operation in methods.items():
            named = [each["name"] for each in operation.get("parameters", [])]
            assert ("Idempotency-Key" in named) == (method == "post"), path
            if method == "post":
                assert {"400", "409", "422"} <= operation["responses"].keys(), path


async def test_a_request_that_is_under_way_is_not_done_once_more(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, go_on = asyncio.Event(), asyncio.Event()
    start_run = served.service.runs.start_run

    async def slow(*arguments: Any) -> Any:
        begun.set()
        await go_on.wait()
        return await start_run(*arguments)

    monkeypatch.setattr(served.service.runs, "start_run", slow)
    first = asyncio.create_task(served.post("/api/runs", RUN))
    await begun.wait()
    second = await served.post("/api/runs", RUN)
    assert (second.status_code, second.headers["retry-after"]) == (409, "1")
    assert "still under way" in second.json()["detail"]
    other = await served.post("/api/runs", {**RUN, "seed": 8})
    assert other.status_code == 422
    go_on.set()
    assert (await first).status_code == 201
    assert (await served.post("/api/runs", RUN)).content == (await first).content
    assert await served.count(ev.RunStarted) == 1


@pytest.mark.parametrize(
    "key", ["", '"', '""', "a b", '"\t"', '"a" "b"', '"' + "x" * 256 + '"', "x" * 256, '"\\x"', "é"]
)
async def test_what_is_no_key_is_refused_and_nothing_is_done(served: Served, key: str) -> None:
    request = served.client.build_request("POST", "/api/runs", json=RUN)
    request.headers.raw.append((b"Idempotency-Key", key.encode("latin-1")))
    raw = [*request.headers.raw, (b"Idempotency-Key", key.encode("latin-1"))]
    request.headers = httpx.Headers(raw)
    answer = await served.client.send(request)
    assert answer.status_code == 400
    assert "Idempotency-Key" in answer.json()["detail"]
    assert await served.count(ev.RunStarted) == 0


async def test_a_key_is_the_same_with_and_without_quotation_marks(served: Served) -> None:
    first = await served.post("/api/runs", RUN, key="8e03978e-40d5-43e8")
    again = await served.post("/api/runs", RUN, key='"8e03978e-40d5-43e8"')
    assert again.json()["id"] == first.json()["id"]


async def test_what_was_refused_leaves_its_key_free(served: Served) -> None:
    unknown = await served.post("/api/runs", {**RUN, "tree": "unknown"})
    assert unknown.status_code == 404
    assert (await served.post("/api/runs", RUN)).status_code == 201


async def test_every_principal_has_keys_of_their_own(tmp_path: Path) -> None:
    people = People(tmp_path)
    service = build(principals=people.file)
    async with service.client() as client:
        served = Served(service, client)
        runs = [
            (await served.post("/api/runs", RUN, **people.headers(role))).json()["id"]
            for role in (Role.OPERATOR, Role.ADMIN, Role.OPERATOR)
        ]
    service.journal.close()
    assert runs[0] == runs[2]
    assert runs[0] != runs[1]


async def test_a_later_principal_of_the_same_name_has_keys_of_their_own(tmp_path: Path) -> None:
    people = People(tmp_path)
    service = build(principals=people.file)
    async with service.client() as client:
        served = Served(service, client)
        first = await served.post("/api/runs", RUN, **people.headers(Role.OPERATOR))
        people.revoke(Role.OPERATOR)
        token = people.editor.add("olga", Role.OPERATOR, datetime.now(UTC))
        second = await served.post("/api/runs", RUN, Authorization=f"Bearer {token}")
    service.journal.close()
    assert (first.status_code, second.status_code) == (201, 201)
    assert REPLAYED not in second.headers
    assert first.json()["id"] != second.json()["id"]


@pytest.mark.parametrize(
    ("address", "replayed"), [("2001:db8::ffff:7", True), ("2001:db8:0:1::1", False)]
)
async def test_at_an_open_door_an_ipv6_network_has_keys_of_its_own(
    address: str, replayed: bool, tmp_path: Path
) -> None:
    people = People(tmp_path)
    service = build(principals=people.file)
    code = people.editor.open_enrolment("arm-9", datetime.now(UTC), minutes=15)
    answers = []
    for came_from in ("2001:db8::1", address):
        transport = httpx.ASGITransport(service.app, client=(came_from, 1))
        async with httpx.AsyncClient(transport=transport, base_url=service.url) as client:
            body = {"robot": "arm-9", "code": code}
            answers.append(await Served(service, client).post("/api/robots/enrol", body))
    service.journal.close()
    first, second = answers
    assert first.status_code == 201
    # The code is good for one robot, once.
    assert (second.content == first.content) is (second.status_code == 201) is replayed


async def test_an_answer_with_a_secret_is_given_again_and_not_in_the_journal(
    tmp_path: Path,
) -> None:
    people = People(tmp_path)
    service = build(principals=people.file)
    admin = people.headers(Role.ADMIN)
    body = {"name": "nina", "role": "viewer"}
    async with service.client() as client:
        served = Served(service, client)
        first = await served.post("/api/access/principals", body, **admin)
        again = await served.post("/api/access/principals", body, **admin)
        signed = [
            await served.post("/api/session", {"token": people.tokens[Role.HELPER]})
            for _ in range(2)
        ]
    await service.deeds.written()
    # As after a restart: what was in memory is gone.
    service.app.state.services.repeats._remembered.clear()
    async with service.client() as client:
        lost = await Served(service, client).post("/api/access/principals", body, **admin)
    rows = service.journal._write_connection.execute("SELECT body FROM requests").fetchall()
    service.journal.close()
    assert (first.status_code, again.content) == (201, first.content)
    assert signed[0].headers["set-cookie"] == signed[1].headers["set-cookie"]
    assert rows == [(None,)]
    assert lost.status_code == 409
    assert "was done before, and its answer is not known any more" in lost.json()["detail"]


# --- In the journal -----------------------------------------------------------------------------


def kept(key: str, at: datetime, run: UUID = ev.NO_RUN) -> Entry:
    request = KeyedRequest("anna", key, b"digest")
    author = KeyedAuthor(principal="anna", role=Role.OPERATOR, request=request)
    event = ev.DocumentKept(
        wall_time=at, kind="tree", name=key[:9], replaced=False, author=author, run=run
    )
    return Entry(events=[event], document=Document("tree", key[:9], "then: []"))


NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)


async def test_a_key_what_came_of_it_and_its_file_are_kept_together_or_not_at_all(
    tmp_path: Path,
) -> None:
    journal = SqliteJournal(tmp_path / "journal.db")
    journal._write_connection.execute("ALTER TABLE requests RENAME TO elsewhere")
    with pytest.raises((sqlite3.Error, JournalWriteError)):
        await journal.append(kept("one", NOW))
    assert await journal.read(0, 10) == []
    assert await journal.documents("tree") == {}
    journal._write_connection.execute("ALTER TABLE elsewhere RENAME TO requests")
    await journal.append(kept("one", NOW))
    journal.close()
    again = SqliteJournal(tmp_path / "journal.db")
    found = await again.find_request("anna", "one", 0.0)
    assert found is not None
    assert (found.digest, found.seq, found.answer) == (b"digest", 1, None)
    assert await again.documents("tree") == {"one": "then: []"}
    (event,) = await again.read(0, 10)
    assert "digest" not in event.model_dump_json()
    again.close()


async def test_the_answer_is_the_same_after_a_restart(tmp_path: Path) -> None:
    request = KeyedRequest("anna", "one", b"digest")
    answer = FirstAnswer(201, [("location", "/api/trees/one")], b"{}")
    journal = SqliteJournal(tmp_path / "journal.db")
    await journal.append(kept("one", NOW))
    await journal.keep_answer(request, answer, 10, 0.0)
    journal.close()
    again = SqliteJournal(tmp_path / "journal.db")
    found = await again.find_request("anna", "one", 0.0)
    again.close()
    assert found is not None
    assert found.answer == answer


async def test_the_oldest_keys_of_a_principal_and_the_old_of_all_are_forgotten() -> None:
    journal = SqliteJournal(":memory:")
    times = [NOW + timedelta(seconds=number) for number in range(5)]
    for number, time in enumerate(times):
        await journal.append(kept(str(number), time))
    request = KeyedRequest("anna", "4", b"digest")
    since = times[1].timestamp()
    gone = await journal.keep_answer(request, None, 3, since)
    left = [await journal.find_request("anna", str(number), 0.0) for number in range(5)]
    journal.close()
    assert gone == 1
    assert [each is not None for each in left] == [False, False, True, True, True]


async def test_a_key_that_is_too_old_is_as_new() -> None:
    now_s = datetime.now(UTC).timestamp()
    service = build(limits=Limits(idempotency_s=60.0))
    service.app.state.services.repeats._wall_time_s = lambda: now_s
    async with service.client() as client:
        served = Served(service, client)
        first = await served.post("/api/runs", RUN)
        now_s += 59
        again = await served.post("/api/runs", RUN)
        now_s += 61
        late = await served.post("/api/runs", RUN)
    service.journal.close()
    assert again.json()["id"] == first.json()["id"]
    assert late.json()["id"] != first.json()["id"]


async def test_keys_beyond_the_limit_are_forgotten_and_counted() -> None:
    service = build(limits=Limits(idempotency_keys=2))
    async with service.client() as client:
        served = Served(service, client)
        runs = [(await served.post("/api/runs", RUN, key=key)).json()["id"] for key in "abcca"]
    counted = service.refusals.counts["idempotency_keys"]
    service.journal.close()
    assert runs[2] == runs[3]
    assert runs[0] != runs[4]
    assert counted == 2


async def test_the_keys_of_a_run_go_with_it() -> None:
    journal = SqliteJournal(":memory:")
    run = uuid4()
    stamp: dict[str, Any] = {"time": 0.0, "wall_time": NOW, "run": run}
    request = KeyedRequest("anna", "one", b"digest")
    author = KeyedAuthor(principal="anna", role=Role.OPERATOR, request=request)
    started = ev.RunStarted(
        **stamp, tree_name="eket", tree={}, scene={}, world="tabletop", robots=[], seed=1,
        speed="max", scenario=None, options={}, author=author,
    )  # fmt: skip
    await journal.append(Entry(events=[started, ev.RunAborted(**stamp)]))
    assert await journal.find_request("anna", "one", 0.0) is not None
    await journal.prune(Keep(ended_within=timedelta()), NOW + timedelta(days=1))
    assert await journal.find_request("anna", "one", 0.0) is None
    journal.close()


async def test_a_journal_that_cannot_keep_the_answer_does_not_undo_what_was_done(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def refuse(*_: Any) -> int:
        raise JournalWriteError("the journal could not be written: the disk is full")

    monkeypatch.setattr(served.service.journal, "keep_answer", refuse)
    first = await served.post("/api/runs", RUN)
    assert first.status_code == 201
    assert (await served.post("/api/runs", RUN)).json()["id"] == first.json()["id"]


def test_an_older_journal_gets_room_for_keys(tmp_path: Path) -> None:
    sample = Path(__file__).parent / "journals" / "v3.sql"
    with closing(sqlite3.connect(tmp_path / "journal.db")) as connection:
        connection.executescript(sample.read_text())
    SqliteJournal(tmp_path / "journal.db").close()
    with closing(sqlite3.connect(tmp_path / "journal.db")) as connection:
        assert connection.execute("SELECT count(*) FROM requests").fetchone() == (0,)
