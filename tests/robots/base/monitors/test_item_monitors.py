"""When a base asks people to put something in or take it out, and misses something."""

import numpy as np
import pytest

from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.monitors.item_missing import ItemMissing
from mend.robots.base.monitors.item_not_given import ItemNotGiven
from mend.robots.base.monitors.item_not_taken import ItemNotTaken
from mend.robots.base.monitors.item_taken import ItemTaken
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView, StandingFor
from mend.robots.base.monitors.nobody_answers import NobodyAnswers
from mend.robots.execution.phase import Phase

HERE = BasePose(0.0, 0.0, 0.0)


def view(
    *,
    item: str | None = "mail",
    waited_s: float = 2.0,
    lacks: str | None = None,
    missing_kg: float = 0.0,
) -> BaseView:
    return BaseView(
        time_s=10.0,
        step=2,
        phase=Phase.LOAD,
        pose=HERE,
        goal=None,
        in_the_way_m=None,
        door=None,
        waited_s=0.0,
        stalled_s=0.0,
        no_way=None,
        elevator=None,
        scan=RangeScan(np.zeros(1), np.zeros(1), 0.0),
        standing=StandingFor(item, None if item is None else "F1-101", waited_s),
        lacks=lacks,
        missing_kg=missing_kg,
    )


@pytest.mark.parametrize(
    ("monitor", "seen", "told"),
    [
        (ItemNotGiven, view(), "I have come to F1-101 to collect the mail"),
        (ItemNotGiven, view(waited_s=1.9), None),
        (ItemNotTaken, view(), "I have brought the mail to F1-101"),
        (ItemNotTaken, view(waited_s=1.9), None),
        (NobodyAnswers, view(item=None), "nobody has told me yet that it was heard"),
        (NobodyAnswers, view(item=None, waited_s=1.9), None),
        (ItemMissing, view(lacks="mail"), "nobody has given me the mail"),
        (ItemMissing, view(), None),
        (ItemTaken, view(missing_kg=0.62), "my basket is 0.6 kg lighter than it was"),
        (ItemTaken, view(missing_kg=0.07), "my basket is 0.1 kg lighter than it was"),
        (ItemTaken, view(missing_kg=0.03), None),
    ],
)
def test_it_tells_what_it_waits_for_or_misses(
    monitor: type[BaseMonitor], seen: BaseView, told: str | None
) -> None:
    detection = monitor.create({}).check(seen)
    assert (None if detection is None else detection.explanation) == told


@pytest.mark.parametrize(
    ("monitor", "phases"),
    [
        (ItemNotGiven, {Phase.LOAD}),
        (ItemNotTaken, {Phase.UNLOAD}),
        (NobodyAnswers, {Phase.TELL}),
        (ItemMissing, {Phase.PREPARE}),
        (ItemTaken, {Phase.PREPARE, Phase.TRAVEL, Phase.RIDE, Phase.UNLOAD}),
    ],
)
def test_each_watches_where_it_matters(monitor: type[BaseMonitor], phases: set[Phase]) -> None:
    made = monitor.create({})
    assert {each for each in Phase if made.watches("collect_item", each)} == phases
