"""`blocked`: something is in the arm's way or at the object's place, seen or felt."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, ClassVar, Self

from pydantic import Field, model_validator

from mend.documents.strict_model import StrictModel
from mend.robots.arm.behaviors.contact import Contact, Try
from mend.robots.arm.behaviors.pick_and_place import PickAndPlace
from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView
from mend.robots.execution.monitor import BEFORE_FIRST_STEP, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection

PushLimit = Annotated[float, Field(gt=0.0, le=100.0)]
SpeedShare = Annotated[float, Field(gt=0.0, le=1.0)]


class BlockedParameters(StrictModel):
    """In each try of a motion the arm may push so hard (`limits_n`) and goes so fast.

    `speeds` are shares of the step's own.
    """

    limits_n: Annotated[tuple[PushLimit, ...], Field(strict=False)] = (25.0, 16.0, 10.0)
    speeds: Annotated[tuple[SpeedShare, ...], Field(strict=False)] = (1.0, 0.4, 0.2)

    @model_validator(mode="after")
    def _require_gentler_tries(self) -> Self:
        if len(self.limits_n) != len(self.speeds) or not self.limits_n:
            raise ValueError("expected as many speeds as limits, and at least one of each")
        for name, values in (("limits_n", self.limits_n), ("speeds", self.speeds)):
            if any(later > earlier for earlier, later in pairwise(values)):
                raise ValueError(f"expected each try to be gentler, got {name} {values}")
        return self


class Blocked(ArmMonitor[BlockedParameters]):
    """Raises `blocked` before step 1 (by what is seen) and in every step (by what is felt).

    What is felt counts only once the gentlest try has felt it too.
    """

    issue: ClassVar[str] = "blocked"
    behaviors: ClassVar[frozenset[str]] = frozenset({PickAndPlace.name})
    phases: ClassVar[frozenset[Phase]] = frozenset(Phase) - {
        Phase.TRAVEL,
        Phase.RIDE,
        Phase.LOAD,
        Phase.UNLOAD,
        Phase.TELL,
        Phase.CHARGE,
        Phase.MEET,
        Phase.ARRIVE,
        Phase.CONFIRM,
    }
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    camera: ClassVar[str | None] = "head"
    parameters: ClassVar[type[StrictModel]] = BlockedParameters

    @property
    def tries(self) -> Sequence[Try]:
        pairs = zip(self.settings.limits_n, self.settings.speeds, strict=True)
        return [Try(limit_n, speed) for limit_n, speed in pairs]

    def check(self, view: ArmView) -> Detection | None:
        if view.contact is not None:
            return Detection(
                camera="head",
                felt=True,
                explanation=_felt(view.contact),
                measured={"force_n": view.contact.force_n, "tries": view.contact.tries},
            )
        if view.step == BEFORE_FIRST_STEP and view.obstruction is not None:
            return Detection(
                camera="head",
                center=view.obstruction.center,
                area_px=view.obstruction.area_px,
                part=view.obstruction.part,
                explanation=view.obstruction.what,
            )
        return None


def _felt(contact: Contact) -> str:
    felt = f"{contact.force_n:.0f} N push against the arm"
    return felt if contact.tries == 1 else f"{felt}, felt in {contact.tries} tries, each gentler"
