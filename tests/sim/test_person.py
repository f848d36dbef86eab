"""A simulated person keeps promises as reliably as the scenario says."""

import math

import numpy as np
import pytest

from mend.sim.free_pose import PLACE_RADIUS_M, free_pose, radius_m
from mend.sim.person import KeptPromise, Promise, deed
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import Person
from mend.tasks.scene import Place, Pose, Scene, SceneObject, Table

SCENE = Scene(
    name="two_cups",
    objects={
        "red_cup": SceneObject(
            color=(1.0, 0.0, 0.0), size=(0.06, 0.06, 0.1), pose=Pose(x=0.6, y=0.2)
        ),
        "blue_cup": SceneObject(
            color=(0.0, 0.0, 1.0), size=(0.06, 0.06, 0.1), pose=Pose(x=0.6, y=-0.4)
        ),
    },
    places={"left": Place(pose=Pose(x=0.5, y=0.0)), "right": Place(pose=Pose(x=0.5, y=-0.2))},
)


def promise(promised: str) -> Promise:
    return Promise(promised, "red_cup", "left")


def kept(promised: Promise, person: Person, seed: int = 1) -> KeptPromise | None:
    return deed(promised, person, SCENE, ["blue_cup"], np.random.default_rng(seed))


@pytest.mark.parametrize(
    ("promised", "intervention"),
    [
        ("place", Intervention(act=Act.PLACE, object="red_cup", place="left")),
        ("put_back", Intervention(act=Act.PUT_BACK, object="red_cup")),
        ("clear_view", Intervention(act=Act.UNCOVER)),
        ("hand_over", Intervention(act=Act.HAND_OVER, object="red_cup")),
        ("clear_way", Intervention(act=Act.RELEASE, object="red_cup", place="left")),
    ],
)
def test_a_reliable_person_does_what_was_promised(
    promised: str, intervention: Intervention
) -> None:
    assert kept(promise(promised), Person(delay_s=4.0)) == KeptPromise(intervention, 4.0)


@pytest.mark.parametrize("person", [Person(acts=False), Person(never=1.0)])
def test_some_promises_are_never_kept(person: Person) -> None:
    assert kept(promise("place"), person) is None


def test_a_late_person_takes_longer() -> None:
    late = kept(promise("place"), Person(delay_s=3.0, late=1.0, late_s=45.0))
    assert late is not None
    assert late.delay_s == 48.0


def test_a_confused_person_takes_another_object() -> None:
    confused = kept(promise("put_back"), Person(wrong_object=1.0))
    assert confused == KeptPromise(Intervention(act=Act.PUT_BACK, object="blue_cup"), 3.0)


def test_a_person_who_has_nothing_to_confuse_it_with_takes_the_right_object() -> None:
    rng = np.random.default_rng(1)
    sure = deed(promise("put_back"), Person(wrong_object=1.0), SCENE, [], rng)
    assert sure == KeptPromise(Intervention(act=Act.PUT_BACK, object="red_cup"), 3.0)


@pytest.mark.parametrize("promised", ["place", "put_back", "hand_over"])
@pytest.mark.parametrize("seed", range(5))
def test_a_clumsy_person_lays_it_down_at_a_free_spot(promised: str, seed: int) -> None:
    clumsy = kept(promise(promised), Person(wrong_place=1.0), seed)
    assert clumsy is not None
    assert (clumsy.intervention.act, clumsy.intervention.object) == (Act.MOVE, "red_cup")
    to = clumsy.intervention.to
    assert to is not None
    for place in SCENE.places.values():
        assert math.hypot(to.x - place.pose.x, to.y - place.pose.y) > PLACE_RADIUS_M


def test_a_person_gets_out_of_the_way_even_without_an_object() -> None:
    done = kept(Promise("clear_way", None, None), Person())
    assert done == KeptPromise(Intervention(act=Act.RELEASE), 3.0)


def test_a_part_in_the_way_is_what_is_put_aside() -> None:
    done = kept(Promise("clear_way", "red_cup", "left", in_the_way="blue_cup"), Person())
    assert done == KeptPromise(Intervention(act=Act.RELEASE, object="blue_cup"), 3.0)


def test_the_robot_that_asks_for_current_is_plugged_in() -> None:
    done = kept(Promise("charge", None, "charger", robot="robot2"), Person())
    assert done == KeptPromise(Intervention(act=Act.CHARGE, object="robot2"), 3.0)


def test_nothing_can_be_placed_where_no_object_was_spoken_of() -> None:
    assert kept(Promise("place", None, None), Person()) is None


def test_the_same_seed_gives_the_same_deed() -> None:
    person = Person(late=0.3, wrong_object=0.3, wrong_place=0.3, never=0.3)
    deeds = [kept(promise("place"), person, seed) for seed in range(30)]
    assert deeds == [kept(promise("place"), person, seed) for seed in range(30)]
    assert None in deeds
    assert len({each.intervention.act for each in deeds if each is not None}) > 1


def test_help_that_nobody_can_give_is_refused() -> None:
    with pytest.raises(ValueError, match="'sing'"):
        kept(promise("sing"), Person())


def test_a_free_pose_keeps_clear_of_everything_on_the_table() -> None:
    rng = np.random.default_rng(4)
    for _ in range(50):
        pose = free_pose("red_cup", SCENE, rng)
        assert pose is not None
        blue = SCENE.objects["blue_cup"].pose
        clear_m = radius_m("red_cup", SCENE) + radius_m("blue_cup", SCENE)
        assert math.hypot(pose.x - blue.x, pose.y - blue.y) > clear_m
        assert abs(pose.x - SCENE.table.center[0]) < SCENE.table.size[0] / 2
        assert abs(pose.y - SCENE.table.center[1]) < SCENE.table.size[1] / 2


def test_a_full_table_has_no_free_pose() -> None:
    tiny = SCENE.model_copy(update={"table": Table(center=(0.5, -0.1), size=(0.12, 0.12))})
    assert free_pose("red_cup", tiny, np.random.default_rng(1)) is None
