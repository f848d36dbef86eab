"""`blocked`: something has stood in a base's way for longer than it waits."""

from typing import Annotated, ClassVar

from pydantic import Field

from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import LASER, Detection
from mend.tasks.scene import StrictModel


class Patience(StrictModel):
    """People who pass by are not asked for anything: it waits `patience_s` first."""

    patience_s: Annotated[float, Field(gt=0.0, le=600.0)] = 5.0


class WayBlocked(BaseMonitor[Patience]):
    """Raises `blocked` while the base drives, for any behavior of it."""

    issue: ClassVar[str] = "blocked"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.TRAVEL})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = Patience

    def check(self, view: BaseView) -> Detection | None:
        if view.in_the_way_m is None or view.waited_s < self.settings.patience_s:
            return None
        standing = f"something has stood {view.in_the_way_m:.1f} m in front of me"
        return Detection(camera=LASER, explanation=f"{standing} for {view.waited_s:.0f} s")
