"""Before the first step a grasp is chosen for which there is room, and refused in words if none."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from robot_bench import RobotBench
from scripted_body import GRIPPER, STARTS, ScriptedBody

from mend.robots.arm.behaviors.behavior import Move, SetGripper, Step
from mend.robots.arm.behaviors.errand import Errand
from mend.robots.arm.behaviors.grasp_choice import (
    MARGIN_M,
    clear_z,
    crowding,
    grips,
    others,
    roominess_m,
    ways_to_grasp,
)
from mend.robots.arm.behaviors.legs import held_boxes, legs_of
from mend.robots.arm.body import ToolPose
from mend.robots.arm.clearance import ROOM_M
from mend.robots.arm.grasp import grasp_of, half_turn
from mend.robots.arm.gripper import GripperModel
from mend.robots.catalogue import Part
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import IssueDetected, Location, Look, Looked
from mend.robots.vision.seen_box import SeenBox

PLATE = Part("plate", (0.10, 0.10, 0.012), knob=(0.03, 0.03, 0.04))
PART = Part("part", (0.03, 0.05, 0.05))
PICK, PLACE = ToolPose(0.5, -0.4, 0.725, 0.0), ToolPose(0.5, 0.0, 0.725, 0.0)
GRASP = grasp_of(PART, GRIPPER)
STEPS = (
    Step("pick", Move(PICK, 1.0, 0.05), Phase.APPROACH),
    Step("close", SetGripper("closed"), Phase.GRASP),
    Step("place", Move(PLACE, 1.0), Phase.PLACE),
    Step("open", SetGripper("open", 0.05), Phase.RELEASE),
    Step("leave", Move(PICK, 1.0, 0.05), Phase.RETREAT),
)
GRIPS = grips(STEPS, GRASP, GRIPPER)


def box(x: float, y: float, height_m: float = 0.05, name: str | None = "other") -> SeenBox:
    return SeenBox(x, y, 0.0, (0.03, 0.03, height_m), 0.7, name, complete=True)


class NarrowBody(ScriptedBody):
    """Its gripper takes hardly anything."""

    @property
    def gripper(self) -> GripperModel:
        return replace(GRIPPER, max_width_m=0.02)


def test_a_part_wider_than_the_gripper_is_never_taken() -> None:
    bench = RobotBench(body=NarrowBody(STARTS))
    bench.start("pink_bar")
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert (issue.issue, issue.step) == ("unreachable", 0)
    assert issue.detection is not None
    assert issue.detection.explanation == (
        "pink_bar is 30 mm wide at its narrower side; this gripper takes 12 to 20 mm"
    )


def test_a_part_wider_than_the_gripper_is_not_taken_from_a_person_either() -> None:
    bench = RobotBench(body=NarrowBody(STARTS))
    bench.send(Look(expect="in_gripper", object="pink_bar", within_s=5.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False


@pytest.mark.parametrize(
    ("at", "says"),
    [
        ((PICK.x + 0.04, PICK.y), "other leaves no room for the fingers to grasp it"),
        ((PLACE.x - 0.04, PLACE.y), "other leaves no room for the fingers at its place"),
        ((PICK.x, PICK.y + 0.04), None),
        ((0.7, 0.2), None),
    ],
)
def test_room_is_needed_where_the_fingers_close_and_open(
    at: tuple[float, float], says: str | None
) -> None:
    found = crowding(GRIPS, GRIPPER, [box(*at)])
    too_much = found is not None and found.room_m < MARGIN_M
    assert (str(found) if too_much else None) == says


def test_what_leaves_least_room_is_told() -> None:
    near, nearer = box(PICK.x + 0.054, PICK.y), box(PLACE.x - 0.052, PLACE.y, name="nearer")
    found = crowding(GRIPS, GRIPPER, [near, nearer])
    assert found is not None
    assert (found.by.name, found.at_place) == ("nearer", True)
    assert found.room_m == pytest.approx(0.002)


def test_only_what_fingers_close_beside_may_stand_nearer_than_is_said() -> None:
    rooms = []
    for at in (PICK.x + 0.054, PLACE.y), (PICK.x + 0.054, PICK.y):
        found = crowding(GRIPS, GRIPPER, [box(*at)], stray_m=0.003)
        assert found is not None
        rooms.append(found.room_m)
    assert rooms == pytest.approx([0.004, 0.001])


def test_more_room_is_better_until_there_is_enough() -> None:
    rooms = [
        roominess_m(crowding(GRIPS, GRIPPER, [box(PICK.x + 0.05 + room_m, PICK.y)]))
        for room_m in (0.0, 0.001, 0.003, 0.2)
    ]
    assert rooms == pytest.approx([0.0, 0.001, ROOM_M, ROOM_M])
    assert roominess_m(crowding(GRIPS, GRIPPER, [])) == ROOM_M


def test_what_is_carried_is_part_of_the_legs_between_closing_and_opening() -> None:
    grasp = grasp_of(PART, GRIPPER)
    legs = legs_of(STEPS, PART, grasp, GRIPPER, carrying=False)
    assert [(len(leg.held), leg.opening_m) for leg in legs] == [
        (0, 0.05),
        (1, grasp.width_m),
        (0, 0.05),
    ]
    carried = legs_of(STEPS[2:], PART, grasp, GRIPPER, carrying=True)
    assert [len(leg.held) for leg in carried] == [1, 0]


def test_a_held_part_hangs_where_it_was_grasped() -> None:
    grasp = grasp_of(PLATE, GRIPPER)
    plate, knob = held_boxes(PLATE, grasp)
    # The tool frame's x points down.
    assert plate.in_tool[0, 3] == pytest.approx(grasp.height_m - 0.006)
    assert knob.in_tool[0, 3] == pytest.approx(grasp.height_m - 0.032)
    assert all(small < big for small, big in zip(plate.size, PLATE.size, strict=True))


def test_the_part_itself_is_not_in_its_own_way() -> None:
    seen = [box(0.5, 0.0, name="plate"), box(0.6, 0.2, name="part"), box(0.4, 0.1, name=None)]
    assert [each.name for each in others(PART, seen)] == ["plate", None]


def test_only_what_stands_on_the_way_is_passed_over() -> None:
    found, target = Location(x=0.5, y=-0.5), Location(x=0.5, y=0.1)
    on_the_way, aside = box(0.55, -0.2, 0.2), box(0.9, -0.2, 0.3)
    assert clear_z(found, target, 0.7, [aside]) < 0.75
    assert clear_z(found, target, 0.7, [aside, on_the_way]) > on_the_way.top_z


@given(seen=st.floats(-1.57, 1.57), wanted=st.floats(-3.1, 3.1))
def test_a_square_part_is_tried_both_ways_round_the_nearer_first(
    seen: float, wanted: float
) -> None:
    peg = Part("peg", (0.03, 0.03, 0.05))
    first, *_, last = yaws_of(peg, seen, wanted)
    assert abs(math.remainder(first - wanted, math.pi)) <= math.pi / 4 + 1e-9
    assert math.remainder(first - seen, math.pi / 2) == pytest.approx(0.0, abs=1e-9)
    assert abs(math.remainder(last - first, math.pi)) == pytest.approx(math.pi / 2)


@given(seen=st.floats(-1.57, 1.57), wanted=st.floats(-3.1, 3.1))
def test_a_hardly_oblong_part_is_tried_as_it_is_seen_first(seen: float, wanted: float) -> None:
    first, *_, last = yaws_of(Part("peg", (0.013, 0.012, 0.05)), seen, wanted)
    assert first == pytest.approx(seen)
    assert abs(math.remainder(last - first, math.pi)) == pytest.approx(math.pi / 2)


@given(seen=st.floats(-1.57, 1.57), wanted=st.floats(-3.1, 3.1))
def test_any_other_part_lies_as_it_is_seen(seen: float, wanted: float) -> None:
    assert set(yaws_of(PART, seen, wanted)) == {half_turn(seen)}
    assert set(yaws_of(replace(PLATE, knob=(0.03, 0.04, 0.04)), seen, wanted)) == {half_turn(seen)}


def yaws_of(part: Part, seen: float, wanted: float) -> list[float]:
    """As what a part seen so may be grasped, in turn."""
    found, target = Location(x=0.5, y=-0.4, yaw=seen), Location(x=0.5, y=0.0, yaw=wanted)
    ways = ways_to_grasp(Errand(lambda _: STEPS, part, found, target), GRIPPER, 0.7, ())
    return [way.found.yaw for way in ways if way.found is not None]
