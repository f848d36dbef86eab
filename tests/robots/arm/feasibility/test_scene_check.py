"""The check of a scene: each mistake in one sentence at its place, and nothing about what works."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mend.robots.arm.body import Leg, NoWay
from mend.robots.arm.feasibility.check import check_scene
from mend.robots.arm.gripper import GripperModel
from mend.robots.vision.seen_box import SeenBox
from mend.robots.vision.viewpoint import Viewpoint
from mend.sim.workcell.gripper import PR2_GRIPPER
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scene import Place, Pose, Scatter, Scene, SceneObject
from mend.tasks.scene_problem import SceneProblem

REACH_M = 0.74
EYE = (0.5, 0.0, 2.5)
SHY_OF_M, SHY_WITHIN_M = 0.25, 0.15


@dataclass(frozen=True)
class MadeUpPath:
    segments: int


@dataclass(frozen=True)
class MadeUpArm:
    """A stand-in for an arm: it reaches a circle around its shoulder, and keeps
    `SHY_WITHIN_M` away from what is as tall as `SHY_OF_M`.
    """

    gripper: GripperModel = PR2_GRIPPER

    def plan_among(self, legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> MadeUpPath | NoWay:
        if any(math.hypot(leg.to.x, leg.to.y + 0.19) > REACH_M for leg in legs):
            return NoWay("does not reach")
        tall = [box for box in boxes if box.size[2] >= SHY_OF_M and box.name != "the table"]
        for leg, box in product(legs, tall):
            if math.hypot(leg.to.x - box.x, leg.to.y - box.y) < SHY_WITHIN_M:
                return NoWay(f"would touch {box.name}", box)
        return MadeUpPath(len(legs))


def box(x: float, y: float, size=(0.03, 0.05, 0.05), **more: Any) -> SceneObject:
    pose = Pose(x=x, y=y, z=more.pop("z", None), yaw=more.pop("yaw", 0.0))
    return SceneObject(color=(0.9, 0.0, 0.0), size=size, pose=pose, **more)


def scene(objects: dict[str, SceneObject], **places: Pose) -> Scene:
    return Scene(
        name="made_up",
        objects=objects,
        places={name: Place(pose=pose) for name, pose in places.items()},
    )


def leaf(name: str, place: str, parent: int | None = 0) -> BehaviorNode:
    return BehaviorNode(
        parent=parent,
        name=f"{name}_to_{place}",
        behavior="pick_and_place",
        parameters={"object": name, "place": place},
    )


def goal(kind: str) -> GoalNode:
    return GoalNode(kind=kind, parent=None, name="root")


def looking_down(eye: tuple[float, float, float], focal_px: float = 200.0) -> Viewpoint:
    """A camera that looks straight down; in its picture x goes to the right and y up."""
    pose = np.diag([1.0, -1.0, -1.0, 1.0])
    pose[:3, 3] = eye
    return Viewpoint(pose, (640, 480), focal_px, (319.5, 239.5))


def problems_of(made: Scene, *nodes: GoalNode | BehaviorNode) -> list[SceneProblem]:
    return check_scene(made, nodes, MadeUpArm(), looking_down(EYE))


FREE = Pose(x=0.5, y=0.05)


@pytest.mark.parametrize(
    ("part", "where", "says"),
    [
        (box(0.5, -0.4, (0.09, 0.10, 0.05)), "size", "is 90 mm wide at its narrower side"),
        (box(0.5, -0.4, (0.006, 0.09, 0.05)), "size", "is only 6 mm wide"),
        (box(0.5, -0.4, (0.03, 0.05, 0.008)), "size", "is 8 mm high"),
        (box(0.5, -0.4, (0.45, 0.05, 0.05), yaw=1.57), "size", "is 450 mm long"),
        (box(0.5, -0.4, (0.06, 0.06, 0.26)), "size", "is 260 mm high"),
        (box(0.5, -0.4, mass_kg=0.9), "mass_kg", "weighs 0.90 kg"),
        (
            box(0.5, -0.4, (0.2, 0.2, 0.02), knob=(0.09, 0.1, 0.03)),
            "knob",
            "knob of part is 90",
        ),
        (box(0.5, -0.4, (0.2, 0.2, 0.02), knob=(0.03, 0.03, 0.006)), "knob", "is 6 mm high"),
        (box(0.2, -0.4), "pose", "is beyond the table"),
        (box(0.36, -0.4), "pose", "reaches over the edge"),
        (box(0.5, -0.4, z=0.75), "pose", "is in the air"),
        (box(0.5, -0.4, z=0.65), "pose", "is below the table"),
        (box(0.75, -0.5), "pose", "the arm does not reach (0.750, -0.500, 0.700)"),
    ],
)
def test_a_part_that_cannot_be_taken_is_told_of_where_it_is(
    part: SceneObject, where: str, says: str
) -> None:
    made = scene({"part": part}, target=FREE)
    (found,) = problems_of(made, leaf("part", "target", None))
    assert found.where == ("objects", "part", where)
    assert says in found.message


@pytest.mark.parametrize(
    ("at", "says"),
    [
        (Pose(x=1.2, y=0.0), "is beyond the table"),
        (Pose(x=1.04, y=0.0), "reaches over the edge"),
        (Pose(x=0.5, y=0.05, z=0.80), "is in the air"),
        (Pose(x=0.8, y=0.1), "the arm does not reach"),
        (Pose(x=0.5, y=-0.25), "the place of part is where other stands"),
        (Pose(x=0.5, y=-0.25, z=0.77), "the nearest top there is that of other, at z 0.750"),
        (Pose(x=0.5, y=-0.215, z=0.75), "would tip off other"),
    ],
)
def test_a_place_that_cannot_be_filled_is_told_of(at: Pose, says: str) -> None:
    made = scene({"part": box(0.5, -0.5), "other": box(0.5, -0.25)}, target=at)
    (found,) = problems_of(made, leaf("part", "target", None))
    assert found.where == ("places", "target", "pose")
    assert says in found.message


def test_what_hardly_tips_over_is_not_said_to_stand_as_firmly_as_it_has_to() -> None:
    made = scene({"part": box(0.5, -0.4, (0.021, 0.05, 0.157))}, target=FREE)
    found = problems_of(made, leaf("part", "target", None))
    says = "as soon as it leans by 7 degrees, and has to stand leaning by 8 degrees"
    assert [says in each.message for each in found] == [True, True]


def wall(x: float, y: float) -> SceneObject:
    """So tall and long that nothing can be grasped right beside it."""
    return box(x, y, (0.2, 0.05, 0.12))


def test_a_place_right_beside_something_tall_is_told_of() -> None:
    made = scene({"part": box(0.5, -0.5), "wall": wall(0.5, -0.25)}, target=Pose(x=0.5, y=-0.199))
    (found,) = problems_of(made, leaf("part", "target", None))
    assert found.where == ("places", "target", "pose")
    assert "wall is too close to the place of part" in found.message


def test_two_parts_in_one_spot_are_told_of() -> None:
    made = scene({"one": box(0.5, -0.4), "two": box(0.51, -0.41)}, target=FREE)
    (found,) = problems_of(made, leaf("one", "target", None))
    assert found.where == ("objects", "two", "pose")
    assert "start in one spot" in found.message


def test_a_part_wide_both_ways_beside_another_is_told_how_far_to_move_it() -> None:
    def beside(y: float) -> list[SceneProblem]:
        parts = {"one": box(0.5, -0.4, (0.05, 0.03, 0.05)), "two": box(0.5, y, (0.2, 0.03, 0.08))}
        return problems_of(scene(parts, target=FREE), leaf("one", "target", None))

    (found,) = beside(-0.365)
    assert "two is too close to one" in found.message
    assert beside(-0.30) == []


def test_places_inside_each_other_matter_unless_only_one_of_them_is_filled() -> None:
    made = scene(
        {"one": box(0.5, -0.5), "two": box(0.5, -0.35)}, left=FREE, right=Pose(x=0.51, y=0.06)
    )
    leaves = leaf("one", "left"), leaf("two", "right")
    (found,) = problems_of(made, goal("and"), *leaves)
    assert "would be inside each other" in found.message
    assert problems_of(made, goal("or"), *leaves) == []


def test_what_is_taken_away_before_is_in_nobodys_way() -> None:
    made = scene(
        {"one": box(0.5, -0.5), "two": wall(0.5, -0.3)},
        left=Pose(x=0.5, y=-0.249),
        right=FREE,
    )
    one, two = leaf("one", "left"), leaf("two", "right")
    (found,) = problems_of(made, goal("and"), two, one)
    assert "two is too close to the place of one" in found.message
    assert problems_of(made, goal("then"), two, one) == []


def test_a_tower_is_possible_and_so_is_a_part_on_four_legs() -> None:
    small = (0.03, 0.03, 0.04)
    parts = {
        f"leg_{n}": box(0.40 + 0.09 * (n % 2), -0.6 + 0.09 * (n // 2), small) for n in range(4)
    }
    parts["top"] = box(0.6, -0.4, (0.14, 0.14, 0.012), knob=(0.03, 0.03, 0.035))
    places = {f"leg_{n}": Pose(x=0.45 + 0.1 * (n % 2), y=-0.1 + 0.1 * (n // 2)) for n in range(4)}
    places["top"] = Pose(x=0.5, y=-0.05, z=0.74)
    made = scene(parts, **places)
    leaves = [leaf(name, name) for name in parts]
    assert problems_of(made, goal("then"), *leaves) == []
    without_two = [goal("then"), *leaves[:2], leaves[4]]
    assert any("would tip off" in each.message for each in problems_of(made, *without_two))


def beside_a_wall(away_m: float, scatter: Scatter, parts: int = 1) -> Scene:
    """Boxes, each with something tall at one side."""
    objects = {}
    for number in range(parts):
        y = -0.45 + 0.3 * number
        objects[f"part_{number}"] = box(0.5, y)
        objects[f"wall_{number}"] = box(0.5 + away_m + 0.01 * number, y, (0.02, 0.2, 0.12))
    made = scene(objects, target=Pose(x=0.45, y=0.15))
    return made.model_copy(update={"scatter": scatter})


def test_scatter_needs_its_room_too() -> None:
    take = leaf("part_0", "target", None)
    assert problems_of(beside_a_wall(0.06, Scatter()), take) == []
    (found,) = problems_of(beside_a_wall(0.06, Scatter(xy=0.02)), take)
    assert found.where == ("scatter", "xy")
    assert found.message == (
        "a scatter of 20 mm may put part_0 where the arm cannot take it: make it smaller (part_0 "
        "could be taken with 11 mm), or move part_0, which is at (0.500, -0.450)"
    )
    assert problems_of(beside_a_wall(0.06, Scatter(xy=0.011)), take) == []


def test_what_only_turning_puts_out_of_reach_is_told_as_that() -> None:
    take = leaf("part_0", "target", None)
    (found,) = problems_of(beside_a_wall(0.06, Scatter(yaw=0.3)), take)
    assert found.where == ("scatter", "yaw")
    assert "a scatter of 0.3 rad may turn part_0 where the arm cannot take it" in found.message


def test_all_parts_that_scatter_puts_out_of_reach_are_told_with_what_fits_all() -> None:
    take = [leaf(f"part_{n}", "target", None) for n in range(2)]
    (found,) = problems_of(beside_a_wall(0.06, Scatter(xy=0.02), parts=2), *take)
    assert found.where == ("scatter", "xy")
    told = re.search(
        r"part_0 could be taken with (\d+) mm, part_1 could be taken with (\d+) mm; all of them "
        r"with (\d+) mm",
        found.message,
    )
    assert told is not None
    first, second, both = map(int, told.groups())
    assert both <= min(first, second)
    assert problems_of(beside_a_wall(0.06, Scatter(xy=1e-3 * both), parts=2), *take) == []


def test_what_is_drawn_too_near_is_drawn_anew_and_bars_nothing() -> None:
    made = scene({"one": box(0.5, -0.4), "two": wall(0.5, -0.34)}, target=FREE)
    scattered = made.model_copy(update={"scatter": Scatter(xy=0.02)})
    assert problems_of(scattered, leaf("one", "target", None)) == []


def test_no_scatter_puts_a_part_over_the_edge() -> None:
    near = scene({"one": box(0.40, -0.2, (0.04, 0.04, 0.05))}, target=FREE)
    inside = near.model_copy(update={"scatter": Scatter(xy=0.04)})
    beyond = near.model_copy(update={"scatter": Scatter(xy=0.041)})
    turned = near.model_copy(update={"scatter": Scatter(xy=0.04, yaw=0.3)})
    assert problems_of(inside, leaf("one", "target", None)) == []
    for strewn in (beyond, turned):
        found = problems_of(strewn, leaf("one", "target", None))[0]
        assert found.where == ("scatter", "xy")
        assert "may put one, at (0.400, -0.200), over the edge of the table" in found.message


def test_no_scatter_puts_a_part_off_the_one_on_which_it_starts() -> None:
    slab = (0.05, 0.05, 0.04)
    pile = {"low": box(0.6, -0.2, slab), "high": box(0.6, -0.2, slab, z=0.74)}
    made = scene(pile, low=FREE, high=Pose(x=0.5, y=-0.05))
    leaves = [goal("then"), leaf("high", "high"), leaf("low", "low")]
    little = made.model_copy(update={"scatter": Scatter(xy=0.003)})
    assert problems_of(made, *leaves) == problems_of(little, *leaves) == []
    found = problems_of(made.model_copy(update={"scatter": Scatter(xy=0.02)}), *leaves)[0]
    assert found.where == ("scatter", "xy")
    assert "may put high off low, on which it starts" in found.message


def test_too_large_a_scatter_is_told_once_for_each_reason_and_not_as_out_of_reach() -> None:
    parts = {f"part_{n}": box(0.5, -0.5 + 0.2 * n) for n in range(2)}
    made = scene(parts, target=FREE)
    scattered = made.model_copy(update={"scatter": Scatter(xy=0.4)})
    leaves = [leaf(name, "target", None) for name in parts]
    assert problems_of(made, leaves[0]) == []
    found, also = problems_of(scattered, *leaves)
    assert found.where == ("scatter", "xy")
    assert "a scatter of 400 mm may put part_0, at (0.500, -0.500), over the edge" in found.message
    assert also.where == ("scatter", "xy")
    assert "may put 2 parts where the arm cannot take them" in also.message


@given(
    x=st.floats(0.44, 0.60),
    y=st.floats(-0.5, -0.3),
    yaw=st.floats(-3.1, 3.1),
    width=st.floats(0.012, 0.078),
    length=st.floats(0.012, 0.15),
    height=st.floats(0.020, 0.12),
)
def test_every_part_within_the_limits_that_stands_alone_is_possible(
    x: float, y: float, yaw: float, width: float, length: float, height: float
) -> None:
    assume(height <= 7 * min(width, length))
    made = scene({"part": box(x, y, (width, length, height), yaw=yaw)}, target=FREE)
    assert problems_of(made, leaf("part", "target", None)) == []


def test_what_may_be_placed_before_is_in_the_way_of_the_fingers() -> None:
    made = scene(
        {"one": box(0.5, -0.5), "tall": wall(0.5, -0.3)}, left=FREE, right=Pose(x=0.5, y=-0.449)
    )
    one, tall = leaf("one", "left"), leaf("tall", "right")
    (found,) = problems_of(made, goal("and"), one, tall)
    assert "tall is too close to one" in found.message
    assert problems_of(made, goal("then"), one, tall) == []


@pytest.mark.parametrize(("height_m", "possible"), [(0.032, True), (0.0345, False)])
def test_what_open_fingers_pass_over_must_not_be_met_as_they_close(
    height_m: float, possible: bool
) -> None:
    """35 mm above the table the closed tips end, 1 to 3 mm lower than open ones."""
    parts = {"peg": box(0.5, -0.4, (0.021, 0.021, 0.049))}
    for number, (dx, dy) in enumerate([(1, 0), (-1, 0), (0, 1), (0, -1)]):
        low = (0.03, 0.03, height_m)
        parts[f"low_{number}"] = box(0.5 + 0.03 * dx, -0.4 + 0.03 * dy, low)
    found = problems_of(scene(parts, target=FREE), leaf("peg", "target", None))
    tight = [each for each in found if "for the fingers" in each.message]
    assert (tight == []) is possible
    assert all("is too close to peg" in each.message for each in tight)


def test_a_height_that_is_given_hardly_too_low_takes_the_fingers_no_room() -> None:
    parts = {"base": box(0.5, -0.4, (0.1, 0.1, 0.02))}
    parts["low"] = box(0.5, -0.4, (0.03, 0.03, 0.02), z=0.715)
    assert problems_of(scene(parts, target=FREE), leaf("low", "target", None)) == []


def pillar(x: float, y: float) -> SceneObject:
    """So tall that the arm keeps away from it."""
    return box(x, y, (0.05, 0.05, 0.25))


ASIDE, FAR = Pose(x=0.45, y=-0.2), Pose(x=0.6, y=0.2)


@pytest.mark.parametrize(
    ("at", "where", "says"),
    [
        (
            (0.5, -0.4),
            ("objects", "part", "pose"),
            "pillar stands in the arm's way to part: move one of them",
        ),
        (
            (0.5, 0.15),
            ("places", "target", "pose"),
            "pillar stands in the arm's way to the place of part: move one of them",
        ),
    ],
)
def test_what_bars_the_arms_way_is_told_of(
    at: tuple[float, float], where: tuple[str, ...], says: str
) -> None:
    made = scene({"part": box(0.5, -0.5), "pillar": pillar(*at)}, target=FREE)
    (found,) = problems_of(made, leaf("part", "target", None))
    assert (found.where, found.message) == (where, says)


def test_what_bars_the_way_may_be_taken_away_first() -> None:
    made = scene({"part": box(0.5, -0.5), "pillar": pillar(0.5, -0.4)}, target=FREE, far=FAR)
    part, taken = leaf("part", "target"), leaf("pillar", "far")
    (found,) = problems_of(made, goal("and"), part, taken)
    assert found.message == (
        "pillar stands in the arm's way to part: move one of them, or let pillar be placed before "
        "part"
    )
    assert problems_of(made, goal("then"), taken, part) == []


def test_what_will_bar_the_way_may_be_placed_later() -> None:
    made = scene(
        {"part": box(0.5, -0.5), "pillar": pillar(0.45, -0.05)},
        target=Pose(x=0.5, y=0.2),
        post=Pose(x=0.5, y=0.1),
    )
    part, put = leaf("part", "target"), leaf("pillar", "post")
    (found,) = problems_of(made, goal("and"), part, put)
    assert found.where == ("places", "target", "pose")
    assert found.message == (
        "pillar would stand in the arm's way to the place of part: move one of them, or let part "
        "be placed before pillar"
    )
    assert problems_of(made, goal("then"), part, put) == []


def test_things_that_never_stand_there_together_bar_no_way() -> None:
    """Each way to grasp the part is barred at some time, but never all of them at once."""
    wide = box(0.5, -0.4, (0.05, 0.05, 0.05))
    across, along = (0.02, 0.2, 0.12), (0.2, 0.02, 0.12)
    made = scene(
        {"part": wide, "wall": box(0.5, -0.37 + 0.03, along)},
        target=FREE,
        beside=Pose(x=0.56, y=-0.4, yaw=math.pi / 2),
    )
    part, moved = leaf("part", "target"), leaf("wall", "beside")
    assert problems_of(made, goal("and"), part, moved) == []
    both = {**made.objects, "second": box(0.56, -0.4, across)}
    stuck = made.model_copy(update={"objects": both})
    assert any("too close" in each.message for each in problems_of(stuck, goal("and"), part))


def test_only_one_alternative_of_two_is_in_the_way() -> None:
    made = scene(
        {"part": box(0.5, -0.5), "pillar": pillar(0.45, -0.05)},
        target=Pose(x=0.5, y=0.2),
        post=Pose(x=0.5, y=0.1),
    )
    nodes = [goal("or"), leaf("part", "target"), leaf("pillar", "post")]
    assert problems_of(made, *nodes) == []


@pytest.mark.parametrize(
    ("gap_m", "height_m", "told"),
    [(0.0, 0.05, True), (0.004, 0.05, True), (0.006, 0.05, False), (0.0, 0.06, False)],
)
def test_what_would_be_one_surface_to_the_cameras_is_told(
    gap_m: float, height_m: float, told: bool
) -> None:
    size = (0.03, 0.05, 0.05)
    parts = {
        "one": box(0.5, -0.4, size),
        "other": box(0.5, -0.4 + 0.05 + gap_m, (0.03, 0.05, height_m)),
    }
    found = [each.message for each in problems_of(scene(parts)) if "tell" in each.message]
    assert (len(found) == 1) is told
    # Where one stands by then goes by the tree.
    made = scene(
        {"one": parts["one"], "other": box(0.5, 0.0, size)},
        beside=Pose(x=0.5, y=-0.35 + gap_m),
        away=Pose(x=0.6, y=0.2),
    )
    leaves = leaf("one", "away"), leaf("other", "beside")
    first_away = problems_of(made, goal("then"), *leaves)
    open_order = problems_of(made, goal("and"), *leaves)
    assert not any("tell" in each.message for each in first_away)
    assert any("tell" in each.message for each in open_order) is (gap_m < 0.005)


def test_what_hides_a_part_from_the_head_camera_is_told_unless_it_is_taken_away_before() -> None:
    head = looking_down((0.2, 0.0, 1.5))
    parts = {"low": box(0.6, 0.0, (0.03, 0.03, 0.03)), "hider": box(0.5, 0.0, (0.05, 0.08, 0.24))}
    made = scene(parts, target=ASIDE, far=FAR)
    low, taken = leaf("low", "target"), leaf("hider", "far")

    def told(*nodes: GoalNode | BehaviorNode) -> list[str]:
        return [each.message for each in check_scene(made, nodes, MadeUpArm(), head)]

    assert told(goal("then"), low) == ["hider hides low from the head camera: move one of them"]
    assert told(goal("then"), low, taken) == [
        "hider hides low from the head camera: move one of them, or let hider be placed before low"
    ]
    assert told(goal("then"), taken, low) == []
    # In an open order the robot takes what it sees first.
    assert told(goal("and"), low, taken) == []


@pytest.mark.parametrize(("side_m", "told"), [(0.012, True), (0.03, False)])
def test_of_a_small_top_the_head_camera_has_to_see_nearly_all(side_m: float, told: bool) -> None:
    head = looking_down((0.2, 0.0, 1.5))
    parts = {
        "low": box(0.6, 0.0, (side_m, side_m, 0.03)),
        "hider": box(0.5, 0.05 + side_m / 6, (0.05, 0.1, 0.24)),
    }
    made = scene(parts, target=ASIDE)
    problems = check_scene(made, [leaf("low", "target")], MadeUpArm(), head)
    assert any("hides" in each.message for each in problems) is told


@pytest.mark.parametrize(
    ("start_y", "place_y", "height_m", "scatter", "told"),
    [
        (0.0, 0.1, 0.05, Scatter(), None),
        # Half of the picture is 0.3 m at 1 m below the camera, 0.24 m at 0.8 m.
        (0.26, 0.1, 0.05, Scatter(), None),
        (0.26, 0.1, 0.20, Scatter(), "where it starts"),
        (0.0, 0.26, 0.20, Scatter(), "at its place"),
        (0.29, 0.1, 0.05, Scatter(), "where it starts"),
        (0.26, 0.1, 0.05, Scatter(xy=0.03), "scattered"),
        (0.255, 0.1, 0.05, Scatter(yaw=1.57), "where it starts"),
        (0.0, 0.26, 0.05, Scatter(xy=0.03, yaw=1.57), None),
    ],
)
def test_what_the_head_cameras_picture_does_not_hold_is_told(
    start_y: float, place_y: float, height_m: float, scatter: Scatter, told: str | None
) -> None:
    head = looking_down((0.5, 0.0, 1.7), focal_px=800.0)
    part = box(0.45, start_y, size=(0.06, 0.03, height_m))
    made = scene({"part": part}, target=Pose(x=0.5, y=place_y)).model_copy(
        update={"scatter": scatter}
    )
    problems = check_scene(made, [leaf("part", "target")], MadeUpArm(), head)
    sentence = (
        f"the head camera's picture does not hold all of part {told}: move it towards the middle "
        "of the table"
    )
    if told == "scattered":
        sentence = (
            "a scatter of 30 mm may put part where the head camera's picture does not hold all of "
            "it: make it smaller, or move part towards the middle of the table"
        )
    assert [each.message for each in problems] == ([sentence] if told else [])


def test_of_a_scene_by_itself_is_told_what_no_order_could_mend() -> None:
    head = looking_down((0.2, 0.0, 1.5))
    low, hider = box(0.6, 0.0, (0.03, 0.03, 0.03)), box(0.5, 0.0, (0.05, 0.08, 0.24))
    too_heavy = hider.model_copy(update={"mass_kg": 3.0})

    def told(objects: dict[str, SceneObject]) -> list[str]:
        return [each.message for each in check_scene(scene(objects), [], MadeUpArm(), head)]

    assert told({"low": low, "hider": hider}) == []
    of_hider, of_low = told({"low": low, "hider": too_heavy})
    assert of_hider.startswith("hider weighs")
    assert of_low == "hider hides low from the head camera: move one of them"


def test_by_itself_a_scene_may_have_a_place_on_what_a_task_brings_to_another_place() -> None:
    parts = {
        "pillar_1": box(0.45, -0.5, (0.03, 0.03, 0.06)),
        "pillar_2": box(0.50, -0.04, (0.03, 0.03, 0.06)),
        "lintel": box(0.6, -0.4, (0.03, 0.18, 0.02)),
        "statue": box(0.45, -0.35, (0.02, 0.02, 0.04)),
    }
    places = {
        "right": Pose(x=0.5, y=-0.04),
        "left": Pose(x=0.5, y=0.1),
        "lintel": Pose(x=0.5, y=0.03, z=0.76),
        "statue": Pose(x=0.5, y=0.03, z=0.78),
    }
    assert problems_of(scene(parts, **places)) == []
    too_high = {**places, "lintel": Pose(x=0.5, y=0.03, z=0.79)}
    told = {each.where: each.message for each in problems_of(scene(parts, **too_high))}
    assert "the nearest top there is that of pillar_" in told["places", "lintel", "pose"]


def test_where_the_order_is_open_the_then_that_would_do_is_told() -> None:
    made = scene(
        {"one": box(0.5, -0.5), "two": wall(0.5, -0.3)}, left=Pose(x=0.5, y=-0.249), right=FREE
    )
    one, two = leaf("one", "left"), leaf("two", "right")
    (found,) = problems_of(made, goal("and"), one, two)
    assert found.message.endswith("further apart, or put 'two' before 'one' in a THEN")
    made = scene(
        {"one": box(0.5, -0.5), "two": wall(0.5, -0.3)},
        left=Pose(x=0.5, y=0.101),
        right=Pose(x=0.5, y=0.05),
    )
    (found,) = problems_of(made, goal("and"), one, two)
    assert found.message.endswith(", or put 'one' before 'two' in a THEN")
    assert problems_of(made, goal("then"), one, two) == []
