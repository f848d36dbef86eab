"""Cycles in which nothing happens pass at once, and leave what they would have left one by one."""

import math
from typing import Any

import numpy as np
import pytest
from building_bench import BuildingBench, made_up
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.robots.link.messages import Hold, IssueDetected
from mend.sim.building.cycles import Cycles
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention

OPTIONS: list[dict[str, Any]] = [
    {"shut_doors": 0.5, "unmapped": 0.3, "battery_wh": 50.0, "carried_every_s": 5.0},
    {"people": 2, "blocked_hallways": 0.3, "battery_wh": 50.0},
    {"localizer": "enml", "unmapped": 0.2},
]


class Counted(BuildingBench):
    """A building in which cycles are counted, and may have to pass one by one."""

    def __init__(self, *, leaps: bool, **options: Any) -> None:
        super().__init__(scene_of(made_up(2, 6), "office", 2), **options)
        self.cycles = 0
        advance_cycle, leap = self.world.advance_cycle, self.world.leap

        def counted() -> None:
            self.cycles += 1
            advance_cycle()

        self.world.advance_cycle = counted  # type: ignore[method-assign]
        self.world.leap = lambda until_s: leap(until_s) if leaps else None  # type: ignore[method-assign]

    def hold_until(self, until_s: float) -> None:
        self.send("robot2", Hold(until=until_s, rate=None))
        while self.group.advance(1000.0):
            pass


def hours(leaps: bool, *, place: str, person: bool, **options: Any) -> tuple[list[Any], int]:
    """What a building is like at some moments of a day on which a robot drives now and then."""
    bench, states = Counted(leaps=leaps, **options), []
    if person:
        bench.go("robot1", place, "meet_person", person="Ann")
    else:
        bench.go("robot1", place)
    for pause_s in (7.03, 20.0, 60.5):
        bench.hold_until(bench.group.time_s() + pause_s)
        states.append(bench.world.snapshot())
        bench.world.intervene(Intervention(act=Act.RELEASE))
    return states, bench.cycles


@pytest.mark.drawn(1)
@pytest.mark.slow(2)
@pytest.mark.parametrize("options", OPTIONS, ids=lambda each: "-".join(each))
def test_a_leap_is_as_many_cycles_one_by_one(options: dict[str, Any]) -> None:
    person = "localizer" not in options
    leapt, few = hours(True, place="F1-103", person=person, **options)
    passed, many = hours(False, place="F1-103", person=person, **options)
    assert leapt == passed
    assert few < (many if "people" in options else many / 2)


def test_nothing_is_leapt_over_that_a_robot_does() -> None:
    bench = Counted(leaps=True, shut_doors=1.0)
    bench.go("robot1", "F1-101")
    bench.run_until(IssueDetected)
    assert bench.cycles * 0.05 == pytest.approx(bench.group.time_s())


def test_nothing_is_leapt_over_while_a_robot_that_does_nothing_is_lost() -> None:
    bench = Counted(leaps=True, localizer="enml", unmapped=0.3)
    bench.hold_until(5.0)
    robot = bench.world.robots[0]
    assert robot.belief is not None
    before, at = bench.cycles, np.array([robot.at.x, robot.at.y, robot.at.yaw])
    robot.belief.whereabouts.start_anew(at, np.array(robot.odometer.pose), lost=True)
    bench.hold_until(5.5)
    assert bench.cycles - before == 10


@given(st.integers(0, 10**7), st.floats(0.0, 1e6))
@settings(max_examples=200)
def test_a_leap_ends_one_cycle_before_what_happens(passed: int, ahead_s: float) -> None:
    cycles = Cycles()
    cycles.passed = passed
    due_s = cycles.time_s() + ahead_s
    cycles.passed += cycles.before(due_s)
    assert cycles.time_s() < due_s or cycles.passed == passed
    assert cycles.before(-math.inf) == 0
    cycles.passed += 1
    assert cycles.time_s() >= due_s - 1e-9
