"""`low_battery`: a base has little left to drive on, and gets no current."""

from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.battery import LOW
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import GAUGE, Detection

Share = Annotated[float, Field(ge=0.0, le=1.0)]


class LeastCharge(StrictModel):
    """It asks below `low`, on its way to a charger below `last` only.

    At a charger it waits `contact_s` for current.
    """

    low: Share = LOW
    last: Share = 0.03
    contact_s: Annotated[float, Field(gt=0.0, le=600.0)] = 5.0


class LowBattery(BaseMonitor[LeastCharge]):
    """Raises `low_battery` before the base sets out, on its way, and at a charger without current.

    Never in an elevator, which nobody else could use then.
    """

    issue: ClassVar[str] = "low_battery"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.PREPARE, Phase.TRAVEL, Phase.CHARGE})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = LeastCharge

    def check(self, view: BaseView) -> Detection | None:
        power = view.power
        if power.charging:
            return None
        told = f"my battery holds {100.0 * power.share:.0f} %"
        measured = {"charge": power.share}
        if view.phase is Phase.CHARGE:
            waited_s = 0.0 if view.standing is None else view.standing.waited_s
            if waited_s < self.settings.contact_s:
                return None
            told = f"no current comes here, and {told}"
            return Detection(camera=GAUGE, explanation=told, measured=measured)
        least = self.settings.last if power.to_charger else self.settings.low
        if power.share >= least:
            return None
        return Detection(camera=GAUGE, explanation=told, measured=measured)
