"""Whether a place is free: what is in the room for a part is seen, its neighbours are let be."""

import numpy as np
import pytest
from drawn_scene import PARTS, TABLE_Z, DrawnScene, Resting
from scripted_body import trained_model

from robots.link.messages import Location
from robots.vision.obstruction import Clearance, Obstruction
from robots.vision.occupancy import Fit, Room, find_occupant

MODEL = trained_model()
BAR_ROOM = Room(PARTS["pink_bar"], Location(x=0.535, y=-0.12), TABLE_Z)
TOP_ROOM = Room(PARTS["purple_top"], Location(x=0.535, y=-0.05), TABLE_Z + 0.08)
LEGS = {
    "green_leg": Resting(0.46, -0.05, TABLE_Z),
    "blue_leg": Resting(0.61, -0.05, TABLE_Z),
}


def check(scene: DrawnScene, room: Room = BAR_ROOM, arm=()) -> Obstruction | None:
    image = scene.picture()
    return find_occupant(image, MODEL.segment(image.bgr), room, arm, Clearance(), Fit())


@pytest.mark.parametrize("noise", [0.0, 4.0])
@pytest.mark.parametrize(
    "at", [Resting(0.535, -0.12, TABLE_Z), Resting(0.56, -0.115, TABLE_Z, 0.6)]
)
def test_another_part_at_the_place_is_seen_and_named(at: Resting, noise: float) -> None:
    found = check(DrawnScene({"yellow_bar": at, **LEGS}, noise=noise))
    assert found is not None
    assert np.allclose(found.position[:2], (0.535, -0.12), atol=0.04)
    assert found.what == "yellow_bar is where pink_bar belongs"


def test_something_unknown_at_the_place_is_seen() -> None:
    found = check(DrawnScene(grey_boxes=[((0.55, -0.12, TABLE_Z), (0.05, 0.05, 0.05))]))
    assert found is not None
    assert found.what == "something unknown is where pink_bar belongs"


@pytest.mark.parametrize("noise", [0.0, 4.0])
@pytest.mark.parametrize(
    ("parts", "room"),
    [
        ({}, BAR_ROOM),
        (LEGS, BAR_ROOM),
        ({**LEGS, "yellow_bar": Resting(0.535, 0.02, TABLE_Z)}, BAR_ROOM),
        ({**LEGS, "pink_bar": Resting(0.55, -0.14, TABLE_Z, 0.4)}, BAR_ROOM),
        (LEGS, TOP_ROOM),
        ({**LEGS, "pink_bar": Resting(0.535, -0.12, TABLE_Z)}, TOP_ROOM),
    ],
    ids=["nothing", "legs beside", "a bar beside", "itself", "legs below", "all below"],
)
def test_a_free_place_is_free(parts: dict[str, Resting], room: Room, noise: float) -> None:
    assert check(DrawnScene(parts, noise=noise), room) is None


def test_the_arm_over_the_place_is_no_occupant() -> None:
    box = ((0.535, -0.12, TABLE_Z + 0.03), (0.08, 0.08, 0.2))
    above = (np.array([0.535, -0.12, TABLE_Z]), np.array([0.535, -0.12, TABLE_Z + 0.4]))
    assert check(DrawnScene(grey_boxes=[box])) is not None
    assert check(DrawnScene(grey_boxes=[box]), arm=(above,)) is None
