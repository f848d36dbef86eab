"""Whether a part may still be where it stood: what fills its room tells that it is not."""

from drawn_scene import PARTS, TABLE_Z, DrawnScene, Resting
from scripted_body import view_of

from robots.link.messages import Location
from robots.vision.presence import Presence, judge_presence

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
