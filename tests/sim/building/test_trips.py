"""The drive-time model against the world that it is a model of."""

import pytest
from building_bench import BuildingBench, made_up
from sampled import sample

from mend.fleet.dispatch.cabins import Cabins
from mend.maps.building.building import Building, Caller, DoorOpening
from mend.robots.link.messages import Finished
from mend.sim.building.scene import scene_name, scene_of
from mend.sim.building.trips import BuildingTrips


def called_by_robots(building: Building) -> Building:
    elevators = {
        name: each.model_copy(update={"called_by": Caller.ROBOTS})
        for name, each in building.document.elevators.items()
    }
    return Building(building.document.model_copy(update={"elevators": elevators}))


@pytest.mark.slow(2)
@pytest.mark.parametrize("seed", sample([7], [7, 8]))
def test_drives_in_the_world_take_what_the_model_says(seed: int) -> None:
    building = called_by_robots(made_up(floors=2, rooms=6, seed=seed))
    trips, cabins = BuildingTrips(building), Cabins(building)
    bench = BuildingBench(scene_of(building, "office", 1))
    here = "F1/charger1"
    for goal in ("F1/103", "F2/205", "F2/lift1", "F1/102"):
        began_s = bench.world.time_s()
        bench.go("robot1", scene_name(goal))
        bench.run()
        assert len(bench.of(Finished)) > 0
        took_s, lasts_s = bench.world.time_s() - began_s, 0.0
        for stage in trips.trip(here, goal):
            lasts_s += stage.drives_s
            if stage.ride is not None:
                ride = cabins.take(stage.ride, began_s + lasts_s)
                lasts_s += ride.waits_s + ride.rides_s
        assert lasts_s == pytest.approx(took_s, rel=0.05), f"{here} to {goal}"
        here = goal


def test_a_trip_passes_the_doors_of_both_rooms_and_rides_between_them() -> None:
    document = made_up(floors=2, rooms=6, seed=7).document
    floors = {
        name: floor.model_copy(
            update={
                "doors": {
                    key: door.model_copy(update={"opens": DoorOpening.PEOPLE})
                    for key, door in floor.doors.items()
                }
            }
        )
        for name, floor in document.floors.items()
    }
    trips = BuildingTrips(Building(document.model_copy(update={"floors": floors})))
    first, last = trips.trip("F1/101", "F2/202")
    assert first.ride is not None
    assert (first.ride.elevator, first.ride.from_floor, first.ride.to_floor) == (
        "lift1",
        "F1",
        "F2",
    )
    assert last.ride is None
    # Out of the room and into the elevator's, and the same above.
    assert (first.doors, last.doors) == (2, 2)
    (within,) = trips.trip("F1/101", "F1/103")
    assert (within.ride, within.doors) == (None, 2)
    (stays,) = trips.trip("F1/101", "F1/101")
    assert (stays.drives_s, stays.drives_m, stays.doors) == (0.0, 0.0, 0)
