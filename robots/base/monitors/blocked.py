"""`blocked`: a base does not get on: something bars its way, or it never quite arrives."""

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

    It tells of a goal to which it has come no nearer for `headway_s`.
    """

    patience_s: Annotated[float, Field(gt=0.0, le=600.0)] = 5.0
    headway_s: Annotated[float, Field(gt=0.0, le=600.0)] = 20.0


class WayBlocked(BaseMonitor[Patience]):
    """Raises `blocked` while the base drives, for any behavior of it."""

    issue: ClassVar[str] = "blocked"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.TRAVEL})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = Patience

    def check(self, view: BaseView) -> Detection | None:
        if view.no_way is not None:
            return Detection(camera=LASER, explanation=view.no_way)
        if view.goal is not None and view.stalled_s >= self.settings.headway_s:
            off_m, turned = view.pose.distance_m(view.goal), view.pose.turned_by_rad(view.goal)
            still = f"I am still {off_m:.2f} m off and turned by {math.degrees(turned):.0f} degrees"
            return Detection(
                camera=LASER, explanation=f"{still}, and have come no nearer for a while"
            )
        told_otherwise = view.in_the_way_m is None or view.door is not None
        if told_otherwise or view.waited_s < self.settings.patience_s:
            return None
        what = "something" if view.robot is None else f"{view.robot} has failed, and"
        away, stood = f"{view.in_the_way_m:.1f} m", f"{view.waited_s:.0f} s"
        told = f"{what} has stood {away} in front of me for {stood}"
        return Detection(
            camera=LASER,
            explanation=told if view.robot is None else f"{told}; it may be pushed aside",
            between=list(view.between or ()),
            robot=view.robot,
        )
