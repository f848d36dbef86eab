"""The last metres of a judged drive, and a look back over them."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from mend.localization.beam_model import BeamModel, Beams
from mend.localization.evaluation import is_off
from mend.localization.judging.contest import MOST_PER_SCAN
from mend.localization.judging.verdict import Moment
from mend.localization.localizer import Localizer
from mend.localization.pose import Poses, relative
from mend.localization.scan import Scan

MakeLocalizer = Callable[[], Localizer]
REMEMBERED_M = 30.0
MOST_REMEMBERED = 1000
"""Steps; a robot that stands adds none without end."""


@dataclass(frozen=True, slots=True, eq=False)
class Past:
    """One step: how the robot came there, what it saw, and where it was said to be."""

    moment: Moment
    motion: Poses
    scan: Scan
    beams: Beams
    weighed: bool
    """Whether the robot had moved enough since for the scan to say anything new."""


@dataclass(slots=True)
class Memory:
    """The newest steps, the oldest forgotten."""

    steps: deque[Past] = field(default_factory=lambda: deque(maxlen=MOST_REMEMBERED))

    def add(self, step: Past) -> None:
        """Remember one more step."""
        self.steps.append(step)
        while step.moment.along_m - self.steps[0].moment.along_m > REMEMBERED_M:
            self.steps.popleft()

    def look_back(self, make: MakeLocalizer, model: BeamModel) -> list[Past]:
        """The steps since our track, followed back from where it is now, is the better one.

        A localizer walks the way backwards from our newest pose. Where the scans began to speak
        for that way rather than for the other localizer's is the point of change that CUSUM (Page
        1954) finds: from there on their log-likelihood ratios sum up to the most.
        """
        walked = self._walked_back(make)
        best, total, since = 0.0, 0.0, len(walked) - 1
        for number in range(len(walked) - 1, -1, -1):
            step = walked[number]
            theirs = step.moment.theirs
            if not np.isfinite(theirs).all() or not is_off(theirs, step.moment.ours):
                break
            if not step.weighed:
                continue
            ratio = model.log_likelihood(step.moment.ours, step.beams)
            ratio -= model.log_likelihood(step.moment.theirs, step.beams)
            total += float(np.clip(ratio, -MOST_PER_SCAN, MOST_PER_SCAN))
            if total > best:
                best, since = total, number
        return walked[since:]

    def _walked_back(self, make: MakeLocalizer) -> list[Past]:
        """The remembered steps with our poses as they are seen from the newest."""
        steps = list(self.steps)
        localizer = make()
        localizer.reset(steps[-1].moment.ours)
        motion = np.zeros(3)
        walked: list[Past] = []
        for step in reversed(steps):
            estimate = localizer.update(motion, replace(step.scan, time_s=0.0))
            walked.append(replace(step, moment=replace(step.moment, ours=estimate.pose)))
            motion = relative(step.motion, np.zeros(3))
        return walked[::-1]
