"""Pick and place, in eight steps (Blankenburg et al. 2020, Section 3.4)."""

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.arm.behaviors.behavior import ArmBehavior, Move, SetGripper, Situation, Step
from mend.robots.arm.body import ToolPose
from mend.robots.arm.grasp import RELEASE_CLEARANCE_M, Grasp, half_turn
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Location
from mend.tasks.scene import Name

_LIFTING = (Phase.APPROACH, Phase.GRASP, Phase.LIFT)


class PickAndPlaceParameters(StrictModel):
    """Which object goes where. `needs_help`: a person has to help with placing it."""

    object: Name
    place: Name
    needs_help: bool = False


class PickAndPlace(ArmBehavior):
    """Take an object from where it lies and put it to its place."""

    name: ClassVar[str] = "pick_and_place"
    parameters: ClassVar[type[StrictModel]] = PickAndPlaceParameters
    step_count: ClassVar[int | None] = 8

    def steps(self, parameters: StrictModel, situation: Situation) -> Sequence[Step]:  # noqa: ARG002
        """Raises `ValueError` where the part, its grasp or the target is not known."""
        grasp, target = situation.grasp, situation.target
        if situation.part is None or target is None or grasp is None:
            raise ValueError("pick_and_place expects a known object and a known place")
        place = _tool_pose(grasp, target, situation.table_z, RELEASE_CLEARANCE_M)
        pick = place
        if situation.found is not None:
            pick = _tool_pose(grasp, situation.found, situation.table_z, 0.0)
            # Parts look the same after half a turn: never carry one round by more than a quarter.
            place = replace(place, yaw=pick.yaw + half_turn(place.yaw - pick.yaw))
        above_pick, above_place = _above(pick, grasp, situation), _above(place, grasp, situation)
        apart_m = grasp.opening_m
        return (
            Step("above pick", Move(above_pick, 1.0, apart_m), Phase.APPROACH),
            Step("pick", Move(pick, 0.5, apart_m), Phase.APPROACH),
            Step("close gripper", SetGripper("closed"), Phase.GRASP),
            Step("above pick", Move(above_pick, 0.5), Phase.LIFT),
            Step("above place", Move(above_place, 0.75), Phase.CARRY),
            Step("place", Move(place, 0.3), Phase.PLACE, settle_s=0.1),
            Step("open gripper", SetGripper("open", apart_m), Phase.RELEASE),
            Step("above place", Move(above_place, 0.5, apart_m), Phase.RETREAT),
        )


def lifting(situation: Situation) -> Sequence[Step]:
    """The steps up to where the object is lifted, wherever it is to go."""
    parameters = PickAndPlaceParameters(object="it", place="anywhere")
    steps = PickAndPlace().steps(parameters, replace(situation, target=situation.found))
    return [step for step in steps if step.phase in _LIFTING]


def _tool_pose(grasp: Grasp, at: Location, table_z: float, clearance_m: float) -> ToolPose:
    bottom_z = table_z if at.z is None else at.z
    return grasp.tool_pose(at.x, at.y, bottom_z + clearance_m, at.yaw)


def _above(pose: ToolPose, grasp: Grasp, situation: Situation) -> ToolPose:
    """High enough for what hangs from the tool point to clear everything on the way."""
    hangs_m = max(grasp.height_m, situation.gripper.tip_reach_m)
    return replace(pose, z=max(pose.z + situation.lift_m, situation.clear_z + hangs_m))
