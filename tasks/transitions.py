"""State machines as tables: what each state takes, be it a call or the state that follows."""

from collections.abc import Collection, Mapping
from enum import StrEnum
from typing import Generic, TypeVar

from mend.errors import IllegalTransitionError

StateT = TypeVar("StateT", bound=StrEnum)
CallT = TypeVar("CallT", bound=StrEnum)


class Transitions(Generic[StateT, CallT]):
    """What a thing takes in each of its states; `what` names it in a sentence."""

    def __init__(self, what: str, taken: Mapping[StateT, Collection[CallT]]) -> None:
        self._what = what
        self._taken = taken

    def require(self, state: StateT, came: CallT) -> CallT:
        """What came. Raises `IllegalTransitionError` where the state does not take it."""
        taken = self._taken[state]
        if came not in taken:
            expected = " or ".join(taken) or "nothing more"
            raise IllegalTransitionError(self._what, state, came, expected)
        return came

    def is_last(self, state: StateT) -> bool:
        """Whether nothing can follow."""
        return not self._taken[state]
