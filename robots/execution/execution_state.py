"""The states of an execution, and which may follow which."""

from enum import StrEnum

from mend.tasks.transitions import Transitions


class ExecutionState(StrEnum):
    """What an execution is doing."""

    PREPARING = "preparing"
    """Before step 1: what is to be known is looked for; an arm gets out of its camera's way."""
    RUNNING = "running"
    BACKING_OFF = "backing_off"
    """Something was met: it goes back the way it came, to look or to try again gently."""
    CONFIRMING = "confirming"
    """After the last step: whether the result is there."""
    RETREATING = "retreating"
    """On the way to where it is in nobody's way (an arm: neutral)."""
    HOLDING = "holding"
    """Stopped; it can be resumed."""
    FINISHED = "finished"
    ENDED = "ended"
    """Given up at the service's command."""


_S = ExecutionState

EXECUTION = Transitions(
    "the execution",
    {
        _S.PREPARING: (_S.RUNNING, _S.RETREATING, _S.HOLDING, _S.FINISHED, _S.ENDED),
        _S.RUNNING: (_S.BACKING_OFF, _S.CONFIRMING, _S.RETREATING, _S.HOLDING, _S.FINISHED),
        _S.BACKING_OFF: (_S.PREPARING, _S.RUNNING, _S.RETREATING, _S.HOLDING),
        _S.CONFIRMING: (_S.PREPARING, _S.RETREATING, _S.HOLDING, _S.FINISHED),
        _S.RETREATING: (_S.HOLDING, _S.ENDED),
        _S.HOLDING: (_S.PREPARING, _S.RETREATING, _S.ENDED),
        _S.FINISHED: (),
        _S.ENDED: (),
    },
)
"""Which state may follow which."""
