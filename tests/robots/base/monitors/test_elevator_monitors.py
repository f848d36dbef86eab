"""When a base asks for help with an elevator, and when it says that the floor is a wrong one."""

import numpy as np
import pytest

from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.monitors.elevator_help import ElevatorHelp
from mend.robots.base.monitors.monitor import AwaitedElevator, BaseView
from mend.robots.base.monitors.wrong_floor import WrongFloor
from mend.robots.base.ways import Ride
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection

HERE = BasePose(0.0, 0.0, 0.0)


def view(
    *,
    called: bool = False,
    aboard: bool = False,
    is_open: bool = False,
    was_shut: bool = False,
    floor: str | None = "F1",
    waited_s: float = 10.0,
    failed: str | None = None,
) -> BaseView:
    ride = Ride("lift1", "F1", "F3", HERE, HERE, HERE, HERE, called)
    return BaseView(
        time_s=10.0,
        step=1,
        phase=Phase.RIDE,
        pose=HERE,
        goal=None,
        in_the_way_m=None,
        door=None,
        waited_s=0.0,
        stalled_s=0.0,
        no_way=None,
        elevator=AwaitedElevator(
            ride=ride,
            aboard=aboard,
            is_open=is_open,
            was_shut=was_shut,
            floor=floor,
            waited_s=waited_s,
            failed=failed,
        ),
        scan=RangeScan(np.zeros(1), np.zeros(1), 0.0),
        lost_s=0.0,
        guesses=lambda: (),
    )


@pytest.mark.parametrize(
    ("seen", "asks_for"),
    [
        (view(), "I need lift1 to get from F1 to F3"),
        (view(waited_s=1.0), None),
        (view(is_open=True), None),
        (view(called=True), None),
        (view(called=True, waited_s=240.0), "I have waited for lift1 for 240 s"),
        (view(aboard=True, is_open=True), "I am in lift1, and need to get to F3"),
        (view(aboard=True, was_shut=True), None),
        (view(called=True, aboard=True, waited_s=300.0), "I have waited in lift1 for 300 s"),
    ],
)
def test_it_asks_people_for_what_it_cannot_do_or_wait_for(
    seen: BaseView, asks_for: str | None
) -> None:
    detection = ElevatorHelp.create({}).check(seen)
    assert (None if detection is None else detection.explanation) == asks_for


@pytest.mark.parametrize("called", [True, False])
def test_it_asks_for_a_robot_to_be_pushed_out_that_has_failed_in_the_cabin(*, called: bool) -> None:
    def asked(*, is_open: bool, waited_s: float) -> Detection | None:
        seen = view(called=called, failed="robot2", is_open=is_open, waited_s=waited_s)
        return ElevatorHelp.create({}).check(seen)

    assert asked(is_open=False, waited_s=1.0) is None
    assert asked(is_open=True, waited_s=10.0) is None
    detection = asked(is_open=False, waited_s=2.0)
    assert detection is not None
    assert detection.robot == "robot2"
    needs = "I need lift1 to get from F1 to F3"
    assert detection.explanation == (
        f"{needs}, and robot2, which has failed, has to be pushed out of it"
    )


@pytest.mark.parametrize(
    ("seen", "wrong"),
    [
        (view(aboard=True, is_open=True, was_shut=True, floor="F2"), True),
        (view(aboard=True, is_open=True, was_shut=True, floor="F3"), False),
        (view(aboard=True, is_open=True, was_shut=False, floor="F1"), False),
        (view(aboard=True, is_open=False, was_shut=True, floor="F2"), False),
        (view(aboard=True, is_open=True, was_shut=True, floor=None), False),
        (view(is_open=True, was_shut=True, floor="F2"), False),
    ],
)
def test_it_says_so_only_where_the_cabin_was_shut_and_is_open_elsewhere(
    seen: BaseView, wrong: bool
) -> None:
    detection = WrongFloor.create({}).check(seen)
    assert (detection is not None) == wrong
    if detection is not None:
        assert detection.explanation == "lift1 has opened at F2, and I must get to F3"
