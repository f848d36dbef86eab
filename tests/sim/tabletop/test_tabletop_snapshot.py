"""A tabletop world is rebuilt from its snapshot."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample
from tabletop_hands import Hands

from mend.sim.tabletop.layout import lay_out
from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Pose, Scene

SCENE = lay_out([(f"part{i}", f"place{i}") for i in range(5)], seed=3)

parts = st.sampled_from(sorted(SCENE.objects))
places = st.sampled_from(sorted(SCENE.places))
on_table = st.builds(
    Pose, x=st.floats(0.40, 0.70), y=st.floats(-0.40, 0.0), yaw=st.floats(-3.0, 3.0)
)
interventions = st.one_of(
    st.builds(Intervention, act=st.just(Act.STEAL), object=parts),
    st.builds(Intervention, act=st.just(Act.STEAL), object=parts, manner=st.just("pull")),
    st.builds(Intervention, act=st.just(Act.PUT_BACK), object=parts),
    st.builds(Intervention, act=st.just(Act.PLACE), object=parts, place=places),
    st.builds(Intervention, act=st.just(Act.MOVE), object=parts, to=on_table),
    st.builds(Intervention, act=st.just(Act.HAND_OVER), object=parts),
    st.builds(Intervention, act=st.sampled_from([Act.BLOCK, Act.RELEASE, Act.COVER, Act.UNCOVER])),
)


@given(happens=st.lists(st.tuples(interventions, st.integers(0, 30)), max_size=12))
@settings(max_examples=sample(20, 60), deadline=None)
def test_a_rebuilt_world_is_in_the_state_of_its_snapshot(
    happens: list[tuple[Intervention, int]],
) -> None:
    world = TabletopWorld(SCENE, seed=1)
    for intervention, cycles in happens:
        world.intervene(intervention)
        for _ in range(cycles):
            world.body.advance_cycle()
    kept = json.loads(json.dumps(world.snapshot()))

    rebuilt = TabletopWorld(SCENE, seed=1)
    rebuilt.restore(kept)

    assert rebuilt.snapshot() == kept
    assert rebuilt.body.time_s() == world.body.time_s()


def test_what_was_held_lies_where_it_last_rested(hands: Hands, scene: Scene) -> None:
    world = hands.world
    start = world.pose_of("red")
    hands.pick("red")
    kept = world.snapshot()
    assert kept["held"] == "red"

    rebuilt = TabletopWorld(scene, seed=7)
    rebuilt.restore(kept)

    assert rebuilt.pose_of("red") == start
    assert rebuilt.held is None
    assert rebuilt.body.tool_pose()[1, 3] < -0.8
    assert not rebuilt.body.moving


def test_what_was_being_pulled_away_is_gone(hands: Hands, scene: Scene) -> None:
    hands.pick("red")
    hands.world.intervene(Intervention(act=Act.STEAL, object="red", manner="pull"))
    hands.body.advance_cycle()
    rebuilt = TabletopWorld(scene, seed=7)
    rebuilt.restore(hands.world.snapshot())
    assert rebuilt.pose_of("red") is None


def test_a_rebuilt_world_still_knows_where_parts_started(scene: Scene) -> None:
    scattered = scene.model_copy(update={"scatter": scene.scatter.model_copy(update={"xy": 0.02})})
    world = TabletopWorld(scattered, seed=5)
    start = world.pose_of("red")
    world.intervene(Intervention(act=Act.STEAL, object="red"))
    rebuilt = TabletopWorld(scattered, seed=5)
    rebuilt.restore(world.snapshot())
    rebuilt.intervene(Intervention(act=Act.PUT_BACK, object="red"))
    assert rebuilt.pose_of("red") == start


def test_a_rebuilt_world_goes_on_handing_over(hands: Hands, scene: Scene) -> None:
    hands.world.intervene(Intervention(act=Act.HAND_OVER, object="far"))
    hands.wait(2.0)
    world = TabletopWorld(scene, seed=7)
    world.restore(hands.world.snapshot())
    again = Hands(world)
    again.open()
    again.wait(0.2)
    again.close()
    assert world.held == "far"


def test_a_snapshot_of_another_scene_is_refused(world: TabletopWorld) -> None:
    world.intervene(Intervention(act=Act.STEAL, object="red"))
    with pytest.raises(ValueError, match="parts that the scene has not"):
        TabletopWorld(SCENE, seed=1).restore(world.snapshot())


def test_a_snapshot_of_another_version_is_refused(world: TabletopWorld) -> None:
    with pytest.raises(ValueError, match="version"):
        world.restore({**world.snapshot(), "version": 3})
