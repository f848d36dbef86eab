"""`lost`: raised by who has not found out by itself for a while, with where it may be."""

import numpy as np

from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.monitors.lost import Lost
from mend.robots.base.monitors.monitor import BaseView
from mend.robots.execution.phase import Phase

SCAN = RangeScan(np.zeros(1), np.zeros(1), 0.0)


def view(lost_s: float, *guesses: str) -> BaseView:
    return BaseView(
        time_s=10.0,
        step=1,
        phase=Phase.TRAVEL,
        pose=BasePose(0.0, 0.0, 0.0),
        goal=None,
        in_the_way_m=None,
        door=None,
        waited_s=0.0,
        stalled_s=0.0,
        no_way=None,
        elevator=None,
        scan=SCAN,
        lost_s=lost_s,
        guesses=lambda: guesses,
    )


def test_it_is_raised_after_a_while_with_what_it_may_be() -> None:
    monitor = Lost.create({"patience_s": 2.0})
    assert monitor.check(view(0.0)) is None
    assert monitor.check(view(1.9, "at 101")) is None
    detection = monitor.check(view(2.0, "at 101", "near 103"))
    assert detection is not None
    assert detection.guesses == ["at 101", "near 103"]
    assert detection.explanation == "what I see fits no place for sure"


def test_it_does_not_say_that_anything_fits_where_nothing_does() -> None:
    detection = Lost.create({}).check(view(5.0))
    assert detection is not None
    assert detection.explanation == "what I see fits no place that I know"


def test_it_watches_before_and_after_the_way_too() -> None:
    for phase in (Phase.PREPARE, Phase.TRAVEL, Phase.CONFIRM):
        assert Lost.create({}).watches("go_to", phase)
