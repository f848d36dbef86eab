"""Whoever follows a request hears that its robot waits for people, and what for."""

from typing import Any
from uuid import UUID

import pytest
from dispatch_office import asked
from test_legs_as_runs import SITE, working

from mend.dialogue.script import Help
from mend.server.fleets.waiting_robots import followed, waiting_robots
from mend.server.runtime.views import AwaitedHelp, DialogueView, PromptView

RUN, OTHER = UUID(int=1), UUID(int=2)
HELP = AwaitedHelp(help=Help.PLACE, helper="anna", until=60.0)


def dialogue(run: UUID = RUN, headline: str = "Please put the tea in.", **fields: Any) -> Any:
    prompt = PromptView(
        prompt=UUID(int=5),
        version=1,
        kind="ask",
        text="I need help.",
        answers=[],
        deadline=None,
        to=None,
        headline=headline,
    )
    known: dict[str, Any] = dict.fromkeys(DialogueView.model_fields)
    known |= {"run": run, "dialogue": UUID(int=4), "robot": "r0", "prompt": prompt}
    known |= {"awaiting": "answer", "scripted": False, **fields}
    return DialogueView.model_construct(**known)


def test_a_robot_that_asks_waits_for_an_answer_or_for_the_help_that_was_promised() -> None:
    asks = waiting_robots([dialogue()])[RUN]
    assert (asks.robot, asks.headline, asks.helper) == ("r0", "Please put the tea in.", None)
    helped = waiting_robots([dialogue(awaiting="help", help=HELP, headline="")])[RUN]
    assert (helped.headline, helped.helper) == ("I need help.", "anna")


@pytest.mark.parametrize("fields", [{"scripted": True}, {"awaiting": None}, {"prompt": None}])
def test_a_robot_waits_for_nobody_where_people_are_not_asked(fields: dict[str, Any]) -> None:
    assert waiting_robots([dialogue(**fields)]) == {}


async def test_a_request_tells_what_the_robot_waits_for_that_is_next_to_do_something() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        waiting = waiting_robots([dialogue(), dialogue(OTHER)])
        (booked,) = await work.fleet.requests()
        view = followed(SITE, booked, {"r0": RUN}.get, waiting)
        assert view.waits == waiting[RUN]
        assert followed(SITE, booked, {"r1": RUN}.get, waiting).waits is None
        assert followed(SITE, booked, {"r0": UUID(int=3)}.get, waiting).waits is None


async def test_what_is_read_later_than_it_was_expected_is_late_by_the_clock_that_is_shown() -> None:
    async with working("a") as work:
        await work.fleet.requesters.submit(asked(), None)
        await work.runs.nth(1)
        (before,) = await work.fleet.requests()
        work.site.shown_s = 500.0
        (after,) = await work.fleet.requests()
        assert before.expected is not None
        assert after.expected is not None
        assert (before.expected.late_s, before.expected.done_s) == (0.0, pytest.approx(40.0))
        assert after.expected.late_s > 0.0
        assert after.expected.done_s == pytest.approx(530.0)
