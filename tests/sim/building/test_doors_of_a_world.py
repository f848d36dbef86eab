"""All doors of a building at once: each does as if it were alone with who is near it."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mend.maps.building.building import Building, BuildingDocument, Door, DoorOpening, Floor
from mend.sim.building.door import NOTICES_M, WorldDoor
from mend.sim.building.doors import WorldDoors

COORDINATES = st.floats(-6.0, 6.0).map(lambda each: round(each, 2))
POINTS = st.tuples(COORDINATES, COORDINATES)
HOURS = st.sampled_from([(), ((0.0, 20.0),)])


@st.composite
def doors(draw: st.DrawFn) -> Door:
    x, y = draw(POINTS)
    return Door(
        posts=((x, y), (x + 1.0, y)),
        opens=draw(st.sampled_from(list(DoorOpening))),
        open_s=draw(HOURS),
    )


def building_of(*floors: list[Door]) -> Building:
    return Building(
        BuildingDocument(
            building="doors",
            floors={
                f"F{number}": Floor(
                    height=3.0 * number,
                    places={"hall": {"x": 50.0, "y": 50.0}},
                    doors={f"d{each}": door for each, door in enumerate(plans)},
                )
                for number, plans in enumerate(floors)
            },
        )
    )


@given(
    st.lists(doors(), max_size=4),
    st.lists(doors(), max_size=4),
    st.lists(st.tuples(st.integers(0, 1), st.lists(POINTS, max_size=3)), max_size=6),
    st.booleans(),
)
def test_each_does_what_it_would_do_alone(
    below: list[Door],
    above: list[Door],
    visits: list[tuple[int, list[tuple[float, float]]]],
    shut: bool,
) -> None:
    together = WorldDoors(building_of(below, above), lambda _: shut)
    alone = {name: WorldDoor(name, each.plan, shut) for name, each in together.items()}
    for cycle, (number, points) in enumerate(visits):
        time_s = 5.0 * cycle
        on = f"F{number}"

        def circles(
            floor: str, on: str = on, points: list[tuple[float, float]] = points
        ) -> list[tuple[float, float, float]]:
            return [(x, y, 0.25) for x, y in points if floor == on]

        together.let_pass(time_s, circles)
        for name, each in alone.items():
            near = [p for p in points if name.startswith(on) and each.distance_m(*p) < NOTICES_M]
            each.let_pass(time_s, somebody=bool(near))
    assert {n: (e.is_shut, e.shuts_s) for n, e in together.items()} == {
        n: (e.is_shut, e.shuts_s) for n, e in alone.items()
    }
    for floor in ("F0", "F1"):
        lines = [e.segment for n, e in alone.items() if n.startswith(floor) and e.is_shut]
        assert np.array_equal(together.shut(floor), np.array(lines).reshape(-1, 4))


def test_the_nearest_shut_one_that_is_not_locked_is_found() -> None:
    near = Door(posts=((0.0, 1.0), (1.0, 1.0)), opens=DoorOpening.PEOPLE, open_s=((0.0, 10.0),))
    far = Door(posts=((0.0, 3.0), (1.0, 3.0)), opens=DoorOpening.PEOPLE)
    world = WorldDoors(building_of([near, far]), lambda _: True)
    found = world.nearest_shut("F0", 0.5, 0.0, 5.0)
    assert found is not None
    assert (found[0], found[1].name) == (1.0, "F0/d0")
    later = world.nearest_shut("F0", 0.5, 0.0, 15.0)
    assert later is not None
    assert later[1].name == "F0/d1"
    assert world.nearest_shut("in a cabin", 0.5, 0.0, 5.0) is None
    for each in world.values():
        each.hold_open(100.0)
    assert world.nearest_shut("F0", 0.5, 0.0, 5.0) is None
