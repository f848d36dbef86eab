"""One answer to whether an arm can do an errand amid what stands around."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import pytest
from scripted_body import GRIPPER

from mend.robots.arm.behaviors.errand import Errand
from mend.robots.arm.behaviors.pick_and_place import PickAndPlace, PickAndPlaceParameters
from mend.robots.arm.behaviors.planning import (
    AS_SEEN,
    Barred,
    Plan,
    Spare,
    at_once,
    bar_of,
    plan_amid,
)
from mend.robots.arm.body import Leg, NoWay
from mend.robots.arm.gripper import GripperModel
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.scene import Table

PART = Part("part", (0.03, 0.05, 0.05))
TABLE = Table()
PARAMETERS = PickAndPlaceParameters(object="part", place="there")
ERRAND = Errand(
    lambda situation: PickAndPlace().steps(PARAMETERS, situation),
    PART,
    Location(x=0.5, y=-0.4, yaw=0.0),
    Location(x=0.5, y=0.0, yaw=0.0),
)


@dataclass
class Path:
    segments: int


@dataclass
class ArmThatTouches:
    """It touches anything called one of `names`, on its first `ways` of all ways.

    It does not reach with the gripper turned by `too_far_rad`.
    """

    names: Sequence[str | None] = ()
    ways: int = 1000
    too_far_rad: float = math.inf
    asked: list[Sequence[Leg]] = field(default_factory=list)

    @property
    def gripper(self) -> GripperModel:
        return GRIPPER

    def plan_among(self, legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> Path | NoWay:
        self.asked.append(legs)
        if math.isclose(legs[0].to.yaw, self.too_far_rad):
            return NoWay("does not reach")
        for box in boxes:
            if box.name in self.names and len(self.asked) <= self.ways:
                return NoWay(f"would touch {box.name}", box)
        return Path(len(legs))


def box(name: str | None, x: float = 0.7, y: float = 0.2) -> SeenBox:
    return SeenBox(x, y, 0.0, (0.03, 0.03, 0.05), TABLE.height, name, complete=True)


def test_a_control_cycle_passes_after_every_way_that_is_barred() -> None:
    arm = ArmThatTouches(["post"], ways=3)
    routine = plan_amid(ERRAND, arm, TABLE, [box("post")])
    cycles = 0
    while True:
        try:
            next(routine)
        except StopIteration as end:
            found = end.value
            break
        cycles += 1
        assert len(arm.asked) == cycles
    assert isinstance(found, Plan)
    assert (cycles, len(arm.asked)) == (3, 4)


def test_no_way_is_asked_for_twice() -> None:
    arm = ArmThatTouches(["post"])
    assert isinstance(at_once(plan_amid(ERRAND, arm, TABLE, [box("post")])), Barred)
    ways = [tuple((leg.to, leg.opening_m) for leg in legs) for legs in arm.asked]
    assert len(ways) == len(set(ways)) > 1


def test_that_there_is_no_path_is_the_reason_where_there_was_room() -> None:
    beside = box("beside", x=0.5 + 0.015 + 0.025, y=-0.4)
    found = at_once(plan_amid(ERRAND, ArmThatTouches(["post"]), TABLE, [beside, box("post")]))
    assert isinstance(found, Barred)
    assert isinstance(found.reason, NoWay)
    assert any(not isinstance(each, NoWay) for each in found.refusals)


@pytest.mark.parametrize(
    ("size", "seen_deg", "taken_deg"),
    [
        ((0.012, 0.012, 0.05), -8.0, -0.5),
        ((0.012, 0.017, 0.05), 2.6, 0.1),
        # Of one that is hardly not square nobody sees how it is turned.
        ((0.013, 0.012, 0.021), -40.0, 0.0),
        ((0.012, 0.017, 0.05), -40.0, None),
    ],
)
def test_a_small_part_is_taken_turned_only_where_there_is_no_room_otherwise(
    size: tuple[float, float, float], seen_deg: float, taken_deg: float | None
) -> None:
    seen = Location(x=0.5, y=-0.4, yaw=math.radians(seen_deg))
    errand = replace(ERRAND, part=Part("pin", size), found=seen)
    # Fingers that are straight pass these walls; turned by 2.6 degrees they do not.
    away_m = 0.0133
    walls = [
        SeenBox(0.5, -0.4 + side * away_m, 0.0, (0.2, 0.005, 0.05), 0.7, "wall", complete=True)
        for side in (1.0, -1.0)
    ]
    picked = []
    for boxes, spare in ((walls, AS_SEEN), ([], AS_SEEN), (walls, Spare())):
        found = at_once(plan_amid(errand, ArmThatTouches(), TABLE, boxes, spare))
        at = found.picked_at if isinstance(found, Plan) else None
        picked.append(None if at is None else math.degrees(math.remainder(at.yaw, math.pi / 2)))
    within = None if taken_deg is None else pytest.approx(taken_deg)
    assert picked == [within, pytest.approx(seen_deg), None]


@pytest.mark.parametrize(
    ("touched", "stays", "told"),
    [
        (["post"], [], "post"),
        (["post", "other"], [], "post"),
        (["post"], ["post"], None),
        (["post", "other"], ["other"], None),
        (["post", "other", "third", "fourth"], [], None),
    ],
)
def test_what_could_be_taken_away_is_told_where_that_would_help(
    touched: list[str], stays: list[str], told: str | None
) -> None:
    arm, boxes = ArmThatTouches(touched), [box(name) for name in touched]
    barred = at_once(plan_amid(ERRAND, arm, TABLE, boxes))
    assert isinstance(barred, Barred)
    bar = at_once(
        bar_of(
            barred,
            boxes,
            lambda fewer: plan_amid(ERRAND, arm, TABLE, fewer),
            lambda each: each.name in stays,
        )
    )
    assert (bar and bar.name) == told


def test_what_is_in_the_way_is_told_though_the_arm_does_not_reach_in_another_way() -> None:
    first = ArmThatTouches()
    at_once(plan_amid(ERRAND, first, TABLE, []))
    boxes = [box("post")]
    arm = ArmThatTouches(["post"], too_far_rad=first.asked[0][0].to.yaw)
    barred = at_once(plan_amid(ERRAND, arm, TABLE, boxes))
    assert isinstance(barred, Barred)
    assert barred.refusals[0] == NoWay("does not reach")
    bar = at_once(
        bar_of(barred, boxes, lambda fewer: plan_amid(ERRAND, arm, TABLE, fewer), lambda _: False)
    )
    assert bar is boxes[0]
