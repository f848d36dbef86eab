"""`person_not_there`: a base has come to meet somebody, and sees nobody."""

from typing import Annotated, ClassVar

from pydantic import Field

from mend.documents.strict_model import StrictModel
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import TRACKER, Detection


class MeetingPatience(StrictModel):
    """Who is called comes a little later: it asks after `asks_s`."""

    asks_s: Annotated[float, Field(gt=0.0, le=600.0)] = 10.0


class PersonNotThere(BaseMonitor[MeetingPatience]):
    """Raises `person_not_there` while the base waits for whom it is to escort."""

    issue: ClassVar[str] = "person_not_there"
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.MEET})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = MeetingPatience

    def check(self, view: BaseView) -> Detection | None:
        standing = view.standing
        if standing is None or standing.waited_s < self.settings.asks_s:
            return None
        told = f"I have waited at {standing.place} for {standing.waited_s:.0f} s"
        return Detection(camera=TRACKER, explanation=f"{told}, and see nobody beside me")
