"""What is to be executed, and what was found out about it before the first step."""

from collections.abc import Sequence
from dataclasses import dataclass

from robots.behaviors.behavior import Behavior
from robots.body import CameraImage, ToolPose
from robots.catalogue import Part
from robots.link.messages import Location, WasDone
from robots.result import Result
from robots.vision.head import HeadSighting
from robots.vision.obstruction import Obstruction
from tasks.scene import StrictModel


@dataclass(frozen=True, slots=True)
class Assignment:
    """What is to be executed, under which id; `was_done` as a `start` command has it.

    `finished` are the results that there are already.
    """

    execution: str
    behavior: Behavior
    parameters: StrictModel
    part: Part | None
    target: Location | None
    needs_help: bool
    was_done: WasDone | None = None
    finished: Sequence[Result] = ()


@dataclass(slots=True)
class Findings:
    """What was seen before the first step; `carrying`: the object is in the gripper already.

    `blind` says why the head camera shows nothing of the table, `refusal` why the object cannot be
    grasped and placed as it was seen. `obstruction` is what stands in `way`, through which the tool
    point is to go.
    """

    carrying: bool = False
    image: CameraImage | None = None
    blind: str | None = None
    sighting: HeadSighting | None = None
    refusal: str | None = None
    obstruction: Obstruction | None = None
    way: Sequence[ToolPose] = ()
