"""`crowded`: there is little room around a base that drives, so that it goes slowly."""

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection


class Room(StrictModel):
    """It is crowded where so large a share of the beams ends nearer than `near_m` (metres)."""

    near_m: Annotated[float, Field(gt=0.0)] = 1.0
    share: Annotated[float, Field(gt=0.0, le=1.0)] = 0.1


class Crowded(BaseMonitor[Room]):
    """Slows the base down on its way."""

    issue: ClassVar[str] = "crowded"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.TRAVEL})
    reaction: ClassVar[Reaction] = Reaction.SLOW_DOWN
    parameters: ClassVar[type[StrictModel]] = Room

    def check(self, view: BaseView) -> Detection | None:
        near = float(np.mean(view.scan.ranges_m < self.settings.near_m))
        if near < self.settings.share:
            return None
        return Detection(camera="laser", explanation="there is little room around me")
