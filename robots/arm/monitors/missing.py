"""`missing`: the object is nowhere in the head picture."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView
from mend.robots.execution.monitor import ANY_BEHAVIOR, NoParameters, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection


class Missing(ArmMonitor[NoParameters]):
    """Raises `missing` before step 1 of any behavior."""

    issue: ClassVar[str] = "missing"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.PREPARE})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    camera: ClassVar[str | None] = "head"
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: ArmView) -> Detection | None:
        if view.part is None or view.sighting is not None or view.grip is not None:
            return None
        if view.was_done is not None:
            # `undone` knows that it was there, and says so.
            return None
        return Detection(
            camera="head", explanation=f"{view.part.name} is nowhere in the head picture"
        )
