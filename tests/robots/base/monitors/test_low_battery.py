"""When a base asks to be plugged in."""

import numpy as np
import pytest

from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.monitors.low_battery import LowBattery
from mend.robots.base.monitors.monitor import BaseView, Power, StandingFor
from mend.robots.execution.phase import Phase

HERE = BasePose(0.0, 0.0, 0.0)


def view(power: Power, phase: Phase = Phase.TRAVEL, waited_s: float = 5.0) -> BaseView:
    return BaseView(
        time_s=10.0,
        step=1,
        phase=phase,
        pose=HERE,
        goal=None,
        in_the_way_m=None,
        door=None,
        waited_s=0.0,
        stalled_s=0.0,
        no_way=None,
        elevator=None,
        scan=RangeScan(np.zeros(1), np.zeros(1), 0.0),
        standing=StandingFor(None, None, waited_s),
        power=power,
    )


@pytest.mark.parametrize(
    ("seen", "told"),
    [
        (view(Power(0.16)), None),
        (view(Power(0.14)), "my battery holds 14 %"),
        (view(Power(0.14, charging=True)), None),
        (view(Power(0.14, to_charger=True)), None),
        (view(Power(0.02, to_charger=True)), "my battery holds 2 %"),
        (view(Power(0.5), Phase.CHARGE), "no current comes here, and my battery holds 50 %"),
        (view(Power(0.5), Phase.CHARGE, waited_s=4.9), None),
        (view(Power(0.5, charging=True), Phase.CHARGE), None),
    ],
)
def test_it_asks_while_there_is_still_something_left(seen: BaseView, told: str | None) -> None:
    detection = LowBattery.create({}).check(seen)
    assert (None if detection is None else detection.explanation) == told
    assert detection is None or detection.measured == {"charge": seen.power.share}


def test_it_never_stops_in_an_elevator() -> None:
    assert not LowBattery.create({}).watches("go_to", Phase.RIDE)
