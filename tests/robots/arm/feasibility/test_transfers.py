"""What one robot alone fetches and another alone places becomes two leaves, and nothing else."""

import math

from hypothesis import given
from hypothesis import strategies as st

from mend.robots.arm.body import Reach
from mend.robots.arm.feasibility.transfers import WithTransfers, plan_transfers
from mend.tasks.definition import BehaviorNode, GoalNode, NodeKind, TaskTreeDefinition
from mend.tasks.footprint import Footprint
from mend.tasks.frames import frames_of
from mend.tasks.scene import Base, Place, Pose, Scene, SceneObject, Table

REACH = Reach((0.0, -0.19), 0.40, 0.79)
FACING = {"left": Base(x=0.0, y=0.0), "right": Base(x=1.24, y=0.0, yaw=math.pi)}
SIZE = (0.04, 0.05, 0.05)


def leaf(parent: int | None, name: str) -> BehaviorNode:
    return BehaviorNode(
        parent=parent,
        name=name,
        behavior="pick_and_place",
        parameters={"object": name, "place": name, "needs_help": True},
    )


def tree(*names: str) -> TaskTreeDefinition:
    root = GoalNode(kind="and", parent=None, name="root")
    return TaskTreeDefinition(name="t", nodes=[root, *(leaf(0, each) for each in names)])


def table_for(robots: dict[str, Base], **ways: tuple[Pose, Pose]) -> Scene:
    """A scene in which each part goes from one pose to another."""
    return Scene(
        name="s",
        table=Table(center=(0.62, 0.0), size=(0.66, 1.3)),
        objects={
            name: SceneObject(color=(0.9, 0.1, 0.1), size=SIZE, pose=begin)
            for name, (begin, _) in ways.items()
        },
        places={name: Place(pose=end) for name, (_, end) in ways.items()},
        robots=robots,
    )


ACROSS = (Pose(x=0.40, y=-0.35), Pose(x=0.84, y=-0.02))
ONE_SIDE = (Pose(x=0.40, y=-0.35), Pose(x=0.40, y=0.02))


def reached_by(scene: Scene, pose: Pose) -> set[str]:
    return {
        name
        for name, frame in frames_of(scene).items()
        if REACH.min_m <= math.dist(frame.to_robot(pose.x, pose.y), REACH.origin) <= REACH.max_m
    }


def test_the_first_robot_sets_it_down_where_the_second_takes_it() -> None:
    planned = plan_transfers(tree("cup", "jar"), table_for(FACING, cup=ACROSS, jar=ONE_SIDE), REACH)
    told = [(each.kind, each.parent, each.name) for each in planned.tree.nodes]
    assert told == [
        ("and", None, "root"),
        ("then", 0, "cup"),
        ("behavior", 1, "cup_to_transfer"),
        ("behavior", 1, "cup_from_transfer"),
        ("behavior", 0, "jar"),
    ]
    first, second = planned.tree.nodes[2:4]
    assert isinstance(first, BehaviorNode)
    assert isinstance(second, BehaviorNode)
    assert first.place == "cup_transfer"
    assert second.place == "cup"
    # Somebody lends a hand at the part's own place alone.
    assert (first.needs_help, second.needs_help) == (False, True)
    assert reached_by(planned.scene, planned.scene.places["cup_transfer"].pose) == {"left", "right"}


def test_what_one_robot_does_stays_one_leaf() -> None:
    task, scene = tree("jar"), table_for(FACING, jar=ONE_SIDE)
    assert plan_transfers(task, scene, REACH) == WithTransfers(task, scene)


def test_a_robot_that_is_alone_passes_nothing_on() -> None:
    task, scene = tree("cup"), table_for({}, cup=ACROSS)
    assert plan_transfers(task, scene, REACH) == WithTransfers(task, scene)


def test_names_that_are_taken_are_not_given_again() -> None:
    task = tree("cup", "cup_to_transfer")
    scene = table_for(FACING, cup=ACROSS, cup_to_transfer=ONE_SIDE, cup_transfer=ONE_SIDE)
    planned = plan_transfers(task, scene, REACH)
    assert [each.name for each in planned.tree.nodes][1:4] == [
        "cup",
        "cup_to_transfer_2",
        "cup_from_transfer",
    ]
    assert planned.scene.places.keys() - scene.places.keys() == {"cup_transfer_2"}


POSES = st.builds(
    Pose,
    x=st.floats(0.34, 0.90),
    y=st.floats(-0.55, 0.55),
    z=st.none(),
    yaw=st.floats(-math.pi, math.pi),
)


@given(st.lists(st.tuples(POSES, POSES), min_size=1, max_size=6))
def test_spots_are_free_and_in_reach_of_both(ways: list[tuple[Pose, Pose]]) -> None:
    named = {f"part_{number}": way for number, way in enumerate(ways)}
    scene = table_for(FACING, **named)
    planned = plan_transfers(tree(*named), scene, REACH)
    spots = {name: each for name, each in planned.scene.places.items() if name not in named}
    taken = [Footprint(pose.x, pose.y, pose.yaw, *SIZE[:2]) for way in ways for pose in way]
    for spot in spots.values():
        assert reached_by(scene, spot.pose) == {"left", "right"}
        at = Footprint(spot.pose.x, spot.pose.y, spot.pose.yaw, *SIZE[:2])
        assert not any(at.overlaps(each) for each in taken)
        taken.append(at)
    goals = [each for each in planned.tree.nodes if each.kind == NodeKind.THEN]
    assert len(goals) == len(spots)
    # What it was checked for still holds of the definition that comes of it.
    assert TaskTreeDefinition.model_validate(planned.tree.model_dump()) == planned.tree
