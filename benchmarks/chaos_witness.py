"""What clients of the service have seen and been told, in the words of the wire."""

from dataclasses import dataclass, field
from typing import Any, Literal

Outcome = Literal["accepted", "refused", "unknown"]
"""Unknown: the connection ended before the service answered."""


@dataclass(frozen=True, slots=True)
class AnswerAttempt:
    """Somebody answered a prompt; nobody else ever has this `helper` name."""

    helper: str
    prompt: str
    answer: str
    outcome: Outcome


@dataclass(frozen=True, slots=True)
class RunAttempt:
    """Somebody asked for a run; no other has this `seed`.

    `run` is its id, if that was told; `said` is why there is none.
    """

    seed: int
    outcome: Outcome
    run: str | None = None
    said: str = ""


@dataclass(slots=True)
class Witness:
    """Everything that was seen.

    `heard`: the events that came to each follower, in their order. `repeated`: how many requests
    were answered only when they came again under the same key.
    """

    heard: dict[str, list[dict[str, Any]]] = field(default_factory=dict)
    answers: list[AnswerAttempt] = field(default_factory=list)
    runs: list[RunAttempt] = field(default_factory=list)
    repeated: int = 0
