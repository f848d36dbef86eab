"""The ladder of an unanswered ask: again, to the next helpers, by mail, and then nobody.

Every rung but the last is one prompt, so an ask's prompts say where it stands. Before the operators
are written to, and before it is given up, whoever is signed in and on nothing else is called once.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Deadline = Annotated[float, Field(gt=0.0, le=86_400.0, allow_inf_nan=False)]
HelperName = Annotated[str, Field(min_length=1, max_length=64)]


class EscalationPolicy(BaseModel):
    """Whom an ask goes to and for how long, in seconds of the run's clock.

    It is first put to the first of `helpers` (to everybody where none is named) and asked again
    `repeats` times, then goes to each other helper in turn, then to those who are signed in and
    were not asked last, then is mailed to `operators`.
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


@dataclass(frozen=True, slots=True)
class Standing:
    """How far an ask has come: whom each of its prompts was for, and whether the operators know."""

    asked: tuple[str | None, ...]
    mailed: bool = False


def first_helper(
    policy: EscalationPolicy, idle: Sequence[str] = (), *, waits: bool = True
) -> str | None:
    """Whom an ask is put to first; None is everybody.

    Where the robot does not wait nobody else can be asked later: of `idle`, who are signed in and
    on nothing else, one is asked rather than a helper who is not.
    """
    if not policy.helpers:
        return None
    if waits or not idle:
        return policy.helpers[0]
    return next((each for each in policy.helpers if each in idle), idle[0])


def next_rung(policy: EscalationPolicy, standing: Standing, idle: Sequence[str] = ()) -> Rung:
    """What follows when the last of an ask's prompts was not answered.

    `idle`: who is signed in and on nothing else. Raises `ValueError` without a prompt: an ask that
    was never put cannot be escalated.
    """
    prompts, within_s = len(standing.asked), policy.answer_within_s
    if prompts < 1:
        raise ValueError("an ask has 1 or more prompts when it is escalated, not 0")
    ladder: list[Rung] = [Repeat(first_helper(policy), within_s)] * policy.repeats
    ladder += [ToHelper(helper, within_s) for helper in policy.helpers[1:]]
    if prompts <= len(ladder):
        return ladder[prompts - 1]
    asked_last = standing.asked[len(ladder) :]
    if policy.helpers and (unasked := [each for each in idle if each not in asked_last]):
        return ToHelper(unasked[0], within_s)
    if policy.operators and not standing.mailed:
        return Mail(policy.operators, policy.mail_answer_within_s)
    return Exhausted()
