"""What is to be executed."""

from collections.abc import Sequence
from dataclasses import dataclass

from mend.documents.strict_model import StrictModel
from mend.robots.arm.behaviors.behavior import ArmBehavior
from mend.robots.arm.result import JudgedResult
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location, WasDone


@dataclass(frozen=True, slots=True)
class Assignment:
    """What is to be executed, under which id; `was_done` as a `start` command has it.

    `finished` are the results that there are already.
    """

    execution: str
    behavior: ArmBehavior
    parameters: StrictModel
    part: Part | None
    target: Location | None
    needs_help: bool
    was_done: WasDone | None = None
    finished: Sequence[JudgedResult] = ()
