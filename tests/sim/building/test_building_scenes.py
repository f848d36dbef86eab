"""What is wrong with a scene of a building is told in a sentence, with where it is."""

from typing import Any

from building_bench import made_up

from mend.maps.building.building import Building, FloorPlace, Lane, PlaceKind
from mend.sim.building.buildings import BUILDINGS
from mend.sim.building.scene import scene_name, scene_of
from mend.tasks.definition import BehaviorNode
from mend.tasks.scene import Base, Place, Pose, Scene


def told(scene: Scene, *nodes: BehaviorNode) -> list[tuple[tuple[str, ...], str]]:
    return [(each.where, each.message) for each in BUILDINGS.check_scene(scene, nodes)]


def changed(**changes: Any) -> Scene:
    return scene_of(made_up(), "office", 1).model_copy(update=changes)


def test_what_is_made_of_a_building_has_no_mistake() -> None:
    for seed in range(8):
        assert not told(scene_of(made_up(floors=3, rooms=12, seed=seed), "office", 3))


def test_a_scene_without_a_building_is_told_how_to_get_one() -> None:
    ((where, message),) = told(changed(setting={}))
    assert where == ("setting",)
    assert "mend building scene" in message


def test_mistakes_of_the_building_are_told_as_those_of_its_file() -> None:
    setting = scene_of(made_up(), "office", 1).setting
    ((where, message),) = told(changed(setting={**setting, "lifts": {}}))
    assert where == ("setting", "lifts")
    assert "unknown key 'lifts'" in message


def test_floors_are_told_apart_by_their_heights() -> None:
    setting: Any = scene_of(made_up(floors=2), "office", 1).setting
    setting["floors"]["F2"].pop("height")
    ((where, message),) = told(changed(setting=setting, places={}))
    assert where == ("setting", "floors", "F2", "height")
    assert "how high each of them is" in message


def test_what_stands_on_no_floor_or_in_a_wall_is_told() -> None:
    scene = changed(
        robots={"high": Base(x=1.3, y=0.0, z=9.0)},
        places={"in_wall": Place(pose=Pose(x=0.0, y=0.0, z=0.0))},
    )
    problems = dict(told(scene))
    assert "no floor is 9 m high" in problems["robots", "high", "z"]
    assert "a wall is 0.00 m from here" in problems["places", "in_wall", "pose"]


def test_what_no_base_can_do_is_told_once() -> None:
    lift = BehaviorNode(
        parent=None,
        name="lift",
        behavior="pick_and_place",
        parameters={"object": "cup", "place": "F1-101"},
    )
    ((_, message),) = told(changed(), lift, lift)
    assert message.startswith("no robot of a building can do 'pick_and_place'")


def test_names_of_places_become_names_of_scenes() -> None:
    assert scene_name("F1/101") == "F1-101"
    assert scene_name("1/tea room") == "L1-tea_room"
    assert scene_name("1. OG/Küche groß") == "L1_OG-Kuche_gross"
    assert scene_name("F1/Café Ångström") == "F1-Cafe_Angstrom"
    assert scene_name("一/会议室") == "L_-_"


def test_a_place_that_no_robot_gets_to_is_told() -> None:
    scene = scene_of(made_up(floors=2), "office", 1)
    outside = Place(pose=Pose(x=-20.0, y=-20.0, z=0.0))
    scene = scene.model_copy(update={"places": {**scene.places, "street": outside}})
    leaves = [
        BehaviorNode(parent=None, name=each, behavior="go_to", parameters={"place": each})
        for each in ("F1-101", "F2-201", "street")
    ]
    ((where, message),) = told(scene, *leaves)
    assert where == ("places", "street")
    assert message == "no robot gets to 'street': no way leads from (-20.00, -20.00) to a lane"


def test_what_is_in_the_cabin_of_an_elevator_is_told() -> None:
    scene = scene_of(made_up(floors=2), "office", 1)
    stop = made_up(floors=2).floors["F1"].places["lift1"]
    inside = Place(pose=Pose(x=stop.x, y=stop.y, z=0.0))
    told_of = told(scene.model_copy(update={"places": {"inside": inside}}))
    assert told_of == [
        (("places", "inside", "pose"), "this is in the cabin of the elevator 'lift1'")
    ]


def test_a_lane_through_a_cabin_that_does_not_end_there_is_told() -> None:
    document = made_up(floors=2).document
    floor = document.floors["F1"]
    stop = floor.places["lift1"]
    ends = {
        "west": FloorPlace(x=stop.x - 1.2, y=stop.y),
        "east": FloorPlace(x=stop.x + 1.2, y=stop.y),
        "inside": FloorPlace(x=stop.x, y=stop.y + 2.0),
    }
    (hall,) = {end for each in floor.lanes if "lift1" in each.between for end in each.between} - {
        "lift1"
    }
    lanes = (
        *floor.lanes,
        Lane(between=("west", "east")),
        Lane(between=(hall, "inside")),
        Lane(between=("inside", "west")),
    )
    changed_floor = floor.model_copy(update={"places": {**floor.places, **ends}, "lanes": lanes})
    floors = {**document.floors, "F1": changed_floor}
    building = Building(document.model_copy(update={"floors": floors}))
    messages = [message for _, message in told(scene_of(building, "office", 1))]
    assert messages == [
        "the lane between 'west' and 'east' comes within 0.90 m of 'lift1', where the cabin of "
        "'lift1' stops"
    ]


def test_two_places_are_never_called_alike() -> None:
    document = made_up().document
    floor = document.floors["F1"]
    x, y = floor.places["101"].x, floor.places["101"].y
    more = {name: FloorPlace(x=x, y=y, kind=PlaceKind.ROOM) for name in ("tea room", "tea_room")}
    changed_floor = floor.model_copy(update={"places": {**floor.places, **more}})
    building = Building(document.model_copy(update={"floors": {"F1": changed_floor}}))
    places = scene_of(building, "office", 1).places
    assert {"F1-tea_room", "F1-tea_room_2"} <= places.keys()
