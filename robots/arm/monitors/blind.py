"""`blind`: the head camera shows nothing of the table."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView
from mend.robots.execution.monitor import ANY_BEHAVIOR, NoParameters, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection


class Blind(ArmMonitor[NoParameters]):
    """Raises `blind` before step 1 and after the last step of any behavior.

    It judges the camera itself, and not what that shows.
    """

    issue: ClassVar[str] = "blind"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.PREPARE, Phase.CONFIRM})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = NoParameters

    def check(self, view: ArmView) -> Detection | None:
        if view.blind is None:
            return None
        return Detection(camera="head", explanation=view.blind)
