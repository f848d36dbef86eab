"""Robots of one world that touch each other: looked for in every control cycle."""

import math
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import combinations, product
from typing import TYPE_CHECKING
from unittest.mock import patch

from mend.sim.tabletop.gripper_shape import FINGER, PALM, finger_offset_m
from mend.sim.tabletop.manipulator import Manipulator
from mend.sim.tabletop.state import TabletopState
from mend.tasks.footprint import Footprint

if TYPE_CHECKING:
    from mend.sim.workcell.world import WorkcellWorld

_LEAST_M = 1e-6
"""Within 0 the engine overlooks some that touch."""


@dataclass(frozen=True, slots=True)
class Body:
    """An upright box of a robot, or of what it holds."""

    footprint: Footprint
    low_z: float
    high_z: float

    def meets(self, other: "Body") -> bool:
        apart = self.low_z >= other.high_z or other.low_z >= self.high_z
        return not apart and self.footprint.overlaps(other.footprint)


def bodies_of(robot: Manipulator) -> list[Body]:
    """The boxes of its gripper, and the part between its fingers."""
    tool = robot.arm.pose
    aside_m = finger_offset_m(robot.gripper.opening_m)
    found = []
    for box, along_m in ((FINGER, aside_m), (FINGER, -aside_m), *((each, 0.0) for each in PALM)):
        points = box.reshape(-1, 3)
        low, high = points.min(axis=0), points.max(axis=0)
        x = tool.x + along_m * math.cos(tool.yaw)
        y = tool.y + along_m * math.sin(tool.yaw)
        size = high - low
        footprint = Footprint(x, y, tool.yaw, float(size[0]), float(size[1]))
        found.append(Body(footprint, tool.z + float(low[2]), tool.z + float(high[2])))
    if robot.held is not None:
        part = robot.held
        found.append(Body(part.footprint, part.pose.z, part.pose.z + part.height))
    return found


@contextmanager
def touching_robots() -> Iterator[list[str]]:
    """A sentence for each cycle in which two robots, or what they hold, are in one place.

    Workcells are looked into, and therefore simulated, in this process.
    """
    touched: list[str] = []
    with ExitStack() as watching:
        watching.enter_context(_watched_tabletops(touched))
        if find_spec("pybullet") is not None:
            watching.enter_context(_watched_workcells(touched))
        yield touched


@contextmanager
def _watched_tabletops(touched: list[str]) -> Iterator[None]:
    advance = TabletopState.advance_cycle

    def watched(state: TabletopState) -> None:
        advance(state)
        for one, two in combinations(state.manipulators, 2):
            if any(a.meets(b) for a in bodies_of(one) for b in bodies_of(two)):
                touched.append(f"two robots touch at {state.time_s:.1f} s")

    with patch.object(TabletopState, "advance_cycle", watched):
        yield


@contextmanager
def _watched_workcells(touched: list[str]) -> Iterator[None]:
    from mend.sim.workcell.adapter import WorkcellAdapter
    from mend.sim.workcell.world import WorkcellWorld

    advance = WorkcellWorld.advance_cycle

    def watched(world: WorkcellWorld) -> None:
        advance(world)
        if arms_touch(world):
            touched.append(f"two robots touch at {world.time_s():.3f} s")

    with (
        patch.object(WorkcellWorld, "advance_cycle", watched),
        patch.object(WorkcellAdapter, "own_process", False),
    ):
        yield


def arms_touch(world: "WorkcellWorld") -> bool:
    """Whether two PR2s, or what they hold, are in one place now."""
    near = world._client.getClosestPoints
    arms = []
    for body in world.bodies:
        held = world.held_by(body)
        arms.append([body.pr2.body_id] if held is None else [body.pr2.body_id, held.body_id])
    return any(
        near(one, two, _LEAST_M) for a, b in combinations(arms, 2) for one, two in product(a, b)
    )
