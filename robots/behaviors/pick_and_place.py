"""Pick and place, in eight steps (Blankenburg et al. 2020, Section 3.4)."""

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

from robots.behaviors.behavior import Behavior, Move, SetGripper, Situation, Step
from robots.behaviors.phase import Phase
from robots.body import ToolPose
from robots.grasp import RELEASE_CLEARANCE_M, Grasp, grasp_of, half_turn
from robots.link.messages import Location
from tasks.scene import Name, StrictModel

APPROACH_M = 0.14
"""How far above pick and place the tool point passes."""


class PickAndPlaceParameters(StrictModel):
    """Which object goes where. `needs_help`: a person has to help with placing it."""

    object: Name
    place: Name
    needs_help: bool = False


class PickAndPlace(Behavior):
    """Take an object from where it lies and put it to its place."""

    name: ClassVar[str] = "pick_and_place"
    parameters: ClassVar[type[StrictModel]] = PickAndPlaceParameters

    def steps(self, parameters: StrictModel, situation: Situation) -> Sequence[Step]:  # noqa: ARG002
        """Raises `ValueError` where the part or the target is not known."""
        part, target = situation.part, situation.target
        if part is None or target is None:
            raise ValueError("pick_and_place expects a known object and a known place")
        grasp = grasp_of(part)
        place = _tool_pose(grasp, target, situation.table_z, RELEASE_CLEARANCE_M)
        pick = place
        if situation.found is not None:
            pick = _tool_pose(grasp, situation.found, situation.table_z, 0.0)
            # Parts look the same after half a turn: never carry one round by more than a quarter.
            place = replace(place, yaw=pick.yaw + half_turn(place.yaw - pick.yaw))
        return (
            Step("above pick", Move(_above(pick), speed=1.0), Phase.APPROACH),
            Step("pick", Move(pick, speed=0.5), Phase.APPROACH),
            Step("close gripper", SetGripper("closed"), Phase.GRASP),
            Step("above pick", Move(_above(pick), speed=0.5), Phase.LIFT),
            Step("above place", Move(_above(place), speed=0.75), Phase.CARRY),
            Step("place", Move(place, speed=0.3), Phase.PLACE, settle_s=0.1),
            Step("open gripper", SetGripper("open"), Phase.RELEASE),
            Step("above place", Move(_above(place), speed=0.5), Phase.RETREAT),
        )


def _tool_pose(grasp: Grasp, at: Location, table_z: float, clearance_m: float) -> ToolPose:
    bottom_z = table_z if at.z is None else at.z
    return grasp.tool_pose(at.x, at.y, bottom_z + clearance_m, at.yaw)


def _above(pose: ToolPose) -> ToolPose:
    return ToolPose(pose.x, pose.y, pose.z + APPROACH_M, pose.yaw)
