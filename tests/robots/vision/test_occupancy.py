"""Whether a place is free: what is in the room for a part is seen, its neighbours are let be."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_scene import PARTS, TABLE_Z, DrawnScene, Resting
from scripted_body import view_of

from mend.robots.catalogue import Part
from mend.robots.link.messages import Location
from mend.robots.vision.obstruction import Obstruction
from mend.robots.vision.occupancy import Fit, Room, find_occupant, room_above, room_at_place
from mend.robots.vision.seen_box import SeenBox

BAR_ROOM = room_at_place(PARTS["pink_bar"], Location(x=0.535, y=-0.12), TABLE_Z)
TOP_ROOM = room_at_place(PARTS["purple_top"], Location(x=0.535, y=-0.05), TABLE_Z + 0.08)
LEGS = {
    "green_leg": Resting(0.46, -0.05, TABLE_Z),
    "blue_leg": Resting(0.61, -0.05, TABLE_Z),
}


def check(scene: DrawnScene, room: Room = BAR_ROOM) -> Obstruction | None:
    return find_occupant(view_of(scene.picture()), room, Fit())


@pytest.mark.parametrize("noise", [0.0, 4.0])
@pytest.mark.parametrize(
    "at", [Resting(0.535, -0.12, TABLE_Z), Resting(0.56, -0.115, TABLE_Z, 0.6)]
)
def test_another_part_at_the_place_is_seen_and_named(at: Resting, noise: float) -> None:
    found = check(DrawnScene({"yellow_bar": at, **LEGS}, noise=noise))
    assert found is not None
    assert np.allclose(found.position[:2], (0.535, -0.12), atol=0.04)
    assert found.what == "yellow_bar is where pink_bar belongs"


def test_what_is_taller_than_the_room_is_seen_by_its_top() -> None:
    room = room_at_place(Part("pin", (0.024, 0.08, 0.02)), Location(x=0.535, y=-0.12), TABLE_Z)
    tall = ((0.535, -0.12, TABLE_Z), (0.13, 0.13, 0.11))
    found = check(DrawnScene(grey_boxes=[tall]), room)
    assert found is not None
    assert found.what == "something unknown is where pin belongs"


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


@pytest.mark.parametrize("at", [(0.535, -0.12), (0.56, -0.118)])
def test_what_a_part_stands_on_at_its_place_is_where_it_belongs(at: tuple[float, float]) -> None:
    found = check(DrawnScene({"pink_bar": Resting(*at, TABLE_Z + 0.03)}))
    assert found is not None
    assert found.what == "what pink_bar stands on is where pink_bar belongs"
    assert np.allclose(found.position[:2], at, atol=0.005)


@pytest.mark.parametrize(
    ("parts", "room"),
    [
        ({"pink_bar": Resting(0.535, -0.20, TABLE_Z + 0.03)}, BAR_ROOM),
        (
            {"purple_top": Resting(0.535, -0.05, TABLE_Z + 0.08)},
            room_at_place(PARTS["purple_top"], Location(x=0.535, y=-0.05), TABLE_Z + 0.08),
        ),
    ],
    ids=["beside its place", "as high as it is to stand"],
)
def test_what_a_part_stands_on_elsewhere_is_in_nobodys_way(
    parts: dict[str, Resting], room: Room
) -> None:
    assert check(DrawnScene(parts), room) is None


def test_what_stands_beside_a_half_hidden_part_does_not_lie_on_it() -> None:
    bar = Resting(0.52, -0.30, TABLE_Z, np.pi / 2)
    sighting = view_of(DrawnScene({"pink_bar": bar}).picture()).sightings["pink_bar"]
    leg = Resting(0.488, -0.30, TABLE_Z)
    view = view_of(DrawnScene({"pink_bar": bar, "green_leg": leg}).picture())
    room = room_above(PARTS["pink_bar"], replace(sighting, shown=0.5))
    assert find_occupant(view, room, Fit()) is None


@pytest.mark.parametrize(("on_it", "free"), [(0.04, False), (None, True)])
def test_what_lies_on_a_part_is_seen(on_it: float | None, free: bool) -> None:
    parts = {"pink_bar": Resting(0.5, -0.3, TABLE_Z), "green_leg": Resting(0.58, -0.3, TABLE_Z)}
    if on_it is not None:
        parts["yellow_bar"] = Resting(0.54, -0.3, TABLE_Z + on_it, 1.2)
    view = view_of(DrawnScene(parts).picture())
    sighting = view.sightings.get("pink_bar")
    assert sighting is not None
    room = room_above(PARTS["pink_bar"], sighting)
    found = find_occupant(view, room, Fit())
    assert (found is None) is free
    assert free or found.what == "yellow_bar lies on pink_bar"


def test_a_part_does_not_lie_on_itself() -> None:
    """Something badly seen beside it may seem to reach into the part."""
    scene = DrawnScene({"purple_top": Resting(0.535, -0.12)})
    view = view_of(scene.picture())
    unclear = SeenBox(0.535, -0.12, 0.3, (0.3, 0.3, 0.2), TABLE_Z, None, complete=False)
    view = replace(view, boxes=[*view.boxes, unclear])
    room = room_above(PARTS["purple_top"], view.sightings["purple_top"])
    assert find_occupant(view, room, Fit(share=0.01)) is None
