"""A whole recorded drive judged: our localizer and another's poses side by side."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mend.errors import WrongInputError
from mend.localization.judging.judge import Judge
from mend.localization.judging.memory import MakeLocalizer
from mend.localization.judging.verdict import Judgement
from mend.localization.localizer import Estimate
from mend.localization.logs.log import RecordedDrive
from mend.localization.pose import Poses
from mend.maps.vector_map import VectorMap

_ELSEWHERE = 64
"""Poses by which "the robot is somewhere else" is weighed."""


def judge_drive(
    drive: RecordedDrive,
    theirs: Poses,
    vector_map: VectorMap,
    make: MakeLocalizer,
    start: Poses | None = None,
    on_estimate: Callable[[int, Estimate], None] | None = None,
) -> Judgement:
    """Judge the poses (n, 3; NaN: none) that another localizer told at the steps of a drive.

    Ours begins at `start`, or else with the other's first pose. Raises `WrongInputError` where
    that told none.
    """
    known = np.flatnonzero(np.isfinite(theirs).all(axis=1))
    if not len(known):
        raise WrongInputError(f"{drive.name}: the localizer that is to be judged tells no pose")
    first = 0 if start is not None else int(known[0])
    localizer = make()
    localizer.reset(theirs[first] if start is None else start)
    judge = Judge(vector_map, make, _elsewhere(theirs[known]), first)
    for number, step in enumerate(drive.steps):
        if number < first:
            continue
        # The start is where the first scan was seen.
        if number == first:
            step = replace(step, odometry=np.zeros(3))
        estimate = localizer.update(step.odometry, step.scan)
        if on_estimate is not None:
            on_estimate(number, estimate)
        judge.take(step, theirs[number], estimate)
        if (correction := judge.correction()) is not None:
            localizer.reset(correction)
    return judge.judgement()


def _elsewhere(told: Poses) -> Poses:
    """Where a robot may be: along the way that was told, whichever way it faces there.

    Places drawn from the whole map would lie outside of its walls too, and there no wall is ever
    seen through: what a right pose has against it.
    """
    spread = np.linspace(0, len(told) - 1, _ELSEWHERE).round().astype(np.int64)
    poses = told[spread].copy()
    poses[:, 2] = np.random.default_rng(1).uniform(-np.pi, np.pi, _ELSEWHERE)
    return poses
