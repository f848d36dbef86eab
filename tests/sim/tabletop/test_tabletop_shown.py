"""What a tabletop world shows to people: where everything really is, and who has it."""

from tabletop_hands import Hands

from mend.robots.link.messages import ShownPose
from mend.sim.tabletop.world import TabletopWorld
from mend.tasks.intervention import Act, Intervention


def shown(world: TabletopWorld, name: str) -> ShownPose:
    names = [each.name for each in world.shown_objects]
    return world.shown_poses()[names.index(name)]


def do(world: TabletopWorld, act: Act, name: str | None = None) -> None:
    assert world.intervene(Intervention(act=act, object=name)) == ""


def test_every_part_is_shown_where_it_is_with_its_shape(world: TabletopWorld) -> None:
    assert len(world.shown_objects) == len(world.shown_poses())
    for each in world.shown_objects[:-1]:
        definition = world.scene.objects[each.name]
        assert (each.size, each.knob) == (definition.size, definition.knob)
        real = world.pose_of(each.name)
        assert real is not None
        pose = shown(world, each.name)
        assert pose.pose[:3] == (real.x, real.y, real.z)
        assert (pose.held, pose.gone, pose.hidden) == (False, False, False)


def test_what_is_stolen_is_gone_and_back_again(world: TabletopWorld) -> None:
    do(world, Act.STEAL, "red")
    assert shown(world, "red").gone
    do(world, Act.PUT_BACK, "red")
    assert not shown(world, "red").gone


def test_what_the_fingers_hold_is_held(world: TabletopWorld, hands: Hands) -> None:
    hands.go(0.6, -0.1, 0.74, 0.3)
    hands.close()
    assert world.held == "green"
    assert shown(world, "green").held


def test_what_is_handed_over_is_hidden_until_the_fingers_can_take_it(
    world: TabletopWorld, hands: Hands
) -> None:
    hands.close()
    do(world, Act.HAND_OVER, "red")
    assert shown(world, "red").hidden


def test_who_stands_in_the_way_is_shown_while_they_do(world: TabletopWorld) -> None:
    assert world.shown_objects[-1].kind == "obstacle"
    assert shown(world, "obstacle").gone
    do(world, Act.BLOCK)
    assert not shown(world, "obstacle").gone
    do(world, Act.RELEASE)
    assert shown(world, "obstacle").gone
