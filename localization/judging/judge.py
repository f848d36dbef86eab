"""Judges another localizer's poses step by step, beside a localizer of our own.

It is lost where its pose is farther from ours than `LOST_M` or `LOST_RAD` (as everywhere in Mend),
ours is not in doubt, and the scans speak clearly for ours. Where they speak for its pose, our
track was the wrong one: it is set to the other's, and nothing is said of that.
"""

from dataclasses import dataclass

import numpy as np

from mend.localization.beam_model import BeamModel, Beams
from mend.localization.evaluation import LOST_M, LOST_RAD
from mend.localization.judging.contest import Contest, Hypothesis
from mend.localization.judging.memory import MakeLocalizer, Memory, Past
from mend.localization.judging.stretches import Stretches
from mend.localization.judging.verdict import Judgement, Moment, Standing
from mend.localization.localizer import Estimate
from mend.localization.logs.log import LogStep
from mend.localization.pose import Poses, compose, relative
from mend.maps.vector_map import VectorMap

_WEIGHED_EVERY_M = 0.1
_WEIGHED_EVERY_RAD = np.radians(30.0)
"""Scans from one place say the same again, of a wall that is gone too: only another side is new."""
_AGAIN = 0.5
"""Two tracks agree again once they are within this share of what parted them."""


@dataclass(slots=True)
class _Run:
    """What has come together since the tracks parted, or since ours is in doubt."""

    contest: Contest
    since: Moment
    apart: bool


class Judge:
    """Takes one step after the other; `judgement` is what is to be said of all so far."""

    def __init__(
        self, vector_map: VectorMap, make: MakeLocalizer, elsewhere: Poses, first_step: int = 0
    ) -> None:
        """`make` makes a localizer like ours, to look back with.

        `elsewhere` are poses (n, 3) by which "the robot is somewhere else" is weighed.
        """
        self._first_step = first_step
        self._make = make
        self._model = BeamModel(vector_map)
        self._elsewhere = elsewhere
        self._memory = Memory()
        self._stretches = Stretches(self._model)
        self._moments: list[Moment] = []
        self._standings: list[Standing] = []
        self._corrected: list[int] = []
        self._run: _Run | None = None
        self._unweighed = np.array([np.inf, np.inf])
        self._jumped = False
        self._to_correct: Poses | None = None

    def take(self, step: LogStep, theirs: Poses, estimate: Estimate) -> Standing:
        """The next step: what was driven and seen, the other's pose (NaN: none), and ours."""
        past = self._remembered(step, theirs, estimate)
        self._memory.add(past)
        standing = self._standing(past, estimate)
        self._moments.append(past.moment)
        self._standings.append(standing)
        return standing

    def correction(self) -> Poses | None:
        """Where our localizer has to be reset to before the next step, if it was proven wrong."""
        pose, self._to_correct = self._to_correct, None
        return pose

    def judgement(self) -> Judgement:
        """What is to be said of the steps so far."""
        stretches = self._stretches.all()
        # What was still open then may have become clear since.
        standings = list(self._standings)
        for each in stretches:
            first = each.since.step - self._first_step
            last = len(standings)
            if each.until is not None:
                last = each.until.step - self._first_step
            standings[first:last] = [each.standing] * (last - first)
        return Judgement(
            stretches,
            tuple(standings),
            np.array([each.ours for each in self._moments]).reshape(-1, 3),
            np.array([each.theirs for each in self._moments]).reshape(-1, 3),
            tuple(each.along_m for each in self._moments),
            tuple(each.time_s for each in self._moments),
            tuple(self._corrected),
            self._first_step,
        )

    def _remembered(self, step: LogStep, theirs: Poses, estimate: Estimate) -> Past:
        moved = np.array([np.hypot(step.odometry[0], step.odometry[1]), abs(step.odometry[2])])
        along_m = (self._moments[-1].along_m if self._moments else 0.0) + float(moved[0])
        self._unweighed += moved
        weighed = bool(
            self._unweighed[0] >= _WEIGHED_EVERY_M or self._unweighed[1] >= _WEIGHED_EVERY_RAD
        )
        if weighed:
            self._unweighed[:] = 0.0
        moment = Moment(
            self._first_step + len(self._moments), step.scan.time_s, along_m, estimate.pose, theirs
        )
        return Past(moment, step.odometry, step.scan, self._model.beams_of(step.scan), weighed)

    def _standing(self, past: Past, estimate: Estimate) -> Standing:
        moment = past.moment
        if not np.isfinite(moment.theirs).all():
            self._agree(moment)
            return Standing.UNKNOWN
        apart = self._are_apart(moment)
        if not apart and not estimate.is_lost:
            self._agree(moment)
            return Standing.HOLDS
        run = self._run
        if run is None or run.apart != apart:
            run = self._run = _Run(Contest() if apart else Contest.of_agreement(), moment, apart)
            if not apart:
                self._stretches.end(moment)
        self._jumped |= self._jumps(past)
        if apart and self._jumped and not estimate.is_lost and not self._stretches.says_lost:
            run = self._run = self._looked_back()
        elif past.weighed:
            run.contest.weigh(self._likelihoods(moment, past.beams, apart))
        return self._decided(run, past, in_doubt=estimate.is_lost)

    def _decided(self, run: _Run, past: Past, *, in_doubt: bool) -> Standing:
        match run.contest.winner():
            case Hypothesis.OURS if run.apart and not in_doubt:
                self._stretches.go_on(Standing.LOST, run.since, past)
                return Standing.LOST
            case Hypothesis.NEITHER:
                self._stretches.go_on(Standing.NEITHER, run.since, past)
                return Standing.NEITHER
            case Hypothesis.THEIRS:
                if run.apart:
                    self._to_correct = past.moment.theirs
                    self._corrected.append(past.moment.step)
                self._agree(past.moment)
                return Standing.HOLDS
            case _:
                return self._stretches.undecided(past)

    def _are_apart(self, moment: Moment) -> bool:
        """Whether the tracks are apart, by a narrower measure once they were."""
        share = _AGAIN if self._run is not None and self._run.apart else 1.0
        away = relative(moment.ours, moment.theirs)
        beyond_m, beyond_rad = share * LOST_M, share * LOST_RAD
        return bool(np.hypot(away[0], away[1]) > beyond_m or abs(away[2]) > beyond_rad)

    def _agree(self, moment: Moment) -> None:
        self._run = None
        self._jumped = False
        self._stretches.end(moment)

    def _jumps(self, past: Past) -> bool:
        """Whether our track was somewhere else a step ago: it found itself anew."""
        if not self._moments:
            return False
        foretold = compose(self._moments[-1].ours, past.motion)
        away = relative(foretold, past.moment.ours)
        return bool(np.hypot(away[0], away[1]) > LOST_M or abs(away[2]) > LOST_RAD)

    def _looked_back(self) -> _Run:
        """Weigh the last metres anew, as they are seen from where our track now is."""
        steps = self._memory.look_back(self._make, self._model)
        run = _Run(Contest(), steps[0].moment, apart=True)
        for each in steps:
            if each.weighed and np.isfinite(each.moment.theirs).all():
                run.contest.weigh(self._likelihoods(each.moment, each.beams, apart=True))
        self._jumped = False
        self._stretches.take_back(run.since)
        return run

    def _likelihoods(self, moment: Moment, beams: Beams, apart: bool) -> np.ndarray:
        """What a scan says of the three hypotheses; two poses that agree are one of them."""
        theirs = self._model.log_likelihood(moment.theirs, beams)
        ours = self._model.log_likelihood(moment.ours, beams) if apart else -np.inf
        elsewhere = np.array([self._model.log_likelihood(each, beams) for each in self._elsewhere])
        most = elsewhere.max()
        neither = most + np.log(np.exp(elsewhere - most).mean())
        return np.array([ours, theirs, neither])
