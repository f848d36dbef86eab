"""Whether a part may still be where it stood: what fills its room tells that it is not."""

import math
from dataclasses import replace

import pytest
from drawn_scene import PARTS, TABLE_Z, DrawnScene, Resting, on_its_side
from monitor_view import SEEN
from scripted_body import view_of

from mend.robots.arm.grasp import half_turn
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location
from mend.robots.vision.presence import Presence, is_at, judge_presence
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.part_boxes import Size

STOOD = Location(x=0.55, y=-0.2, z=TABLE_Z, yaw=0.0)
BEFORE_IT = ((0.40, -0.11, TABLE_Z), (0.05, 0.12, 0.25))
"""Hides more than half of where the green leg stood."""


def presence(**parts: Resting) -> Presence:
    view = view_of(DrawnScene(dict(parts), [BEFORE_IT]).picture())
    return judge_presence(view, PARTS["green_leg"], {"green_leg"}, STOOD, TABLE_Z)


def test_what_something_hides_may_be_there() -> None:
    assert presence() is Presence.HIDDEN


def test_what_lies_across_an_end_of_the_room_leaves_no_room_for_the_part() -> None:
    assert presence(yellow_bar=Resting(0.55, -0.275)) is Presence.GONE


def test_what_hardly_reaches_into_the_room_says_nothing() -> None:
    assert presence(yellow_bar=Resting(0.55, -0.31)) is Presence.HIDDEN


def test_a_part_beside_its_place_is_not_there_wherever_its_equals_are() -> None:
    view = view_of(DrawnScene({"green_leg": Resting(0.55, -0.172)}).picture())
    leg, equals = PARTS["green_leg"], {"green_leg", "leg_that_is_hidden"}
    assert judge_presence(view, leg, equals, STOOD, TABLE_Z) is Presence.GONE


@pytest.mark.parametrize(
    ("top_m", "told"), [(0.02, Presence.GONE), (0.30, Presence.HIDDEN), (0.40, Presence.HIDDEN)]
)
def test_what_is_under_something_unknown_is_not_seen(top_m: float, told: Presence) -> None:
    size = PARTS["green_leg"].size
    view = view_of(DrawnScene({}, [((0.55, -0.2, TABLE_Z), (*size[:2], 0.40))]).picture())
    cover = SeenBox(0.55, -0.2, 0.0, (0.12, 0.12, top_m), TABLE_Z, None, complete=True)
    view = replace(view, boxes=[cover])
    assert judge_presence(view, PARTS["green_leg"], {"green_leg"}, STOOD, TABLE_Z) is told


def test_what_lies_on_a_side_at_its_place_is_not_there() -> None:
    strip = Part("green_leg", (0.014, 0.154, 0.023))
    lying = on_its_side(strip, Resting(STOOD.x, STOOD.y), "y")
    scene = DrawnScene({"green_leg": lying}, built={"green_leg": strip})
    view = view_of(scene.picture(), {"green_leg": strip})
    assert not is_at(view.sightings["green_leg"], strip, STOOD, TABLE_Z)
    assert judge_presence(view, strip, {"green_leg"}, STOOD, TABLE_Z) is Presence.GONE


def is_at_with(size: Size, turned: float, *, x: float = 0.0, complete: bool = True) -> bool:
    seen = replace(SEEN, x=0.5 + x, y=0.0, z=TABLE_Z, yaw=half_turn(turned), complete=complete)
    return is_at(seen, Part("it", size), Location(x=0.5, y=0.0), TABLE_Z)


@pytest.mark.parametrize(
    ("size", "turned_deg", "there"),
    [
        ((0.06, 0.02, 0.03), 0, True),
        ((0.06, 0.02, 0.03), 25, True),
        ((0.06, 0.02, 0.03), 180, True),
        ((0.06, 0.02, 0.03), 90, False),
        ((0.03, 0.015, 0.03), 90, False),
        ((0.06, 0.06, 0.03), 90, True),
        ((0.06, 0.063, 0.03), -90, True),
        ((0.06, 0.06, 0.03), 45, False),
        ((0.03, 0.03, 0.03), 45, False),
        ((0.015, 0.015, 0.02), 45, True),
        ((0.4, 0.03, 0.03), 4, True),
        ((0.4, 0.03, 0.03), 8, False),
    ],
)
def test_a_part_is_at_its_place_only_if_it_is_turned_as_it_is_to_be(
    size: Size, turned_deg: float, *, there: bool
) -> None:
    assert is_at_with(size, math.radians(turned_deg)) is there


def test_a_part_whose_direction_may_be_wrong_is_at_its_place_wherever_its_corners_seem() -> None:
    assert is_at_with((0.06, 0.02, 0.03), math.pi / 2, complete=False)
    assert not is_at_with((0.06, 0.02, 0.03), 0.0, x=0.021, complete=False)


def test_a_part_turned_at_its_place_is_seen_not_to_be_there_as_it_should() -> None:
    leg = Resting(STOOD.x, STOOD.y, yaw=math.pi / 2)
    view = view_of(DrawnScene({"green_leg": leg}).picture())
    found = judge_presence(view, PARTS["green_leg"], {"green_leg"}, STOOD, TABLE_Z)
    assert found is Presence.GONE
