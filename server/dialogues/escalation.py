"""The ladder of an unanswered ask: again, to the next helpers, by mail, and then nobody.

Every rung but the last is one prompt, so the number of an ask's prompts says where it stands.
"""

from dataclasses import dataclass
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Deadline = Annotated[float, Field(gt=0.0, le=86_400.0, allow_inf_nan=False)]
HelperName = Annotated[str, Field(min_length=1, max_length=64)]


class EscalationPolicy(BaseModel):
    """Whom an ask goes to and for how long, in seconds of the run's clock.

    It is first put to the first of `helpers` (to everybody where none is named) and asked again
    `repeats` times, then goes to each other helper in turn, then is mailed to `operators`.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    helpers: Annotated[tuple[HelperName, ...], Field(max_length=64)] = ()
    repeats: Annotated[int, Field(ge=0, le=100)] = 1
    operators: Annotated[tuple[str, ...], Field(max_length=64)] = ()
    answer_within_s: Deadline = 60.0
    mail_answer_within_s: Deadline = 600.0


@dataclass(frozen=True, slots=True)
class Repeat:
    """Ask the same helper again (everybody, where `helper` is None)."""

    helper: str | None
    answer_within_s: float


@dataclass(frozen=True, slots=True)
class ToHelper:
    """Ask another helper."""

    helper: str
    answer_within_s: float


@dataclass(frozen=True, slots=True)
class Mail:
    """Write to the operators."""

    addresses: tuple[str, ...]
    answer_within_s: float


@dataclass(frozen=True, slots=True)
class Exhausted:
    """Nobody is left to ask."""


Rung = Repeat | ToHelper | Mail | Exhausted


def first_helper(policy: EscalationPolicy) -> str | None:
    """Whom an ask is put to first; None is everybody."""
    return policy.helpers[0] if policy.helpers else None


def next_rung(policy: EscalationPolicy, prompts: int) -> Rung:
    """What follows when the last of an ask's `prompts` prompts (1 or more) was not answered.

    Raises `ValueError` below 1: an ask that was never put cannot be escalated.
    """
    if prompts < 1:
        raise ValueError(f"an ask has 1 or more prompts when it is escalated, not {prompts}")
    within_s = policy.answer_within_s
    ladder: list[Rung] = [Repeat(first_helper(policy), within_s)] * policy.repeats
    ladder += [ToHelper(helper, within_s) for helper in policy.helpers[1:]]
    if policy.operators:
        ladder.append(Mail(policy.operators, policy.mail_answer_within_s))
    return ladder[prompts - 1] if prompts <= len(ladder) else Exhausted()
