"""A cabin serves one call after the other, and never leaves with its door in somebody's way."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.errors import IllegalTransitionError
from mend.maps.building.building import Caller, Elevator
from mend.maps.building.cabin import CABIN_DOOR_S
from mend.sim.building.cabin import HELD_S, Cabin, CabinState

FLOORS = ("F1", "F2", "F3")
STEP_S = 0.5


def cabin_of(by: Caller = Caller.ROBOTS) -> Cabin:
    plan = Elevator(stops=dict.fromkeys(FLOORS, "lift"), called_by=by)
    return Cabin("lift", plan, FLOORS, "F1")


class Shaft:
    """A cabin, and robots that get in and out as soon as they may."""

    def __init__(self, cabin: Cabin) -> None:
        self.cabin, self.time_s = cabin, 0.0
        self.inside: list[int] = []

    def wait(self, seconds: float, *, door_is_free: bool = True) -> None:
        until_s = self.time_s + seconds
        while self.time_s < until_s:
            self.time_s += STEP_S
            self.cabin.pass_time(self.time_s, self.inside, door_is_free=door_is_free)

    def until_open_at(self, floor: str) -> None:
        until_s = self.time_s + 100.0
        while not self.cabin.is_open_at(floor):
            assert self.time_s < until_s, f"it never opens at {floor}"
            self.wait(STEP_S)


def test_it_fetches_a_robot_and_takes_it_to_its_floor() -> None:
    shaft = Shaft(cabin_of())
    shaft.cabin.call(7, "F3", "F2")
    shaft.until_open_at("F3")
    shaft.inside = [7]
    shaft.until_open_at("F2")
    assert shaft.cabin.call_of(7) is None
    shaft.wait(60.0)
    assert shaft.cabin.is_open_at("F2"), "it waits until the robot is out"
    shaft.inside = []
    shaft.wait(10.0)
    assert shaft.cabin.state is CabinState.SHUT


def test_what_people_call_does_not_come_by_itself() -> None:
    shaft = Shaft(cabin_of(Caller.PEOPLE))
    shaft.cabin.call(7, "F2", "F3")
    shaft.wait(30.0)
    assert shaft.cabin.floor == "F1"
    call = shaft.cabin.call_of(7)
    assert call is not None
    call.to = "F3"
    shaft.until_open_at("F2")


def test_who_was_taken_to_a_wrong_floor_waits_for_another_button_as_often_as_it_takes() -> None:
    shaft = Shaft(cabin_of(Caller.PEOPLE))
    shaft.cabin.call(7, "F1", "F3")
    pressed = ["F2", "F1", "F2", "F3"]
    shaft.cabin.calls[0].to = "F2"
    shaft.until_open_at("F1")
    shaft.inside = [7]
    for floor in pressed:
        call = shaft.cabin.call_of(7)
        assert call is not None
        call.to = floor
        shaft.wait(STEP_S)
        shaft.until_open_at(floor)
        wants = shaft.cabin.call_of(7)
        assert (wants is None) == (floor == "F3")
        assert wants is None or wants.to is None


def test_it_does_not_shut_on_anybody() -> None:
    shaft = Shaft(cabin_of())
    shaft.cabin.call(7, "F1", "F2")
    shaft.until_open_at("F1")
    shaft.inside = [7]
    shaft.wait(60.0, door_is_free=False)
    assert shaft.cabin.is_open_at("F1")


def test_it_stays_open_for_whom_somebody_in_it_waits_for() -> None:
    shaft = Shaft(cabin_of())
    shaft.cabin.call(7, "F1", "F2", stay_open=True)
    shaft.until_open_at("F1")
    shaft.inside = [7]
    shaft.wait(2.0 * HELD_S)
    assert shaft.cabin.is_open_at("F1")
    shaft.cabin.call(7, "F1", "F2")
    shaft.until_open_at("F2")


def test_who_does_not_get_in_is_not_waited_for_for_ever() -> None:
    shaft = Shaft(cabin_of())
    shaft.cabin.call(7, "F1", "F2")
    shaft.until_open_at("F1")
    shaft.cabin.call(8, "F3", "F1")
    shaft.wait(HELD_S + 30.0)
    assert shaft.cabin.is_open_at("F3")


def test_it_opens_for_who_is_in_it_and_wants_nothing_any_more() -> None:
    shaft = Shaft(cabin_of())
    shaft.cabin.call(7, "F1", "F3")
    shaft.until_open_at("F1")
    shaft.inside = [7]
    while shaft.cabin.state is not CabinState.SHUT:
        shaft.wait(STEP_S)
    shaft.cabin.withdraw(7)
    shaft.until_open_at("F1")


def test_who_is_in_it_goes_first() -> None:
    shaft = Shaft(cabin_of())
    shaft.cabin.call(8, "F2", "F1")
    shaft.inside = [7]
    shaft.cabin.call(7, "F1", "F3")
    shaft.until_open_at("F3")
    assert shaft.cabin.call_of(8) is not None


@given(
    calls=st.lists(
        st.tuples(st.sampled_from(FLOORS), st.sampled_from(FLOORS)).filter(lambda e: e[0] != e[1]),
        min_size=1,
        max_size=6,
    )
)
def test_every_call_is_served(calls: list[tuple[str, str]]) -> None:
    shaft, served = Shaft(cabin_of()), set[int]()
    for robot, (begin, wants) in enumerate(calls):
        shaft.cabin.call(robot, begin, wants)
    for _ in calls:
        call = shaft.cabin.serving(())
        assert call is not None
        shaft.until_open_at(call.begin)
        shaft.inside = [call.robot]
        shaft.until_open_at(call.wants)
        shaft.inside = []
        served.add(call.robot)
    assert len(served) == len(calls)


def test_a_cabin_that_is_open_does_not_move() -> None:
    cabin = cabin_of()
    cabin.state = CabinState.OPEN
    with pytest.raises(IllegalTransitionError, match="expected shut"):
        cabin._go("F3", 1.0)


@pytest.mark.parametrize("by", Caller)
@pytest.mark.parametrize(("floors", "comes_to"), [(FLOORS, "F2"), (("F1", "F3"), "F1")])
def test_who_is_misdirected_is_taken_elsewhere_first_once(
    by: Caller, floors: tuple[str, ...], comes_to: str
) -> None:
    plan = Elevator(stops=dict.fromkeys(floors, "lift"), called_by=by)
    shaft = Shaft(Cabin("lift", plan, FLOORS, "F1"))
    shaft.cabin.misdirected = True
    shaft.cabin.call(7, "F1", "F3")
    shaft.cabin.calls[0].to = "F3"
    shaft.until_open_at("F1")
    shaft.inside = [7]
    while shaft.cabin.state is not CabinState.SHUT:
        shaft.wait(STEP_S)
    shaft.until_open_at(comes_to)
    shaft.wait(CABIN_DOOR_S + STEP_S)
    call = shaft.cabin.call_of(7)
    assert call is not None
    assert call.to is None
    call.to = "F3"
    shaft.until_open_at("F3")
    assert shaft.cabin.call_of(7) is None


def test_nobody_gets_in_with_who_waits_in_it_for_another_button() -> None:
    shaft = Shaft(cabin_of())
    shaft.cabin.misdirected = True
    shaft.cabin.call(7, "F1", "F3")
    shaft.cabin.call(8, "F2", "F1")
    shaft.until_open_at("F1")
    shaft.inside = [7]
    shaft.until_open_at("F2")
    shaft.wait(CABIN_DOOR_S + STEP_S)
    assert not shaft.cabin.is_open_for(8, "F2")
    shaft.cabin.calls[0].to = "F3"
    shaft.until_open_at("F3")
    shaft.inside = []
    shaft.until_open_at("F2")
    assert shaft.cabin.is_open_for(8, "F2")
