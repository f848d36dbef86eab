"""A mail is tried again while it is wanted, and what became of it is in the log."""

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from types import SimpleNamespace
from typing import Any, cast
from uuid import UUID

import pytest
from sample_events import RUN, WALL_TIME, detected

from mend.server.dialogues.mail import Mailer, MailError, MailNotice, MailRequest, RefusedAddress
from mend.server.journal.events import AnswerOption, Escalated, Prompt, SuspectedFalseAlarm
from mend.server.runtime.operator_mail import WAITS_S, OperatorMail

DIALOGUE = UUID(int=2)
OPS, NIGHT = "ops@example.org", "night@example.org"
OF_DIALOGUE: dict[str, Any] = {
    "time": 10.0,
    "wall_time": WALL_TIME,
    "run": RUN,
    "dialogue": DIALOGUE,
    "robot": "robot",
    "issue": "dropped",
    "object": "green_leg",
    "node": "/0",
    "name": "green_leg",
}
ASK = Prompt(
    **OF_DIALOGUE,
    prompt=UUID(int=3),
    version=1,
    kind="ask",
    text="Shall I try again?",
    answers=[
        AnswerOption(value="yes", effect="I try."),
        AnswerOption(value="no", effect="I do not."),
    ],
    deadline=610.0,
    to=None,
)
ESCALATED = Escalated(**OF_DIALOGUE, channel="mail", to=f"{OPS}, {NIGHT}")
SUSPECTED = SuspectedFalseAlarm(
    **{name: value for name, value in OF_DIALOGUE.items() if name != "dialogue"},
    times=3,
    explanation="",
    told=[OPS],
)

Outcome = Exception | tuple[RefusedAddress, ...]


def failed(*, for_now: bool) -> MailError:
    return MailError("the mail could not be sent through mail:25: no route", for_now=for_now)


def puts_off(*addresses: str) -> tuple[RefusedAddress, ...]:
    return tuple(RefusedAddress(each, "451 greylisted", for_now=True) for each in addresses)


def refuses(*addresses: str) -> tuple[RefusedAddress, ...]:
    return tuple(RefusedAddress(each, "550 unknown", for_now=False) for each in addresses)


@dataclass
class PlayedMailer:
    """Has one outcome after the other; without one more, the mail is taken."""

    outcomes: list[Outcome] = field(default_factory=list)
    sent: list[tuple[MailRequest | MailNotice, list[str], datetime]] = field(default_factory=list)
    hangs: bool = False

    async def send(
        self, mail: MailRequest | MailNotice, to: Sequence[str], written: datetime
    ) -> tuple[RefusedAddress, ...]:
        self.sent.append((mail, list(to), written))
        if self.hangs:
            await _hang()
        outcome = self.outcomes.pop(0) if self.outcomes else ()
        if isinstance(outcome, Exception):
            raise outcome
        return outcome


async def _hang() -> None:
    """Like a server that does not even answer when it is taken leave of."""
    try:
        await asyncio.Event().wait()
    finally:
        await asyncio.Event().wait()


class Post:
    """Mails of one dialogue, on a clock that moves by what is slept."""

    def __init__(
        self, *outcomes: Outcome, console: str | None = "https://mend.example.org"
    ) -> None:
        self.mailer = PlayedMailer(list(outcomes))
        self.now = datetime(2026, 1, 1, tzinfo=UTC)
        self.slept: list[float] = []
        self.while_asleep: Callable[[], None] = lambda: None
        self.dialogue = SimpleNamespace(id=DIALOGUE, asked=ASK, raised=detected(), open_ask=ASK)
        self.mail = OperatorMail(cast(Mailer, self.mailer), lambda: self.now, console, self._sleep)

    async def _sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.now += timedelta(seconds=seconds)
        self.while_asleep()

    def write(self, event: Escalated | SuspectedFalseAlarm = ESCALATED) -> None:
        state: Any = SimpleNamespace(id=RUN, started=SimpleNamespace(tree_name="eket"))
        self.mail.send_later(state, event, cast(Any, self.dialogue))

    async def delivered(self) -> None:
        await asyncio.gather(*self.mail._sending, return_exceptions=True)

    @property
    def asked_of(self) -> list[list[str]]:
        return [to for _, to, _ in self.mailer.sent]


async def test_a_mail_names_the_run_where_others_reach_it() -> None:
    post = Post()
    post.write()
    await post.delivered()
    ((mail, to, _),) = post.mailer.sent
    assert mail.console_url == f"https://mend.example.org/runs/{RUN}"
    assert to == [OPS, NIGHT]
    nowhere = Post(console=None)
    nowhere.write()
    await nowhere.delivered()
    assert nowhere.mailer.sent[0][0].console_url is None


async def test_a_mail_that_fails_is_tried_again_later(caplog: pytest.LogCaptureFixture) -> None:
    post = Post(failed(for_now=True), failed(for_now=True))
    post.write()
    await post.delivered()
    assert post.slept == list(WAITS_S[:2])
    assert post.asked_of == [[OPS, NIGHT]] * 3
    assert [each.levelname for each in caplog.records] == ["WARNING", "WARNING"]
    assert "no route; trying again in 5 s" in caplog.messages[0]


async def test_a_mail_that_always_fails_is_given_up_and_the_log_says_so(
    caplog: pytest.LogCaptureFixture,
) -> None:
    post = Post(*[failed(for_now=True)] * 10)
    post.write()
    await post.delivered()
    assert len(post.mailer.sent) == len(WAITS_S) + 1
    last = caplog.records[-1]
    assert last.levelname == "ERROR"
    assert f"about the dropped issue of robot to {OPS}, {NIGHT} is given up" in last.getMessage()


async def test_what_is_refused_for_good_is_not_tried_again(
    caplog: pytest.LogCaptureFixture,
) -> None:
    post = Post(failed(for_now=False))
    post.write()
    await post.delivered()
    assert len(post.mailer.sent) == 1
    assert "that is final" in caplog.messages[-1]


async def test_only_those_who_were_put_off_are_written_to_again(
    caplog: pytest.LogCaptureFixture,
) -> None:
    post = Post((*refuses(OPS), *puts_off(NIGHT)), puts_off(NIGHT))
    post.write()
    await post.delivered()
    assert post.asked_of == [[OPS, NIGHT], [NIGHT], [NIGHT]]
    assert f"the mail server refuses {OPS}: 550 unknown" in caplog.messages


async def test_a_question_that_was_answered_meanwhile_is_not_mailed() -> None:
    post = Post(failed(for_now=True))
    post.while_asleep = lambda: setattr(post.dialogue, "open_ask", None)
    post.write()
    await post.delivered()
    assert len(post.mailer.sent) == 1


async def test_a_notice_is_sent_however_late() -> None:
    post = Post(failed(for_now=True))
    post.while_asleep = lambda: setattr(post.dialogue, "open_ask", None)
    post.write(SUSPECTED)
    await post.delivered()
    assert len(post.mailer.sent) == 2


async def test_a_later_mail_leaves_less_time_to_answer() -> None:
    post = Post(failed(for_now=True), failed(for_now=True))
    post.write()
    await post.delivered()
    within = [
        mail.answer_within_s for mail, _, _ in post.mailer.sent if isinstance(mail, MailRequest)
    ]
    assert within == [600.0, 595.0, 565.0]
    assert [written for _, _, written in post.mailer.sent][-1] == post.now


async def test_stopping_waits_for_no_later_try(caplog: pytest.LogCaptureFixture) -> None:
    post = Post(failed(for_now=True))
    asleep = asyncio.Event()

    async def sleep(_: float) -> None:
        asleep.set()
        await asyncio.Event().wait()

    post.mail = OperatorMail(cast(Mailer, post.mailer), lambda: post.now, None, sleep)
    post.write()
    await asleep.wait()
    async with asyncio.timeout(60):
        await post.mail.close()
    assert (
        f"the service stops: the mail about the dropped issue of robot to {OPS}"
        in (caplog.messages[-1])
    )


async def test_stopping_does_not_wait_for_a_server_that_hangs(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.runtime.operator_mail.LAST_MOMENT_S", 0.01)
    post = Post()
    post.mailer.hangs = True
    post.write()
    async with asyncio.timeout(60):
        await post.mail.close()
    assert "the service stops" in caplog.messages[-1]


async def test_a_mail_that_is_under_way_has_a_last_moment(
    caplog: pytest.LogCaptureFixture,
) -> None:
    post = Post()
    post.write()
    await post.mail.close()
    assert len(post.mailer.sent) == 1
    assert caplog.messages == []
