"""The example package: one more fault, by addition only."""

import tomllib
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from robot_bench import RobotBench
from slipping.dialogue import script
from slipping.monitor import Slipping

from mend.dialogue.registry import make_script
from mend.robots.execution.monitor import AnyMonitor
from mend.robots.link.messages import Finished, IssueDetected

PROJECT = Path(__file__).parents[4] / "examples" / "slipping" / "pyproject.toml"


def bench_with_slipping(**given: Any) -> RobotBench:
    """A bench whose robot has the monitor as if the package were installed."""

    class AsSet(Slipping):
        @classmethod
        def create(cls, _: Mapping[str, Any]) -> AnyMonitor:
            return super().create(given)

    return RobotBench(monitors={Slipping.issue: AsSet})


def slip(bench: RobotBench, speed_m_s: float, longest_m: float) -> None:
    """From the middle of step 5 on the object slides between the fingers."""
    slid_m = [0.0]

    def slide() -> None:
        progress = bench.robot.task_progress
        carrying = progress is not None and progress.step == 5 and progress.fraction > 0.2
        if carrying and bench.body.in_hand is not None and slid_m[0] < longest_m:
            name, relative = bench.body.in_hand
            moved = relative.copy()
            moved[2, 3] -= speed_m_s * bench.body.control_period_s
            slid_m[0] += speed_m_s * bench.body.control_period_s
            bench.body.in_hand = (name, moved)

    bench.body.at_cycle = slide


def test_its_entry_points_are_what_mend_loads() -> None:
    groups = tomllib.loads(PROJECT.read_text())["project"]["entry-points"]
    loaded = {
        group: {
            name: getattr(import_module(value.split(":")[0]), value.split(":")[1])
            for name, value in entries.items()
        }
        for group, entries in groups.items()
    }
    assert loaded == {
        "mend.monitors": {"slipping": Slipping},
        "mend.dialogues": {"slipping": script},
    }


def test_its_dialogue_is_sound() -> None:
    assert make_script("slipping", script, {}) is script


def test_a_slow_slide_is_slipping_and_interrupts_nothing() -> None:
    bench = bench_with_slipping()
    slip(bench, speed_m_s=0.06, longest_m=0.024)
    bench.start("pink_bar")
    bench.run()
    issue, *later = bench.of(IssueDetected)
    assert (issue.issue, issue.interrupts) == ("slipping", False)
    assert issue.step in (5, 6)
    assert {each.issue for each in later} <= {"undone"}, "placed so far off it is placed again"
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_a_firm_grasp_is_not_slipping() -> None:
    bench = bench_with_slipping()
    bench.start("pink_bar")
    bench.run()
    assert bench.of(IssueDetected) == []


def test_an_object_that_falls_is_still_dropped() -> None:
    bench = bench_with_slipping(pictures=8)
    bench.at(5, 0.4, lambda: bench.body.vanish("green_leg"))
    bench.start("green_leg")
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["dropped"]


@pytest.mark.parametrize("parameters", [{"limit_share": 0.0}, {"pictures": 0}, {"colour": "red"}])
def test_wrong_parameters_are_refused(parameters) -> None:
    with pytest.raises(ValueError, match=next(iter(parameters))):
        Slipping.create(parameters)
