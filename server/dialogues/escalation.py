"""Whom an ask is put to, and its ladder: again, to the next helpers, by mail, and then nobody.

Every rung but the last is one prompt, so an ask's prompts say where it stands. Before the operators
are written to, and before it is given up, whoever is signed in and on nothing else is called once.
No ask waits for a helper who is busy with another one while somebody is idle.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated
from uuid import UUID

from pydantic import BaseModel, ConfigDict, Field

from mend.server.dialogues.duty import Duty

Deadline = Annotated[float, Field(gt=0.0, le=86_400.0, allow_inf_nan=False)]
HelperName = Annotated[str, Field(min_length=1, max_length=64)]


class EscalationPolicy(BaseModel):
    """Whom an ask goes to and for how long, in seconds of the run's clock.

    It is first put to the first of `helpers` (to everybody where none is named) and asked again
    `repeats` times, then goes to each other helper in turn, then to those who are signed in and
    were not asked last, then is mailed to `operators`. Whoever is idle is asked before who is busy.
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


NOBODY = Duty()
"""Nobody is there, and nothing is to be done."""

Rung = Repeat | ToHelper | Mail | Exhausted


@dataclass(frozen=True, slots=True)
class Standing:
    """How far an ask has come: whom each of its prompts was for, and whether the operators know."""

    asked: tuple[str | None, ...]
    mailed: bool = False


def first_helper(
    policy: EscalationPolicy, duty: Duty = NOBODY, *, waits: bool = True, answering: str = ""
) -> str | None:
    """Whom an ask is put to first; None is everybody.

    Who is `answering` its robot is asked what follows from that, as long as they are there. Else it
    is the first of the policy's helpers unless they have something to do before it: then somebody
    who is idle, or else who has the least to do. Where the robot does not wait, nobody else can be
    asked later, and so somebody is asked who is there.
    """
    if not policy.helpers:
        return None
    if answering in duty.there and not duty.before(answering):
        return answering
    if waits and not duty.before(policy.helpers[0]):
        return policy.helpers[0]
    if idle := _in_order(policy, duty.idle):
        return idle[0]
    there = [] if waits else _in_order(policy, duty.free)
    return _least_busy(there or policy.helpers, duty)


def next_rung(
    policy: EscalationPolicy,
    standing: Standing,
    duty: Duty = NOBODY,
    dialogue: UUID | None = None,
) -> Rung:
    """What follows when the last of an ask's prompts was not answered; `dialogue` is what it is of.

    Nobody is asked again or next who has something to do before it while somebody else is idle.
    Raises `ValueError` without a prompt: an ask that was never put cannot be escalated.
    """
    asked, within_s = standing.asked, policy.answer_within_s
    if not asked:
        raise ValueError("an ask has 1 or more prompts when it is escalated, not 0")
    again, idle = asked[-1], [each for each in _in_order(policy, duty.idle) if each not in asked]
    if len(asked) <= policy.repeats:
        if policy.helpers and again is not None and duty.before(again, dialogue) and idle:
            return ToHelper(idle[0], within_s)
        return Repeat(again, within_s)
    if unasked := [each for each in policy.helpers if each not in asked]:
        there = [each for each in unasked if each in duty.idle]
        return ToHelper(_least_busy(there or unasked, duty), within_s)
    asked_last = _last_round(policy, standing)
    if policy.helpers and (left := [each for each in duty.free if each not in asked_last]):
        there = [each for each in left if each in duty.idle]
        return ToHelper(_least_busy(there or left, duty), within_s)
    if policy.operators and not standing.mailed:
        return Mail(policy.operators, policy.mail_answer_within_s)
    return Exhausted()


def handed_on(policy: EscalationPolicy, duty: Duty) -> dict[UUID, str]:
    """Which questions go on at once to whom, so that none waits for somebody who is busy.

    The one that was put first goes to the first who is idle and was not asked it before, and so on.
    """
    idle, found = _in_order(policy, duty.idle), dict[UUID, str]()
    for question in duty.questions if policy.helpers else ():
        helper = question.helper
        if helper is None or not question.may_go_on or not duty.before(helper, question.dialogue):
            continue
        to = next((each for each in idle if each not in question.asked), None)
        if to is not None:
            idle.remove(to)
            found[question.dialogue] = to
    return found


def _in_order(policy: EscalationPolicy, helpers: Sequence[str]) -> list[str]:
    """Those of the policy as it has them, then the others."""
    known = [each for each in policy.helpers if each in helpers]
    return [*known, *(each for each in helpers if each not in known)]


def _least_busy(helpers: Sequence[str], duty: Duty) -> str:
    return min(helpers, key=duty.before)


def _last_round(policy: EscalationPolicy, standing: Standing) -> Sequence[str | None]:
    """Who was asked since the last of the policy's helpers was, that one included."""
    heard = set[str | None]()
    for number, each in enumerate(standing.asked):
        heard.add(each)
        if number >= policy.repeats and heard.issuperset(policy.helpers):
            return standing.asked[number:]
    return standing.asked
