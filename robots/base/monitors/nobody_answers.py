"""`nobody_answers`: a base has told a message, and nobody has said that it was heard."""

from typing import ClassVar

from mend.documents.strict_model import StrictModel
from mend.robots.base.behaviors.behavior import UNHEARD
from mend.robots.base.monitors.asking import Asking
from mend.robots.base.monitors.monitor import BaseMonitor, BaseView
from mend.robots.execution.monitor import ANY_BEHAVIOR, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import LISTENING, Detection


class NobodyAnswers(BaseMonitor[Asking]):
    """Raises `nobody_answers` while the base tells a message."""

    issue: ClassVar[str] = UNHEARD
    behaviors: ClassVar[frozenset[str]] = ANY_BEHAVIOR
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.TELL})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    parameters: ClassVar[type[StrictModel]] = Asking

    def check(self, view: BaseView) -> Detection | None:
        standing = view.standing
        if standing is None or standing.waited_s < self.settings.asks_s:
            return None
        return Detection(camera=LISTENING, explanation="nobody has told me yet that it was heard")
