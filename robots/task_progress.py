"""How far a robot is with what it does."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TaskProgress:
    """How far the behavior under way is: `fraction` in [0, 1] of `step`.

    `attempt` counts the starts of a behavior with this object from 1.
    """

    object: str | None
    step: int
    fraction: float
    attempt: int
