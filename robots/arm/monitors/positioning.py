"""`positioning`: the object is one that a person has to help place."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.arm.behaviors.pick_and_place import PickAndPlace
from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView
from mend.robots.execution.monitor import NoParameters, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection


class Positioning(ArmMonitor[NoParameters]):
    """Raises `positioning` when the object is carried; the robot goes on slowly."""

    issue: ClassVar[str] = "positioning"
    behaviors: ClassVar[frozenset[str]] = frozenset({PickAndPlace.name})
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.CARRY})
    reaction: ClassVar[Reaction] = Reaction.SLOW_DOWN
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: ArmView) -> Detection | None:
        if not view.needs_help or view.part is None:
            return None
        return Detection(
            camera="forearm", explanation=f"{view.part.name} is one that needs help with placing"
        )
