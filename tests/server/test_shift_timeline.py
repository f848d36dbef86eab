"""Each thing in a shift comes at its moment, whatever else is waited for meanwhile."""

import asyncio
from functools import partial
from typing import Any, cast

from mend.errors import ConflictError
from mend.fleet.happenings import RobotFails
from mend.server.cli.failing_robot import FailingRobot
from mend.server.cli.shift_timeline import Due, Timeline
from mend.server.cli.silence import Silence


class PretendFleet:
    """A fleet whose clock goes on to the next moment that anybody waits for; it is its operators.

    `brings`: from when on which robot brings something.
    """

    def __init__(self, **brings: float) -> None:
        self.now_s = 0.0
        self.brings = brings
        self.out_of_service: dict[str, str] = {}
        self.told: list[tuple[float, str]] = []
        self._moments: list[float] = []

    @property
    def operators(self) -> "PretendFleet":
        return self

    async def wait_until(self, moment_s: float) -> None:
        self._moments.append(moment_s)
        while self.now_s < moment_s:
            # Whoever else is to wait does so by then.
            for _ in range(20):
                await asyncio.sleep(0)
            self.now_s = max(self.now_s, min(self._moments))
        self._moments.remove(moment_s)

    async def read(self, _: object) -> str | None:
        free = [e for e, since_s in self.brings.items() if since_s <= self.now_s]
        return next((e for e in free if e not in self.out_of_service), None)

    async def take_out(self, robot: str, reason: str, _: object) -> None:
        if robot in self.out_of_service:
            raise ConflictError(f"{robot} is out already")
        self.out_of_service[robot] = reason
        self.note(f"{robot} fails")

    async def put_back(self, robot: str, _: object) -> None:
        del self.out_of_service[robot]
        self.note(f"{robot} works")

    def note(self, what: str) -> None:
        self.told.append((self.now_s, what))

    async def carry_out(self, failures: list[RobotFails], *wishes_s: float) -> None:
        """A shift in which robots fail, and something is asked at these moments."""
        timeline = Timeline(self.wait_until, self.note)
        due = [Due(each, partial(self._ask, each)) for each in wishes_s]
        for each in failures:
            failing = FailingRobot(cast(Any, self), each, each.robot, timeline.beside)
            due.append(Due(each.at_s, failing.begin))
            if each.until_s is not None:
                due.append(Due(each.until_s, failing.end, ends=True))
        await timeline.run(due)

    async def _ask(self, at_s: float) -> None:
        self.note(f"asked at {at_s:g}")


def fails(at_s: float, until_s: float | None = None, robot: str | None = None) -> RobotFails:
    return RobotFails(kind="robot_fails", at_s=at_s, until_s=until_s, robot=robot, reason="stuck")


IN_VAIN = "no robot fails (stuck): from {} to {} s none was on a long way with anything"


async def test_who_waits_for_a_robot_that_brings_something_holds_nobody_up() -> None:
    fleet = PretendFleet()
    await fleet.carry_out([fails(50.0, 90.0)], 60.0, 100.0)
    assert fleet.told == [
        (60.0, "asked at 60"),
        (90.0, IN_VAIN.format(50, 90)),
        (100.0, "asked at 100"),
    ]


async def test_without_an_end_it_is_waited_for_half_an_hour() -> None:
    fleet = PretendFleet()
    await fleet.carry_out([fails(50.0)], 3000.0)
    assert fleet.told == [(1850.0, IN_VAIN.format(50, 1850)), (3000.0, "asked at 3000")]


async def test_one_that_brings_something_later_fails_then_and_works_again() -> None:
    fleet = PretendFleet(r1=57.0)
    await fleet.carry_out([fails(50.0, 90.0)], 70.0)
    assert fleet.told == [(60.0, "r1 fails"), (70.0, "asked at 70"), (90.0, "r1 works")]


async def test_what_failed_already_neither_fails_again_nor_works_sooner() -> None:
    fleet = PretendFleet()
    await fleet.carry_out([fails(10.0, 90.0, "r1"), fails(20.0, 40.0, "r1")])
    assert fleet.told == [(10.0, "r1 fails"), (20.0, "r1 is out already"), (90.0, "r1 works")]


async def test_what_ends_as_something_begins_ends_first_however_both_are_listed() -> None:
    fleet = PretendFleet()
    await fleet.carry_out([fails(20.0, 30.0, "r1"), fails(10.0, 20.0, "r1")])
    assert fleet.told == [
        (10.0, "r1 fails"),
        (20.0, "r1 works"),
        (20.0, "r1 fails"),
        (30.0, "r1 works"),
    ]


async def test_people_answer_again_when_the_last_of_several_spans_is_over() -> None:
    answers: list[str] = []

    async def have_answered(how: str) -> None:
        answers.append(how)

    silence = Silence(have_answered)
    for deed in (silence.begin, silence.begin, silence.end, silence.end):
        await deed()
    assert answers == ["late", "late", "yes"]


async def test_what_was_to_happen_long_ago_comes_in_its_order() -> None:
    fleet = PretendFleet()
    fleet.now_s = 500.0
    await fleet.carry_out([fails(50.0, 90.0, "r1")], 70.0, 60.0)
    assert [what for _, what in fleet.told] == [
        "r1 fails",
        "asked at 60",
        "asked at 70",
        "r1 works",
    ]
