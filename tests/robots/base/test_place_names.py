"""What people call a point of a floor."""

import numpy as np

from mend.robots.base.place_names import PlaceNames

WALL = np.array([[0.0, 1.0, 10.0, 1.0]])
NAMES = PlaceNames({"101": (1.0, 3.0), "103": (6.0, 3.0)}, WALL)


def test_who_sees_a_place_close_by_is_there() -> None:
    assert NAMES.name_of(2.0, 3.0) == "at 101"


def test_behind_a_wall_one_is_near_it() -> None:
    assert NAMES.name_of(6.0, 0.5) == "near 103"


def test_far_from_it_one_is_near_it_at_best() -> None:
    assert NAMES.name_of(3.4, 9.0) == "near 101"


def test_where_nothing_has_a_name_there_is_nothing_to_say() -> None:
    assert PlaceNames({}, WALL).name_of(1.0, 1.0) is None
