"""How far one execution has come: its state and its step."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TypeVar

from mend.robots.execution.execution_state import EXECUTION, ExecutionState
from mend.robots.execution.monitor import BEFORE_FIRST_STEP
from mend.robots.execution.phase import Phase


@dataclass(slots=True, kw_only=True)
class Progress(ABC):
    """What walks an execution's steps and what watches them both go by.

    `step` counts from 1 and is 0 before the first.
    """

    state: ExecutionState = ExecutionState.PREPARING
    step: int = BEFORE_FIRST_STEP

    def move_to(self, state: ExecutionState) -> None:
        """Become this. Raises `IllegalTransitionError`."""
        self.state = EXECUTION.require(self.state, state)

    @property
    @abstractmethod
    def phase(self) -> Phase:
        """What the step under way is for."""


G = TypeVar("G", bound=Progress)
