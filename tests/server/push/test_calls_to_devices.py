"""Who is called about what, when again, and when no more."""

import time
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any, Literal
from uuid import UUID, uuid4

import pytest

from mend.errors import NotFoundError
from mend.server.access.access import Access
from mend.server.access.principal import ANYBODY, Caller
from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.push.calling import Calling
from mend.server.push.messages import CallMessage
from mend.server.push.outbox import Letter
from mend.server.push.subscription import DeviceKeys, PushSubscription
from mend.server.push.subscriptions import Device, PushSubscriptions
from mend.server.runtime.views import DialogueView, PromptView, RunStatus, RunSummary
from mend.tasks.resolution import Resolution

NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)
RUN, DIALOGUE, PROMPT = uuid4(), uuid4(), uuid4()
OF: dict[str, Any] = {
    "time": 3.0, "wall_time": NOW, "run": RUN, "node": "/0", "name": "bar", "dialogue": DIALOGUE,
    "robot": "pr2", "issue": "dropped", "object": "bar",
}  # fmt: skip


@dataclass
class Bench:
    """A dialogue as it is now, and what was put for which device since it was last asked for."""

    calling: Calling
    dialogues: dict[UUID, DialogueView]
    put: list[tuple[str, Any]] = field(default_factory=list)
    live: bool = True
    lost: bool = False

    def is_now(self, **changes: Any) -> None:
        self.dialogues[DIALOGUE] = self.dialogues[DIALOGUE].model_copy(update=changes)

    async def take(self, event: ev.Event) -> list[tuple[str, str, str]]:
        """What each device is told then: its kind, and the text."""
        self.put.clear()
        await self.calling.take(event)
        told = [(device, each.type, getattr(each, "text", "")) for device, each in self.put]
        return sorted(told)

    async def ask(self, to: str | None = None, **changes: Any) -> list[tuple[str, str, str]]:
        self.is_now(awaiting="answer", prompt=prompt(to), **changes)
        return await self.take(
            ev.Prompt(**OF, prompt=PROMPT, version=1, kind="ask", text="May I?", to=to)
        )


def prompt(to: str | None, kind: Literal["ask", "say"] = "ask") -> PromptView:
    return PromptView(
        prompt=PROMPT, version=1, kind=kind, text="May I?" if kind == "ask" else "I place it.",
        answers=[], deadline=33.0, to=to, within_s=30.0,
    )  # fmt: skip


@pytest.fixture
async def bench() -> AsyncIterator[Bench]:
    journal = SqliteJournal(":memory:")
    access = Access(None, wall_time_s=time.time)
    subscriptions = PushSubscriptions(journal, access, "key", Limits(), lambda: NOW)
    for helper, device in [("anna", "phone"), ("anna", "watch"), ("ben", "tablet")]:
        keys = DeviceKeys(p256dh="point", auth="secret")
        added = Device(f"https://push.example.org/{device}", keys, device)
        await subscriptions.add(added, helper, Caller(ANYBODY))
    view = DialogueView(
        dialogue=DIALOGUE, run=RUN, status="open", reason=None, issue="dropped", object="bar",
        robot="pr2", node="/0", name="bar", prompt=None, awaiting=None, answered_by=None,
        claimed_by=None, claimed_until=None, picture=None,
    )  # fmt: skip
    dialogues = {DIALOGUE: view}

    class Found:
        async def page(self, *_: object) -> list[DialogueView]:
            return list(dialogues.values())

        async def view(self, dialogue: UUID) -> DialogueView:
            if dialogue not in dialogues:
                raise NotFoundError("there is no such dialogue")
            return dialogues[dialogue]

    class Runs:
        async def run_summary(self, run: UUID) -> RunSummary:
            if run != RUN:
                raise NotFoundError("there is no such run")
            return RunSummary(
                id=run, tree="eket", world="tabletop", scenario=None, seed=1, speed=1.0,
                status=RunStatus.RUNNING, time=3.0, started=NOW, robots=["pr2"], result=None,
                live=bench.live,
            )  # fmt: skip

        def lost_robots(self) -> list[tuple[UUID, str]]:
            return [(RUN, "pr2")] if bench.lost else []

    class Letters:
        def put(self, device: PushSubscription, letter: Letter) -> None:
            bench.put.append((device.device, letter.message))

    calling = Calling(journal, Found(), Runs(), subscriptions, Letters(), lambda: 100.0)
    bench = Bench(calling, dialogues)
    yield bench
    journal.close()


ASKED = ("call", "May I?")


async def test_everybody_is_called_where_no_helper_is_named(bench: Bench) -> None:
    assert await bench.ask() == [("phone", *ASKED), ("tablet", *ASKED), ("watch", *ASKED)]


async def test_the_helper_whose_turn_it_is_is_called_on_all_their_devices(bench: Bench) -> None:
    assert await bench.ask("anna") == [("phone", *ASKED), ("watch", *ASKED)]
    assert await bench.ask("anna") == [("phone", *ASKED), ("watch", *ASKED)]


async def test_an_escalation_moves_the_call(bench: Bench) -> None:
    await bench.ask("anna")
    moved = ("withdrawn", "ben is asked now.")
    assert await bench.ask("ben") == [("phone", *moved), ("tablet", *ASKED), ("watch", *moved)]


async def test_nobody_is_called_where_a_script_answers(bench: Bench) -> None:
    assert await bench.ask(scripted=True) == []
    answered = ev.Answered(**OF, prompt=PROMPT, version=1, answer="yes", helper="script")
    assert await bench.take(answered) == []


async def test_an_answer_calls_all_of_them_off(bench: Bench) -> None:
    await bench.ask()
    answered = ev.Answered(**OF, prompt=PROMPT, version=1, answer="yes", helper="ben")
    over = ("withdrawn", "ben answered yes.")
    assert await bench.take(answered) == [("phone", *over), ("tablet", *over), ("watch", *over)]
    assert await bench.take(ev.DialogueClosed(**OF, reason="resolved")) == []


async def test_a_question_that_is_withdrawn_calls_off(bench: Bench) -> None:
    await bench.ask("ben")
    closed = ev.DialogueClosed(**OF, reason="withdrawn")
    assert await bench.take(closed) == [("tablet", "withdrawn", "It is no longer needed.")]


async def test_whoever_is_on_it_calls_off_and_whoever_lets_go_calls_again(bench: Bench) -> None:
    await bench.ask("ben")
    bench.is_now(claimed_by="anna")
    claimed = ev.Claimed(**OF, helper="anna", lease_until=NOW)
    assert await bench.take(claimed) == [("tablet", "withdrawn", "anna is on it.")]
    assert await bench.ask("ben") == [], "repeated while somebody is on it"
    bench.is_now(claimed_by=None)
    assert await bench.take(ev.Released(**OF, helper="anna")) == [("tablet", *ASKED)]


async def test_a_robot_that_does_not_wait_calls_urgently(bench: Bench) -> None:
    await bench.ask("ben", interrupts=False)
    [(_, message)] = bench.put
    assert isinstance(message, CallMessage)
    assert message.urgent


async def test_who_said_that_they_help_is_called_to_hold_it_until_it_is_done(bench: Bench) -> None:
    await bench.ask()
    await bench.take(ev.Answered(**OF, prompt=PROMPT, version=1, answer="yes", helper="ben"))
    bench.is_now(awaiting=None, answered_by="ben", prompt=prompt(None, "say"))
    resolved = ev.Resolved(**OF, resolution=Resolution.COLLAB_FINISH, helped=True)
    assert await bench.take(resolved) == [("tablet", "call", "I place it.")]
    assert bench.put[0][1].urgent
    assert await bench.take(ev.DialogueClosed(**OF, reason="resolved")) == []
    done = ev.NodeDone(
        time=9.0, wall_time=NOW, run=RUN, node="/0", name="bar", robot="pr2", by="both"
    )
    assert await bench.take(done) == [("tablet", "withdrawn", "It is done.")]
    assert await bench.take(done) == []


async def test_calls_from_before_a_restart_are_called_off_after_it(bench: Bench) -> None:
    bench.is_now(awaiting="answer", prompt=prompt("ben"))
    await bench.calling.recover()
    answered = ev.Answered(**OF, prompt=PROMPT, version=1, answer="no", helper="anna")
    assert await bench.take(answered) == [("tablet", "withdrawn", "anna answered no.")]


async def test_a_dialogue_that_cannot_be_found_calls_nobody(bench: Bench) -> None:
    bench.dialogues.clear()
    asked = ev.Prompt(**OF, prompt=PROMPT, version=1, kind="ask", text="May I?")
    assert await bench.take(asked) == []


def lost(run: UUID = RUN) -> ev.RobotLost:
    return ev.RobotLost(time=4.0, wall_time=NOW, run=run, robot="pr2", reason="it is silent")


async def test_a_lost_robot_calls_everybody_until_it_is_back(bench: Bench) -> None:
    called = [(device, "robot_lost", "") for device in ("phone", "tablet", "watch")]
    assert await bench.take(lost()) == called
    assert await bench.take(lost()) == [], "they know"
    back = ev.RobotBack(time=5.0, wall_time=NOW, run=RUN, robot="pr2", boot="b", continues=False)
    over = ("withdrawn", "It is there again.")
    assert await bench.take(back) == [("phone", *over), ("tablet", *over), ("watch", *over)]
    assert await bench.take(back) == []


async def test_a_call_about_a_lost_robot_is_called_off_after_a_restart(bench: Bench) -> None:
    await bench.take(lost())
    [about] = {each.dialogue for _, each in bench.put}
    bench.lost = True
    # The service begins anew, and knows nothing but what was journaled.
    calling = bench.calling
    bench.calling = Calling(
        calling._journal,
        calling._dialogues,
        calling._runs,
        calling._subscriptions,
        calling._letters,
        lambda: 100.0,
    )
    await bench.calling.recover()
    assert await bench.take(lost()) == [], "they know"
    back = ev.RobotBack(time=5.0, wall_time=NOW, run=RUN, robot="pr2", boot="b", continues=False)
    over = ("withdrawn", "It is there again.")
    assert await bench.take(back) == [("phone", *over), ("tablet", *over), ("watch", *over)]
    assert {each.dialogue for _, each in bench.put} == {about}


async def test_a_lost_robot_calls_no_longer_than_its_run_goes_on(bench: Bench) -> None:
    await bench.take(lost())
    ended = ev.RunFailed(time=9.0, wall_time=NOW, run=RUN, reason="no robot is left")
    over = ("withdrawn", "Its run is over.")
    assert await bench.take(ended) == [("phone", *over), ("tablet", *over), ("watch", *over)]


async def test_a_lost_robot_of_a_scripts_run_or_of_none_calls_nobody(bench: Bench) -> None:
    assert await bench.take(lost(uuid4())) == []
    bench.live = False
    assert await bench.take(lost()) == []
