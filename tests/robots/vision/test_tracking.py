"""What earlier pictures say: a part of which only a corner is left to be seen stands as it did."""

import math
from dataclasses import replace

import pytest
from drawn_scene import PARTS, TABLE_Z, DrawnScene, Resting
from scripted_body import trained_model

from mend.robots.vision.head import HeadSighting
from mend.robots.vision.table_view import view_table
from mend.robots.vision.tracking import LastSeen
from mend.tasks.scene import Table

LEG = Resting(0.50, -0.20, TABLE_Z)


def see(scene: DrawnScene, earlier: LastSeen) -> HeadSighting:
    parts = {"green_leg": PARTS["green_leg"]}
    view = view_table(scene.picture(), Table(), parts, trained_model(), earlier)
    assert view is not None
    return view.sightings["green_leg"]


def covered(leg: Resting) -> DrawnScene:
    """Only a corner of the leg is not under a grey box."""
    middle = (leg.x + 0.01, leg.y + 0.02, TABLE_Z + PARTS["green_leg"].height)
    return DrawnScene({"green_leg": leg}, grey_boxes=[(middle, (0.06, 0.20, 0.05))], noise=3.0)


def off_m(seen: HeadSighting, leg: Resting) -> float:
    return math.hypot(seen.x - leg.x, seen.y - leg.y)


@pytest.fixture
def earlier() -> LastSeen:
    last_seen = LastSeen()
    whole = see(DrawnScene({"green_leg": LEG}, noise=3.0), last_seen)
    assert whole.complete
    last_seen.note_sighting("green_leg", whole)
    return last_seen


def test_what_is_almost_hidden_stands_as_it_did(earlier: LastSeen) -> None:
    now = see(covered(LEG), earlier)
    assert not now.complete
    assert off_m(now, LEG) < 0.002
    assert abs(math.remainder(now.yaw - LEG.yaw, math.pi)) < 0.05
    # The corner alone does not tell.
    assert off_m(see(covered(LEG), LastSeen()), LEG) > 0.05


@pytest.mark.parametrize(("dx", "dy"), [(0.0, -0.12), (0.15, 0.0)])
def test_what_was_moved_is_not_where_it_was(earlier: LastSeen, dx: float, dy: float) -> None:
    moved = replace(LEG, x=LEG.x + dx, y=LEG.y + dy)
    assert off_m(see(DrawnScene({"green_leg": moved}, noise=3.0), earlier), moved) < 0.002
    assert off_m(see(covered(moved), earlier), LEG) > 0.05
