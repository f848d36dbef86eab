"""Batteries drain, chargers and people fill them, and a robot asks before its own is empty."""

import json

import pytest
from building_bench import BuildingBench

from mend.robots.link.messages import Finished, IssueDetected, Look, Looked, Resume, StepStarted
from mend.sim.building.buildings import BUILDINGS
from mend.sim.building.robot_battery import CHARGER_W, DRIVE_J_PER_M, IDLE_W, RobotBattery
from mend.sim.world import WorldSetup
from mend.tasks.definition import BehaviorNode
from mend.tasks.intervention import Act, Intervention

ROBOT, HERE, THERE, CHARGER = "robot1", "F1-101", "F1-103", "F1-charger1"
PLUG_IN = Intervention(act=Act.CHARGE)


def drained(share: float, battery_wh: float = 20.0) -> BuildingBench:
    """A robot that has come to a room, and whose battery then holds this share."""
    bench = BuildingBench(battery_wh=battery_wh)
    bench.go(ROBOT, HERE)
    bench.run()
    hold(bench, share, battery_wh)
    return bench


def hold(bench: BuildingBench, share: float, battery_wh: float = 20.0) -> None:
    """Have its robot's battery hold this share."""
    battery = bench.world.batteries[0]
    left_j = share * battery_wh * 3600.0
    battery.restore(battery.snapshot().model_copy(update={"energy_j": left_j}))


def test_it_drains_with_time_and_metres_and_is_filled_at_a_charger() -> None:
    battery = RobotBattery(1.0)
    battery.pass_time(10.0, 5.0)
    spent_j = 10.0 * IDLE_W + 5.0 * DRIVE_J_PER_M
    assert battery.share == pytest.approx(1.0 - spent_j / 3600.0)
    battery.docked = True
    battery.pass_time(0.5, 0.0)
    assert battery.share == pytest.approx(1.0 - (spent_j - 0.5 * (CHARGER_W - IDLE_W)) / 3600.0)
    battery.pass_time(60.0, 0.0)
    assert battery.share == 1.0


def test_one_that_never_runs_out_is_always_full() -> None:
    battery = RobotBattery(0.0)
    battery.pass_time(1e6, 1e6)
    assert (battery.share, battery.empty, battery.charging) == (1.0, False, False)


def test_a_robot_with_little_left_asks_before_it_sets_out() -> None:
    bench = drained(0.1)
    bench.go(ROBOT, THERE)
    issue = bench.run_until(IssueDetected)
    assert (issue.issue, issue.step) == ("low_battery", 0)
    assert issue.detection is not None
    assert issue.detection.explanation == "my battery holds 10 %"


def test_who_is_plugged_in_feels_it_and_goes_on_once_it_holds_enough() -> None:
    bench = drained(0.1)
    bench.go(ROBOT, THERE)
    issue = bench.run_until(IssueDetected)
    bench.run()
    bench.send(ROBOT, Look(expect="charged", within_s=2.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False
    assert bench.world.intervene(PLUG_IN) == ""
    bench.send(ROBOT, Look(expect="charged", within_s=2.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled
    # It goes on a while later, and holds a little more by then than it asked for.
    hold(bench, 0.16)
    bench.send(ROBOT, Resume(execution=issue.execution))
    while bench.of(StepStarted)[-1].name != f"go to {THERE}":
        assert bench.group.advance(0.05)
    assert bench.world.batteries[0].share == pytest.approx(0.8, abs=0.01)
    bench.run()
    assert len(bench.of(Finished)) == 2
    assert not bench.world.batteries[0].plugged


def test_a_robot_with_little_left_still_drives_to_a_charger() -> None:
    bench = drained(0.12)
    bench.go(ROBOT, CHARGER, "charge")
    bench.run()
    assert len(bench.of(Finished)) == 2
    assert not bench.of(IssueDetected)
    assert bench.world.batteries[0].share >= 0.95


def test_where_no_current_comes_that_is_told() -> None:
    bench = drained(0.5)
    bench.go(ROBOT, HERE, "charge")
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "low_battery"
    assert issue.detection is not None
    assert issue.detection.explanation.startswith("no current comes here, and my battery holds")


def test_an_empty_battery_drives_nothing() -> None:
    bench = drained(0.5)
    bench.go(ROBOT, THERE)
    bench.group.advance(2.0)
    battery, robot = bench.world.batteries[0], bench.world.robots[0]
    battery.restore(battery.snapshot().model_copy(update={"energy_j": 0.0}))
    at = robot.at
    bench.run_until(IssueDetected)
    bench.run()
    assert (robot.at.x, robot.at.y) == (at.x, at.y)
    assert bench.of(IssueDetected)[-1].issue == "low_battery"


def test_nobody_plugs_in_who_needs_nothing() -> None:
    assert BuildingBench(battery_wh=20.0).world.intervene(PLUG_IN) == (
        "no robot that stands has little left in its battery"
    )


def test_a_building_is_rebuilt_with_its_batteries() -> None:
    bench = drained(0.1)
    bench.world.intervene(PLUG_IN)
    snapshot = json.loads(json.dumps(bench.group.snapshot()))
    options = {"localizer": "exact", "unmapped": 0.0, "battery_wh": 20.0}
    setup = WorldSetup(
        robots=[ROBOT], scene=bench.scene, seed=1, speed=None, snapshot=snapshot, options=options
    )
    assert BUILDINGS.create_agents(setup).snapshot() == snapshot


def test_a_place_without_a_charger_is_told() -> None:
    def told(place: str) -> list[str]:
        leaf = BehaviorNode(parent=None, name="c", behavior="charge", parameters={"place": place})
        return [e.message for e in BUILDINGS.check_scene(BuildingBench().scene, [leaf])]

    assert told(HERE) == [f"no charger is at '{HERE}', where a robot is to charge"]
    assert told(CHARGER) == []


@pytest.mark.parametrize("battery_wh", [20.0, 0.0])
def test_a_robot_says_what_its_battery_holds_unless_it_never_runs_out(battery_wh: float) -> None:
    bench = BuildingBench(battery_wh=battery_wh)
    (robot,) = bench.group.agents
    assert robot.poses().battery == (1.0 if battery_wh else None)
    bench.go(ROBOT, HERE)
    bench.run()
    share = bench.world.batteries[0].share
    assert robot.poses().battery == (share if battery_wh else None)
    assert (share < 1.0) is (battery_wh > 0.0)


def test_who_is_asked_by_one_robot_plugs_in_no_other_one() -> None:
    bench = BuildingBench(robots=2, battery_wh=20.0)
    for battery in bench.world.batteries:
        battery.restore(battery.snapshot().model_copy(update={"energy_j": 3600.0}))

    def plugged(robot: str) -> str:
        return bench.world.intervene(Intervention(act=Act.CHARGE, object=robot))

    assert plugged("robot2") == ""
    assert [each.plugged for each in bench.world.batteries] == [False, True]
    bench.world.batteries[1].restore(
        bench.world.batteries[1].snapshot().model_copy(update={"energy_j": 72000.0})
    )
    assert plugged("robot2") == "the robot does not stand with little left in its battery"
    assert plugged("robot9") == "there is no robot 'robot9'"
