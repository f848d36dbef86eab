"""Putting down: where it was picked, else at the nearest spot that is seen to be free."""

import math

from robot_bench import RobotBench
from scripted_body import GRIPPER, STARTS, ScriptedBody

from mend.robots.arm.behaviors.put_down import _free_spots
from mend.robots.arm.body import ToolPose
from mend.robots.arm.grasp import grasp_of
from mend.robots.catalogue import Part
from mend.robots.link.messages import Interrupt
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.scene import Table

HERE = ToolPose(0.6, -0.1, 0.95, 0.3)
PART = Part("part", (0.03, 0.08, 0.05))
GRASP = grasp_of(PART, GRIPPER)


def spots(*boxes: SeenBox) -> list[ToolPose]:
    return list(_free_spots(HERE, PART, GRASP, GRIPPER, boxes, Table()))


def box(x: float, y: float) -> SeenBox:
    return SeenBox(x, y, 0.0, (0.06, 0.06, 0.05), 0.7, "other", complete=True)


def test_straight_below_is_the_best_free_spot() -> None:
    first, *others = spots()
    assert (first.x, first.y) == (HERE.x, HERE.y)
    distances = [round(math.hypot(each.x - HERE.x, each.y - HERE.y), 6) for each in others]
    assert distances == sorted(distances)


def test_nothing_is_put_onto_or_right_beside_what_stands_there() -> None:
    neighbours = [box(HERE.x, HERE.y), box(HERE.x + 0.1, HERE.y)]
    found = spots(*neighbours)
    assert found
    for spot in found:
        for other in neighbours:
            assert math.hypot(spot.x - other.x, spot.y - other.y) > 0.03 + 0.015


def test_nothing_is_put_over_the_edge_of_the_table() -> None:
    table = Table()
    for spot in spots():
        assert table.is_under(spot.x + 0.015, spot.y)
        assert table.is_under(spot.x - 0.015, spot.y)


def test_an_interrupted_part_goes_back_to_where_it_was_picked() -> None:
    bench = RobotBench(body=ScriptedBody(STARTS))
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    bench.send(Interrupt(retreat=True))
    bench.run()
    resting, start = bench.body.parts["pink_bar"], STARTS["pink_bar"]
    assert math.hypot(resting.x - start.x, resting.y - start.y) < 0.01
