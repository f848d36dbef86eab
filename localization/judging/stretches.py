"""Gathers the steps at which something is to be said into stretches of the way."""

from dataclasses import dataclass, replace

import numpy as np

from mend.localization.beam_model import BeamModel
from mend.localization.judging.memory import Past
from mend.localization.judging.verdict import Moment, Standing, Stretch


@dataclass(slots=True)
class _Matched:
    """Sums over the scans of a stretch."""

    scans: int = 0
    ours: float = 0.0
    theirs: float = 0.0


class Stretches:
    """The stretches of a drive, the last of which may still go on."""

    def __init__(self, model: BeamModel) -> None:
        self._model = model
        self._ended: list[Stretch] = []
        self._open: Stretch | None = None
        self._matched = _Matched()

    @property
    def says_lost(self) -> bool:
        """Whether the other localizer is lost by now."""
        return self._open is not None and self._open.standing is Standing.LOST

    def go_on(self, standing: Standing, since: Moment, past: Past) -> None:
        """At this step, too, it stands like that; if it did not before, a stretch begins."""
        if self._open is None or self._open.standing is not standing:
            self.end(past.moment)
            after = self._ended[-1].until if self._ended else None
            if after is not None and after.step > since.step:
                since = after
            self._matched = _Matched()
            self._open = Stretch(standing, since, past.moment, None, 0.0, 0.0, 0.0)
        self._measure(past)

    def undecided(self, past: Past) -> Standing:
        """A stretch goes on while nothing else is clear."""
        if self._open is None:
            return Standing.OPEN
        self._measure(past)
        return self._open.standing

    def end(self, moment: Moment) -> None:
        """From this step on there is nothing to be said."""
        if self._open is not None:
            self._ended.append(replace(self._open, until=moment))
            self._open = None

    def take_back(self, since: Moment) -> None:
        """What was said of the way since then was said by a track that has proven wrong."""
        if self._open is not None and self._open.said.step >= since.step:
            self._open = None
        self._ended = [each for each in self._ended if each.said.step < since.step]

    def all(self) -> tuple[Stretch, ...]:
        """The stretches so far, in their order."""
        return (*self._ended, *([] if self._open is None else [self._open]))

    def _measure(self, past: Past) -> None:
        assert self._open is not None
        moment, matched = past.moment, self._matched
        if past.weighed:
            matched.scans += 1
            matched.ours += self._model.matched_share(moment.ours, past.beams)
            matched.theirs += self._model.matched_share(moment.theirs, past.beams)
        away = moment.ours[:2] - moment.theirs[:2]
        scans = max(matched.scans, 1)
        self._open = replace(
            self._open,
            furthest_m=max(self._open.furthest_m, float(np.hypot(away[0], away[1]))),
            ours_matched=matched.ours / scans,
            theirs_matched=matched.theirs / scans,
        )
