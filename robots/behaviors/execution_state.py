"""The states of an execution, and which may follow which."""

from enum import StrEnum


class ExecutionState(StrEnum):
    """What an execution is doing."""

    PREPARING = "preparing"
    """Before step 1: the arm gets out of the camera's way, the object is looked for."""
    RUNNING = "running"
    BACKING_OFF = "backing_off"
    """Something was felt: the arm goes back the way it came, to look or to try again gently."""
    CONFIRMING = "confirming"
    """After the last step: the arm gets out of the camera's way, the object is looked for."""
    RETREATING = "retreating"
    """On the way to neutral."""
    HOLDING = "holding"
    """Stopped; it can be resumed."""
    FINISHED = "finished"
    ENDED = "ended"
    """Given up at the service's command."""


class ExecutionTransitionError(Exception):
    """An execution was told to do what its state does not allow; the message says both."""


_NEXT: dict[ExecutionState, frozenset[ExecutionState]] = {
    ExecutionState.PREPARING: frozenset(
        {
            ExecutionState.RUNNING,
            ExecutionState.RETREATING,
            ExecutionState.HOLDING,
            ExecutionState.FINISHED,
            ExecutionState.ENDED,
        }
    ),
    ExecutionState.RUNNING: frozenset(
        {
            ExecutionState.BACKING_OFF,
            ExecutionState.CONFIRMING,
            ExecutionState.RETREATING,
            ExecutionState.HOLDING,
            ExecutionState.FINISHED,
        }
    ),
    ExecutionState.BACKING_OFF: frozenset(
        {
            ExecutionState.PREPARING,
            ExecutionState.RUNNING,
            ExecutionState.RETREATING,
            ExecutionState.HOLDING,
        }
    ),
    ExecutionState.CONFIRMING: frozenset(
        {
            ExecutionState.PREPARING,
            ExecutionState.RETREATING,
            ExecutionState.HOLDING,
            ExecutionState.FINISHED,
        }
    ),
    ExecutionState.RETREATING: frozenset({ExecutionState.HOLDING, ExecutionState.ENDED}),
    ExecutionState.HOLDING: frozenset(
        {ExecutionState.PREPARING, ExecutionState.RETREATING, ExecutionState.ENDED}
    ),
    ExecutionState.FINISHED: frozenset(),
    ExecutionState.ENDED: frozenset(),
}


def is_over(state: ExecutionState) -> bool:
    """Whether nothing can follow."""
    return not _NEXT[state]


def follow(state: ExecutionState, wanted: ExecutionState) -> ExecutionState:
    """The wanted state. Raises `ExecutionTransitionError` if it may not follow this one."""
    if wanted not in _NEXT[state]:
        expected = " or ".join(sorted(_NEXT[state])) or "nothing more"
        raise ExecutionTransitionError(
            f"an execution that is {state} can become {expected}, not {wanted}"
        )
    return wanted
