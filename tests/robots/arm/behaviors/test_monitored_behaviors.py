"""Which monitors watch a behavior that another package adds."""

from collections.abc import Sequence
from typing import ClassVar

import pytest
from robot_bench import RobotBench

from mend.documents.strict_model import StrictModel
from mend.robots.arm.behaviors import ArmBehavior, Move, SetGripper, Situation, Step
from mend.robots.arm.behaviors.pick_and_place import PickAndPlace
from mend.robots.arm.body import ToolPose
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Finished, Interrupt, IssueDetected, Start, StepStarted
from mend.tasks.scene import Name


class PushParameters(StrictModel):
    object: Name


class Push(ArmBehavior):
    """Pushes its object with an empty, closed gripper."""

    name: ClassVar[str] = "push"
    parameters: ClassVar[type[StrictModel]] = PushParameters

    def steps(self, parameters: StrictModel, situation: Situation) -> Sequence[Step]:  # noqa: ARG002
        assert situation.found is not None
        x, y = situation.found.x, situation.found.y
        z = situation.table_z + 0.03
        before, after = ToolPose(x - 0.08, y, z, 0.0), ToolPose(x - 0.03, y, z, 0.0)
        return (
            Step("close gripper", SetGripper("closed"), Phase.APPROACH),
            Step("beside", Move(before, speed=0.5), Phase.APPROACH),
            Step("push", Move(after, speed=0.3), Phase.CARRY),
            Step("back", Move(before, speed=0.5), Phase.RETREAT),
        )


class PushWatchedAsPicking(Push):
    """Asks for the monitors of `pick_and_place`, though it never grasps."""

    name: ClassVar[str] = "careless_push"
    monitored_as: ClassVar[str] = "pick_and_place"


def bench_with(kind: type[ArmBehavior]) -> RobotBench:
    return RobotBench(behaviors={kind.name: kind})


def start(bench: RobotBench, kind: type[ArmBehavior]) -> None:
    parameters = {"object": "pink_bar"}
    bench.send(Start(execution="e1", node="/0", behavior=kind.name, parameters=parameters))


@pytest.mark.parametrize("kind", [Push, PushWatchedAsPicking])
def test_a_push_with_an_empty_gripper_has_missed_nothing(kind: type[ArmBehavior]) -> None:
    bench = bench_with(kind)
    start(bench, kind)
    bench.run()
    assert [each.step for each in bench.of(StepStarted)] == [1, 2, 3, 4]
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_what_a_push_feels_is_no_blocked_way() -> None:
    bench = bench_with(Push)
    bench.body.force_n = 120.0
    start(bench, Push)
    bench.run()
    assert bench.of(IssueDetected) == []


def test_nothing_can_be_pushed_that_is_not_there() -> None:
    bench = bench_with(Push)
    bench.body.vanish("pink_bar")
    start(bench, Push)
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["missing"]


def test_what_is_held_is_put_down_before_a_behavior_that_cannot_go_on_with_it() -> None:
    class PushWithoutCarrying(Push):
        name: ClassVar[str] = "push_on"

        def steps(self, parameters: StrictModel, situation: Situation) -> Sequence[Step]:
            if situation.found is None:
                return ()
            laid_out = super().steps(parameters, situation)
            return [each for each in laid_out if each.phase is not Phase.CARRY]

    bench = bench_with(PushWithoutCarrying)
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    bench.send(Interrupt(retreat=False))
    start(bench, PushWithoutCarrying)
    bench.run()
    assert bench.body.in_hand is None
    assert bench.of(IssueDetected) == []


def test_a_behavior_is_monitored_by_its_own_name_unless_it_says_otherwise() -> None:
    class LikePicking(PickAndPlace):
        name: ClassVar[str] = "pick_gently"

    assert Push.monitored_as == "push"
    assert PushWatchedAsPicking.monitored_as == "pick_and_place"
    assert LikePicking.monitored_as == "pick_and_place"


def test_going_on_begins_with_the_first_step_that_carries_unless_the_behavior_says() -> None:
    class CarriesFromTwo(Push):
        name: ClassVar[str] = "push_from_two"
        carry_from: ClassVar[int | None] = 2

    pose = ToolPose(0.5, 0.0, 1.0, 0.0)
    steps = [
        Step(phase.value, Move(pose, 1.0), phase)
        for phase in (Phase.APPROACH, Phase.LIFT, Phase.CARRY, Phase.CARRY)
    ]
    assert Push().first_carrying(steps) == 3
    assert Push().first_carrying(steps[:2]) is None
    assert CarriesFromTwo().first_carrying(steps) == 2
