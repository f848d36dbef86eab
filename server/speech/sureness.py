"""How sure it has to be what was said before it counts.

The figures were set with the tuned voices and phrases of `benchmarks/speech.py`.
"""

from collections.abc import Sequence

import numpy as np

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Hypothesis

QUIET_MARGIN = 0.03
NOISY_MARGIN = 0.035
NOISY_BELOW_DB = 17.0
"""Where a voice stands out less from what else is to be heard, more resembles a command."""

MORE_MARGIN = 0.03
"""For what is no answer: help, repeat and stop are what noise and other words are taken for, and
there is a button for each."""

ANSWERS = (Command.YES, Command.NO, Command.DONE)
"""The last of these makes the robot look, and no more."""


def is_sure(hypothesis: Hypothesis, levels_db: Sequence[float]) -> bool:
    """Whether an utterance counts as the command that it probably was.

    `levels_db` are those of its frames, from a little before it to a little after it.
    """
    if hypothesis.command is None:
        return False
    margin = NOISY_MARGIN if stands_out_db(levels_db) < NOISY_BELOW_DB else QUIET_MARGIN
    if hypothesis.command not in ANSWERS:
        margin += MORE_MARGIN
    return hypothesis.margin >= margin


def stands_out_db(levels_db: Sequence[float]) -> float:
    """By how much the voice is louder than what is to be heard without it."""
    silence_db, voice_db = np.percentile(levels_db, (10, 90))
    return float(voice_db - silence_db)
