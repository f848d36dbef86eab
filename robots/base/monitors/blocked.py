"""`blocked`: a base does not get on: something stands in its way, or it never quite arrives."""

import math
from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import LASER, Detection


class Patience(StrictModel):
    """People who pass by are not asked for anything: it waits `patience_s` first.

    It tells of a goal that `tries` drives have not reached.
    """

    patience_s: Annotated[float, Field(gt=0.0, le=600.0)] = 5.0
    tries: Annotated[int, Field(ge=1, le=100)] = 3


class WayBlocked(BaseMonitor[Patience]):
    """Raises `blocked` while the base drives, for any behavior of it."""

    issue: ClassVar[str] = "blocked"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.TRAVEL})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = Patience

    def check(self, view: BaseView) -> Detection | None:
        if view.goal is not None and view.fell_short >= self.settings.tries:
            off_m, turned = view.pose.distance_m(view.goal), view.pose.turned_by_rad(view.goal)
            short = f"I am still {off_m:.2f} m off and turned by {math.degrees(turned):.0f} degrees"
            return Detection(
                camera=LASER, explanation=f"{short} after {view.fell_short} drives there"
            )
        if view.in_the_way_m is None or view.waited_s < self.settings.patience_s:
            return None
        standing = f"something has stood {view.in_the_way_m:.1f} m in front of me"
        return Detection(camera=LASER, explanation=f"{standing} for {view.waited_s:.0f} s")
