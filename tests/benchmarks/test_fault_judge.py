"""The judge of faults goes by where things are in the world."""

import math
from collections.abc import Iterator

import pytest

pytest.importorskip("pybullet")

from fault_judge import Judge, place_of

from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Place, Pose, Scene, SceneObject

RED, BLUE = (0.8, 0.1, 0.1), (0.1, 0.1, 0.8)
BAR = (0.03, 0.12, 0.04)


def part(x: float, y: float, color: tuple[float, float, float] = RED) -> SceneObject:
    return SceneObject(color=color, size=BAR, pose=Pose(x=x, y=y))


SCENE = Scene(
    name="three_bars",
    objects={
        "part_1": part(0.45, -0.4),
        "part_2": part(0.55, -0.4),
        "part_3": part(0.65, -0.4, BLUE),
    },
    places={
        "place_1": Place(pose=Pose(x=0.45, y=0.1)),
        "place_2": Place(pose=Pose(x=0.55, y=0.1)),
        "place_3": Place(pose=Pose(x=0.65, y=0.05)),
    },
)


@pytest.fixture
def world() -> Iterator[WorkcellWorld]:
    made = WorkcellWorld(SCENE, 1, WorkcellOptions())
    yield made
    made.close()


@pytest.fixture
def judge(world: WorkcellWorld) -> Judge:
    return Judge(world, SCENE)


def move_to_place(world: WorkcellWorld, name: str, place: str) -> None:
    to = SCENE.places[place].pose
    assert not world.intervene(Intervention(act=Act.MOVE, object=name, to=to))


def test_an_equal_part_at_the_place_will_do_and_another_is_in_the_way(
    world: WorkcellWorld, judge: Judge
) -> None:
    assert judge.is_true("undone", "part_1")
    move_to_place(world, "part_2", place_of("part_1"))
    assert not judge.is_true("undone", "part_1")
    assert not judge.is_true("blocked", "part_1")
    move_to_place(world, "part_3", place_of("part_2"))
    assert judge.is_true("blocked", "part_2")


def test_what_is_turned_too_far_is_not_at_its_place(world: WorkcellWorld, judge: Judge) -> None:
    at = SCENE.places["place_1"].pose
    for turned, is_there in ((math.radians(10), True), (math.radians(40), False), (math.pi, True)):
        to = at.model_copy(update={"yaw": turned})
        assert not world.intervene(Intervention(act=Act.MOVE, object="part_1", to=to))
        assert judge.at_place("part_1") is is_there, f"turned by {turned:.2f} rad"


def test_what_is_stolen_is_missing_and_out_of_reach(world: WorkcellWorld, judge: Judge) -> None:
    assert not judge.is_true("missing", "part_3")
    assert not judge.is_true("unreachable", "part_3")
    assert not world.intervene(Intervention(act=Act.STEAL, object="part_3"))
    assert judge.is_true("missing", "part_3")
    assert judge.is_true("unreachable", "part_3")


def test_what_was_never_held_is_missed_and_not_dropped(judge: Judge) -> None:
    judge.note_grasp("part_1", 4)
    assert judge.is_true("missed", "part_1")
    assert not judge.is_true("dropped", "part_1")
