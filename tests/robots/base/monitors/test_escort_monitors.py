"""When a base that is to escort somebody asks for them."""

import math

import numpy as np
import pytest

from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.companion import Sighting
from mend.robots.base.monitors.fell_behind import FellBehind
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView, Left, StandingFor
from mend.robots.base.monitors.person_not_there import PersonNotThere
from mend.robots.execution.phase import Phase


def view(standing: StandingFor | None = None, left: Left | None = None) -> BaseView:
    return BaseView(
        time_s=10.0,
        step=2,
        phase=Phase.MEET,
        pose=BasePose(0.0, 0.0, 0.0),
        goal=None,
        in_the_way_m=None,
        door=None,
        waited_s=0.0,
        stalled_s=0.0,
        no_way=None,
        elevator=None,
        scan=RangeScan(np.zeros(1), np.zeros(1), 0.0),
        standing=standing,
        left=left,
    )


@pytest.mark.parametrize(
    ("monitor", "seen", "told"),
    [
        (
            PersonNotThere,
            view(StandingFor(None, "F1-101", 10.0)),
            "I have waited at F1-101 for 10 s, and see nobody beside me",
        ),
        (PersonNotThere, view(StandingFor(None, "F1-101", 9.9)), None),
        (PersonNotThere, view(), None),
        (
            FellBehind,
            view(left=Left(20.0, Sighting(3.4, math.pi))),
            "I have waited for 20 s, and saw who follows me last 3.4 m behind me",
        ),
        (
            FellBehind,
            view(left=Left(25.0, None)),
            "I have waited for 25 s, and have not seen who follows me",
        ),
        (FellBehind, view(left=Left(19.9, None)), None),
        (FellBehind, view(), None),
    ],
)
def test_it_tells_how_long_it_has_waited(
    monitor: type[BaseMonitor], seen: BaseView, told: str | None
) -> None:
    detection = monitor.create({}).check(seen)
    assert (None if detection is None else detection.explanation) == told


@pytest.mark.parametrize(
    ("monitor", "phases"),
    [
        (PersonNotThere, {Phase.MEET}),
        (FellBehind, {Phase.TRAVEL, Phase.RIDE, Phase.ARRIVE}),
    ],
)
def test_each_watches_where_it_matters(monitor: type[BaseMonitor], phases: set[Phase]) -> None:
    made = monitor.create({})
    assert {each for each in Phase if made.watches("escort", each)} == phases
