"""The look after the last step, and the monitors that judge what it shows."""

from typing import Any, ClassVar

import pytest
from robot_bench import MODEL, RobotBench
from scripted_body import STARTS, catalogue

from robots.behaviors import Phase
from robots.link.messages import Detection, Finished, Holding, IssueDetected, Resume
from robots.monitors import Meanwhile, Monitor, MonitorView
from robots.monitors.monitor import NoParameters
from robots.robot import Robot
from robots.vision.presence import Presence
from tasks.plugins import load_plugins
from tasks.scene import StrictModel


class NotThere(Monitor[NoParameters]):
    """Raises `not_there` when the object is seen not to be where it was put."""

    issue: ClassVar[str] = "not_there"
    behaviors: ClassVar[frozenset[str]] = frozenset({"pick_and_place"})
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.CONFIRM})
    meanwhile: ClassVar[Meanwhile] = Meanwhile.STOP_IN_PLACE
    camera: ClassVar[str | None] = "head"
    parameters: ClassVar[type[StrictModel]] = NoParameters
    views: ClassVar[list[MonitorView]] = []

    def check(self, view: MonitorView) -> Detection | None:
        self.views.append(view)
        if view.presence is not Presence.GONE:
            return None
        return Detection(camera="head", explanation="it is not where it was put")


def bench_that_judges(**body: Any) -> RobotBench:
    NotThere.views.clear()
    bench = RobotBench(**body)
    bench.robot = Robot(
        "r1",
        bench.body,
        MODEL,
        catalogue(),
        load_plugins("mend.behaviors"),
        {**load_plugins("mend.monitors"), NotThere.issue: NotThere},
    )
    bench.robot.attach(
        lambda body, time_s, _: bench.reports.append((time_s, body)), bench.pictures.append
    )
    return bench


def test_the_arm_is_out_of_view_and_the_part_seen_at_its_place_before_it_is_finished() -> None:
    bench = bench_that_judges()
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]
    (view,) = NotThere.views
    assert (view.phase, view.step, view.presence) == (Phase.CONFIRM, 8, Presence.THERE)
    assert view.placed is not None
    assert (view.placed.x, view.placed.y) == pytest.approx((0.55, 0.05), abs=0.005)
    assert bench.body.tool.y < -0.8


@pytest.mark.parametrize(("step", "fraction"), [(6, 0.9), (7, 0.5), (8, 0.1), (8, 0.9)])
def test_what_is_stolen_while_it_is_placed_is_not_finished(step: int, fraction: float) -> None:
    bench = bench_that_judges()
    bench.at(step, fraction, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Finished) == []
    (issue,) = bench.of(IssueDetected)
    assert (issue.issue, issue.step) == ("not_there", 8)
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]


def test_what_was_stolen_and_put_to_its_place_meanwhile_is_found_there_on_resuming() -> None:
    bench = bench_that_judges()
    bench.at(8, 0.1, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    bench.body.at_cycle = lambda: None
    bench.body.parts["pink_bar"] = type(STARTS["pink_bar"])(0.55, 0.05)
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1", found_in_place=True)]


def test_nothing_is_looked_at_after_a_fault() -> None:
    bench = bench_that_judges()
    bench.at(5, 0.5, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["dropped"]
    assert NotThere.views == []
