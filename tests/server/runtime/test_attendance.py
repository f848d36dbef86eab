"""No question expires unseen while somebody is signed in to help and on nothing."""

from contextlib import ExitStack

from answer_races import ONE_PART
from pretend_service import pretend_service

from mend.server.dialogues.attendance import Attendance
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.journal import events as ev

FAULT = {"part_1": [("missed", 4)]}
ANN_ALONE = EscalationPolicy(helpers=("ann",), repeats=1, operators=("ops@example.org",))


async def asked_one_after_the_other(*attending: str, policy: EscalationPolicy) -> list[str | None]:
    """Whom the first question was put to until it expired; "mail" for the operators."""
    attendance = Attendance()
    with ExitStack() as there:
        for helper in attending:
            there.enter_context(attendance.attending(helper))
        async with pretend_service(
            ONE_PART, FAULT, policy=policy, attendance=attendance
        ) as service:
            _, events = await service.run_to_end(answers="none", max_attempts=1)
    asked: list[str | None] = []
    for event in events:
        match event:
            case ev.Escalated(channel="mail"):
                asked.append("mail")
            case ev.Prompt(kind="ask", to=to) if not asked or asked[-1] != "mail":
                asked.append(to)
    return asked


async def test_a_question_goes_on_to_whoever_is_there_before_it_is_given_up() -> None:
    assert await asked_one_after_the_other("dan", "eve", policy=ANN_ALONE) == [
        "dan",
        "dan",
        "eve",
        "ann",
        "dan",
        "eve",
        "mail",
    ]


async def test_where_nobody_is_there_the_ladder_is_what_the_policy_says() -> None:
    assert await asked_one_after_the_other(policy=ANN_ALONE) == ["ann", "ann", "mail"]


async def test_whoever_was_asked_last_is_not_asked_once_more() -> None:
    assert await asked_one_after_the_other("ann", policy=ANN_ALONE) == ["ann", "ann", "mail"]


async def test_each_question_says_whom_the_robot_asks_next() -> None:
    attendance = Attendance()
    with attendance.attending("dan"):
        async with pretend_service(
            ONE_PART, FAULT, policy=ANN_ALONE, attendance=attendance
        ) as service:
            _, events = await service.run_to_end(answers="none", max_attempts=1)
    asks = [each for each in events if isinstance(each, ev.Prompt) and each.kind == "ask"]
    said = [each.timeout_effect.split("; if nobody")[0] for each in asks[:4]]
    assert said == ["I ask again", "I ask ann", "I ask dan", "I write to the operators"]


def test_somebody_with_two_devices_is_there_until_both_are_gone() -> None:
    attendance, heard = Attendance(), list[list[str]]()
    attendance.changed = lambda: heard.append(attendance.there)
    with attendance.attending("ann"), attendance.attending("ben"):
        with attendance.attending("ann"):
            pass
        assert attendance.there == ["ann", "ben"]
    assert attendance.there == []
    assert heard[-3:] == [["ann", "ben"], ["ann"], []]


class Wall:
    """A clock that goes when it is told."""

    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


def test_who_has_done_nothing_for_a_while_or_has_left_the_page_is_away() -> None:
    clock, heard = Wall(), list[list[str]]()
    attendance = Attendance(clock, away_after_s=300.0)
    attendance.changed = lambda: heard.append(attendance.away)
    with (
        attendance.attending("ann", "active") as page,
        attendance.attending("ben", "beside"),
        attendance.attending("cem"),
    ):
        assert attendance.away == []
        clock.now_s = 299.0
        attendance.says("ann", page, "active")
        clock.now_s = 598.0
        assert attendance.away == []
        clock.now_s = 599.0
        assert attendance.away == ["ann"]
        attendance.says("ann", page, "active")
        assert attendance.away == []
        attendance.says("ann", page, "away")
        assert attendance.away == ["ann"]
        assert attendance.there == ["ann", "ben", "cem"]
        # Only what changes who is here is told.
        assert heard == [[], [], [], [], ["ann"]]


def test_somebody_is_here_who_is_at_one_of_their_devices() -> None:
    attendance = Attendance(Wall())
    with attendance.attending("ann", "away"):
        assert attendance.away == ["ann"]
        with attendance.attending("ann", "active"):
            assert attendance.away == []
        assert attendance.away == ["ann"]


async def test_a_page_that_was_left_is_called_after_who_is_here() -> None:
    attendance = Attendance(Wall())
    policy = EscalationPolicy(helpers=("ann", "ben"), repeats=0)
    with attendance.attending("ann", "away"), attendance.attending("ben", "active"):
        async with pretend_service(
            ONE_PART, FAULT, policy=policy, attendance=attendance
        ) as service:
            _, events = await service.run_to_end(answers="none", max_attempts=1)
    asks = [each.to for each in events if isinstance(each, ev.Prompt) and each.kind == "ask"]
    assert asks[:2] == ["ben", "ann"]
