"""A scene of several robots: what one can do is no problem; who never may begin is refused."""

from collections.abc import Sequence

import numpy as np

from mend.sim.tabletop.adapter import adapter as tabletop
from mend.tasks.definition import BehaviorNode
from mend.tasks.scene import Base, Place, Pose, Scene, SceneObject, Table

ACROSS = Base(x=1.04, y=0.0, yaw=np.pi)


HERE = Base(x=0.0, y=0.0)
END = Base(x=0.52, y=2.0, yaw=-np.pi / 2)
"""Its gripper rests beside the table, on the first robot's side: near, as the table is narrow."""
LONG = (0.05, 0.40, 0.05)


def told(
    ways: Sequence[tuple[tuple[float, float], tuple[float, float]]],
    robots: dict[str, Base],
    size: tuple[float, float, float] = (0.04, 0.05, 0.05),
) -> list[str]:
    """The problems of a task that brings parts from there to there."""
    names = [f"part_{number}" for number in range(len(ways))]
    colors = [(0.9, 0.1, 0.1), (0.1, 0.2, 0.9)]
    scene = Scene(
        name="shared",
        table=Table(height=0.70, center=(0.52, 0.0), size=(0.12, 1.40)),
        objects={
            name: SceneObject(color=color, size=size, pose=Pose(x=start[0], y=start[1]))
            for name, color, (start, _) in zip(names, colors, ways, strict=False)
        },
        places={
            name: Place(pose=Pose(x=end[0], y=end[1]))
            for name, (_, end) in zip(names, ways, strict=True)
        },
        robots=robots,
    )
    leaves = [
        BehaviorNode.model_validate(
            {
                "kind": "behavior",
                "parent": None,
                "name": name,
                "behavior": "pick_and_place",
                "parameters": {"object": name, "place": name},
            }
        )
        for name in names
    ]
    return [each.message for each in tabletop.check_scene(scene, leaves)]


def test_what_either_robot_can_do_is_no_problem() -> None:
    ways = [((0.5, -0.5), (0.5, -0.2)), ((0.54, 0.5), (0.54, 0.2))]
    assert told(ways, {"left": HERE, "right": ACROSS}) == []


def test_what_no_robot_reaches_is_told_of_the_one_that_is_nearest() -> None:
    (message,) = told([((0.5, -0.5), (0.5, 0.5))], {"left": HERE, "right": ACROSS})
    assert "does not reach" in message


def test_arms_that_rest_in_one_place_are_refused() -> None:
    beside = Base(x=0.1, y=0.1)
    (message,) = told([((0.5, -0.5), (0.5, -0.2))], {"left": HERE, "beside": beside})
    assert message.startswith(
        "the robots 'left' and 'beside' rest their arms in one place, at (0.52,"
    )


def test_a_part_that_would_always_be_taken_where_another_arm_rests_is_refused() -> None:
    ways = [((0.50, -0.2), (0.50, 0.0))]
    robots = {"left": HERE, "end": END}
    assert told(ways, robots) == []
    (message,) = told(ways, robots, LONG)
    assert message == (
        "no robot may ever handle part_0: 'left' would go where another arm rests: move the part, "
        "its place or the robots"
    )


def test_a_robot_that_may_never_begin_anything_is_refused() -> None:
    # All that the first robot reaches the one across reaches, too, and that has the room.
    ways = [((0.50, 0.3), (0.50, 0.2))]
    robots = {"left": HERE, "right": ACROSS, "end": END}
    assert told(ways, robots) == []
    (message,) = told(ways, robots, LONG)
    assert message.startswith("the robot 'left' may never begin anything")
