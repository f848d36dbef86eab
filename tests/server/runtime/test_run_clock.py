"""The run's clock and a robot's: a moment that came on one has come on the other."""

import asyncio

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pretend_service import pretend_service
from task_documents import definition_of

from mend.server.runtime.clock import SimulatedClock, WorldTime, has_come
from mend.server.runtime.views import RunStatus
from mend.sim.tabletop.layout import lay_out

NAMES = [("part_1", "spot_1")]
LEAVES = [{"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in NAMES]

moments = st.floats(min_value=0.0, max_value=1e5)


@given(start=moments, robot=moments, wait_s=st.floats(min_value=0.0, max_value=1e4))
def test_a_robot_that_waited_until_a_moment_has_let_it_come(
    start: float, robot: float, wait_s: float
) -> None:
    clock = SimulatedClock(start)
    clock.align(robot)
    until = start + wait_s
    clock.observe(clock.to_robot(until))
    assert has_come(clock, until)


def test_what_is_still_to_come_has_not_come() -> None:
    clock = SimulatedClock(3.0)
    assert not has_come(clock, 3.1)
    assert has_come(clock, 3.0)


def test_what_passed_in_its_world_until_a_robot_was_there_has_passed_for_the_run_too() -> None:
    world = WorldTime()
    world.heard(500.0)
    clock = SimulatedClock(0.0, world, began_s=500.0)
    world.heard(502.0)
    clock.align(490.0)
    assert (clock.now(), clock.to_robot(10.0)) == (2.0, 510.0)
    world.begin_anew()
    clock.align(498.0)
    assert (clock.now(), clock.to_robot(10.0)) == (2.0, 506.0), "the world was made anew"


def test_a_robot_that_told_of_its_clock_long_ago_tells_no_run_that_time_has_passed() -> None:
    world = WorldTime()
    world.heard(20.0)
    clock = SimulatedClock(0.0, world, began_s=220.0)
    clock.align(20.0)
    clock.observe(221.5)
    assert clock.now() == 1.5


@pytest.mark.parametrize("robot_time", [0.0, 17.8, 1000.1])
async def test_promised_help_is_looked_for_whatever_the_robots_clock_says(
    robot_time: float,
) -> None:
    faults = {"part_1": [("blocked", 6)]}
    async with asyncio.timeout(10):
        async with pretend_service(
            definition_of({"then": LEAVES}),
            faults,
            scene=lay_out(NAMES, seed=1),
            felt=True,
            time=robot_time,
        ) as service:
            view, _ = await service.run_to_end(answers=["yes"])
    assert view.status is RunStatus.FINISHED


def test_it_catches_up_with_what_robots_show_of_their_world_once_one_has_joined() -> None:
    clock = SimulatedClock(start=3.0, shown_s=lambda: 140.0)
    clock.catch_up()
    assert clock.now() == 3.0, "nobody has said where the world's clock was when it began"
    clock.align(100.0)
    clock.catch_up()
    assert clock.now() == 43.0
    clock.observe(120.0)
    assert clock.now() == 43.0
