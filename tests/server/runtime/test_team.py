"""Robots that share a run: who can do a leaf, and who may be where."""

from typing import Any

import pytest
from shapely import Point

from mend.robots.link.messages import (
    ActiveExecution,
    CommandBody,
    Hello,
    Holding,
    Looked,
    Position,
    ReachLimits,
    RoomLimits,
    Sighting,
)
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.team import Team, held_by
from mend.tasks.definition import BehaviorNode
from mend.tasks.frames import Frame
from mend.tasks.scene import Base, Place, Pose, Scene, SceneObject

ROOM = RoomLimits(resting=[(0.5, -0.9)], hand_over=(0.4, 0.0), around_m=0.1)
ACROSS = Frame(1.24, 0.0, 2)
COLOR, SIZE = (0.9, 0.1, 0.1), (0.04, 0.04, 0.05)


class Link:
    """Notes nothing: what robots are told is not looked at here."""

    def send(self, robot: str, command_id: str, body: CommandBody, *, renews: bool = True) -> None:
        pass


def hello(robot: str, **fields: Any) -> Hello:
    given: dict[str, Any] = {
        "protocol": 1,
        "robot": robot,
        "boot": "b",
        "behaviors": ["pick_and_place"],
        "cameras": [],
        "reach": ReachLimits(x=0.0, y=-0.19, min_m=0.4, max_m=0.79),
        "time": 0.0,
        "room": ROOM,
    }
    return Hello(**given | fields)


def leaf(part: str) -> BehaviorNode:
    return BehaviorNode(
        parent=0,
        name=part,
        behavior="pick_and_place",
        parameters={"object": part, "place": part},
    )


def scene(**ways: tuple[float, float, float, float]) -> Scene:
    """Parts by name, each with where it is and where it is to be."""
    return Scene(
        name="s",
        objects={
            name: SceneObject(color=COLOR, size=SIZE, pose=Pose(x=way[0], y=way[1]))
            for name, way in ways.items()
        },
        places={name: Place(pose=Pose(x=way[2], y=way[3])) for name, way in ways.items()},
        robots={"here": Base(x=0.0, y=0.0), "there": Base(x=1.24, y=0.0, yaw=3.1416)},
    )


NEAR = (0.45, -0.4, 0.45, -0.2)
"""What only the robot in the middle reaches."""
FAR = (0.79, 0.4, 0.79, 0.2)
"""What only the one across the table reaches."""
MIDDLE = (0.62, -0.1, 0.62, 0.1)
"""What both reach."""


@pytest.fixture
def team() -> Team:
    return Team(scene(near=NEAR, far=FAR, middle=MIDDLE), tuple)


@pytest.fixture
def pair(team: Team) -> tuple[RobotProxy, RobotProxy]:
    here, there = RobotProxy("here", Link()), RobotProxy("there", Link(), ACROSS)
    team.join({"here": here, "there": there})
    here.connect(hello("here"))
    there.connect(hello("there"))
    return here, there


def test_what_only_another_reaches_is_left_to_it(
    team: Team, pair: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = pair
    left = {
        (proxy.robot, part): team.leaves_to_others(proxy, leaf(part))
        for proxy in (here, there)
        for part in ("near", "far", "middle")
    }
    assert {who for who, is_left in left.items() if is_left} == {("here", "far"), ("there", "near")}


def test_what_nobody_reaches_is_tried_so_that_people_are_asked(
    pair: tuple[RobotProxy, RobotProxy],
) -> None:
    team = Team(scene(lost=(3.0, 3.0, 0.62, 0.1)), tuple)
    team.join({each.robot: each for each in pair})
    assert not any(team.leaves_to_others(proxy, leaf("lost")) for proxy in pair)


def test_where_a_part_was_seen_counts_and_not_where_it_began(
    team: Team, pair: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = pair
    # In its own frame, which is turned by half a turn.
    seen = Sighting(x=0.62, y=0.1, z=0.7, yaw=0.0, time=1.0)
    there.take_look(looked(far=seen), time=1.0)
    assert there.seen["far"].x == pytest.approx(0.62)
    assert there.seen["far"].y == pytest.approx(-0.1)
    assert team.leaves_to_others(here, leaf("far"))
    places = team_with_place_in_the_middle(pair)
    assert not places.leaves_to_others(here, leaf("far"))


def team_with_place_in_the_middle(pair: tuple[RobotProxy, RobotProxy]) -> Team:
    team = Team(scene(far=(0.79, 0.4, 0.62, 0.1)), tuple)
    team.join({each.robot: each for each in pair})
    return team


def looked(**objects: Sighting) -> Looked:
    return Looked(command="c", objects=objects, gripper=Position(x=0.5, y=-0.9, z=1.0))


def test_space_is_held_by_one_until_its_arm_rests_again(
    team: Team, pair: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = pair
    assert team.may_begin(here, leaf("middle"))
    team.take(here, leaf("middle"))
    assert not team.may_begin(there, leaf("middle"))
    # What it holds itself is not in its way.
    assert team.may_begin(here, leaf("near"))
    here.finish()
    assert team.may_begin(there, leaf("middle"))


def test_robots_work_side_by_side_where_their_ways_do_not_meet(
    team: Team, pair: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = pair
    team.take(here, leaf("near"))
    assert team.may_begin(there, leaf("far"))
    team.take(there, leaf("far"))
    assert not held_by(here).intersects(held_by(there))


def test_an_arm_that_has_stopped_on_its_way_keeps_its_space(
    team: Team, pair: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = pair
    team.take(here, leaf("middle"))
    here.hold_execution(Holding(execution="e", at="in_place"))
    assert not team.may_begin(there, leaf("middle"))
    here.hold_execution(Holding(execution="e", at="neutral"))
    assert team.may_begin(there, leaf("middle"))


def test_a_robot_that_was_given_up_on_its_way_is_an_obstacle(
    team: Team, pair: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = pair
    team.take(here, leaf("middle"))
    assert not team.leaves_to_others(there, leaf("middle"))
    here.gone_for_good = True
    assert team.leaves_to_others(there, leaf("middle"))


def test_where_another_arm_rests_nothing_is_placed(pair: tuple[RobotProxy, RobotProxy]) -> None:
    here, there = pair
    x, y = there.frame.to_scene(0.5, -0.9)
    team = Team(scene(cup=(0.62, 0.3, x - 0.1, y)), tuple)
    team.join({each.robot: each for each in pair})
    assert team.leaves_to_others(here, leaf("cup"))


def test_taking_from_people_needs_the_space_before_the_robot(
    team: Team, pair: tuple[RobotProxy, RobotProxy]
) -> None:
    here, _ = pair
    team.take(here, leaf("near"))
    hand_over = Point(ROOM.hand_over)
    assert not held_by(here).covers(hand_over.buffer(0.05))
    here.finish()
    team.take(here, leaf("near"), handed_over=True)
    assert held_by(here).covers(hand_over.buffer(0.05))


@pytest.fixture
def unsaid(team: Team) -> tuple[RobotProxy, RobotProxy]:
    """The first does not say what room it takes."""
    here, there = RobotProxy("here", Link()), RobotProxy("there", Link(), ACROSS)
    team.join({"here": here, "there": there})
    here.connect(hello("here", room=None))
    there.connect(hello("there"))
    return here, there


def test_a_robot_that_does_not_say_what_room_it_takes_works_while_nobody_else_does(
    team: Team, unsaid: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = unsaid
    assert team.may_begin(here, leaf("near"))
    team.take(here, leaf("near"))
    assert not team.may_begin(there, leaf("far"))
    here.finish()
    assert team.may_begin(there, leaf("far"))
    team.take(there, leaf("far"))
    assert not team.may_begin(here, leaf("near"))
    there.finish()
    assert team.may_begin(here, leaf("near"))


def test_nor_do_robots_at_once_of_which_the_scene_does_not_say_where_they_stand() -> None:
    team = Team(scene(near=NEAR, far=FAR).model_copy(update={"robots": {}}), tuple)
    here, there = RobotProxy("here", Link()), RobotProxy("there", Link())
    team.join({"here": here, "there": there})
    here.connect(hello("here"))
    there.connect(hello("there"))
    assert not team.leaves_to_others(here, leaf("near"))
    team.take(here, leaf("near"))
    assert not team.may_begin(there, leaf("far"))
    here.finish()
    assert team.may_begin(there, leaf("far"))


def test_where_it_was_given_up_on_its_way_nobody_works_any_more(
    team: Team, unsaid: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = unsaid
    team.take(here, leaf("near"))
    here.gone_for_good = True
    assert team.leaves_to_others(there, leaf("far"))
    assert team.given_up_in_the_way(leaf("far")) == ["here"]
    # Its program was started again, and its arm rests.
    here.connect(hello("here", room=None, boot="b2"))
    assert not team.leaves_to_others(there, leaf("far"))


def test_nor_does_it_where_another_was_given_up_on_its_way(
    team: Team, unsaid: tuple[RobotProxy, RobotProxy]
) -> None:
    here, there = unsaid
    team.take(there, leaf("far"))
    there.gone_for_good = True
    assert team.leaves_to_others(here, leaf("near"))


def test_nobody_begins_before_all_have_said_where_their_arms_are(team: Team) -> None:
    here, there = RobotProxy("here", Link()), RobotProxy("there", Link(), ACROSS)
    team.join({"here": here, "there": there})
    here.connect(hello("here"))
    assert not team.may_begin(here, leaf("near"))
    there.gone_for_good = True
    assert team.may_begin(here, leaf("near"))


def test_a_robot_that_is_still_at_something_when_it_comes_may_be_anywhere(team: Team) -> None:
    here, there = RobotProxy("here", Link()), RobotProxy("there", Link(), ACROSS)
    team.join({"here": here, "there": there})
    here.connect(hello("here"))
    at_work = ActiveExecution(execution="e", state="running", step=3)
    there.connect(hello("there", executing=at_work))
    assert not team.may_begin(here, leaf("near"))
    # What it is at is known.
    team.take_up_again(there, leaf("far"))
    assert team.may_begin(here, leaf("near"))
    assert not team.may_begin(here, leaf("middle"))
    there.finish()
    assert team.may_begin(here, leaf("middle"))


def test_a_robot_alone_has_everything() -> None:
    team, here = Team(scene(far=FAR), tuple), RobotProxy("here", Link())
    team.join({"here": here})
    here.connect(hello("here"))
    assert not team.shares
    assert team.may_begin(here, leaf("far"))
    assert not team.leaves_to_others(here, leaf("far"))
