"""A robot does nothing without one of its monitors, and says so."""

from typing import ClassVar

import pytest
from robot_bench import RobotBench

from mend.robots.arm.monitors import ArmMonitor, ArmView
from mend.robots.execution.monitor import NoParameters, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection, Finished, Holding, Interrupt, Rejected


class Broken(ArmMonitor[NoParameters]):
    """Fails where it is to judge."""

    issue: ClassVar[str] = "broken"
    behaviors: ClassVar[frozenset[str]] = frozenset({"pick_and_place"})
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.CARRY})
    reaction: ClassVar[Reaction] = Reaction.SLOW_DOWN
    parameters = NoParameters

    def check(self, view: ArmView) -> Detection | None:
        raise ZeroDivisionError(f"division by zero in step {view.step}")


class BrokenAtOnce(Broken):
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.PREPARE})


@pytest.mark.parametrize(("monitor", "step"), [(Broken, 5), (BrokenAtOnce, 0)])
def test_it_stops_and_refuses_whatever_comes_then(monitor: type[Broken], step: int) -> None:
    bench = RobotBench(monitors={"broken": monitor})
    bench.start("pink_bar", "left")
    bench.run()
    [rejected] = bench.of(Rejected)
    assert rejected == Rejected(
        command="c1",
        reason=(
            f"its monitor for 'broken' failed (ZeroDivisionError: division by zero in step {step})"
            ", and without one of its monitors it does nothing"
        ),
        for_good=True,
    )
    assert bench.of(Finished) == []
    bench.send(Interrupt(retreat=True))
    bench.run()
    assert [each.at for each in bench.of(Holding)] == ["neutral"]
    bench.start("pink_bar", "left")
    assert [each.for_good for each in bench.of(Rejected)] == [True, True]
