"""Elevators in discrete events take one robot at a time, and come from where they are."""

from mend.fleet.dispatch.cabins import Cabins
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.maps.building.trip import TripRide

UP = TripRide("lift1", "F1", "F3", gets_in_s=4.0, gets_out_s=1.5)
DOWN = TripRide("lift1", "F3", "F1", gets_in_s=4.0, gets_out_s=1.5)


def cabins() -> Cabins:
    """A cabin that takes 5 s a floor and 2 s for its door, at F1."""
    return Cabins(Building(random_building(1, 3, 6)))


def test_a_cabin_that_is_there_opens_at_once() -> None:
    ride = cabins().take(UP, 100.0)
    assert ride.waits_s == 0.0
    assert ride.rides_s == 4.0 + 2.0 + 10.0


def test_a_cabin_comes_from_the_floor_where_it_is() -> None:
    assert cabins().take(DOWN, 100.0).waits_s == 10.0


def test_the_second_waits_until_the_first_is_out_and_the_cabin_is_back() -> None:
    lifts = cabins()
    first = lifts.take(UP, 0.0)
    second = lifts.take(UP, 5.0)
    # The door opens, shuts, and the cabin comes back.
    assert second.waits_s == first.rides_s + 2.0 + 2.0 + 10.0 - 5.0
    assert lifts.take(DOWN, 1000.0).waits_s == 0.0
