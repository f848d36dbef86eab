"""Whom an ask is put to, and its ladder: again, to the next helpers, by mail, and then nobody.

Every rung but the last is one prompt, so an ask's prompts say where it stands. Before the operators
are written to, and before it is given up, whoever is signed in and on nothing else is called once.
No ask waits for a helper who is busy with another one, or away, while somebody is here and idle.
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
    were not asked last, then is mailed to `operators`. Whoever is idle is asked before who is busy,
    and of those who are idle who is here before who is away.
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

FIRST = (0, 0)
"""The rank of who is here and has nothing to do before."""

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
    is who ranks first of the policy's helpers and of those who are here and idle. Where the robot
    does not wait, nobody else can be asked later, and so somebody is asked who is there.
    """
    if not policy.helpers:
        return None
    if answering in duty.there and not duty.before(answering):
        return answering
    there = [] if waits else _in_order(policy, duty.free)
    return min(there or _askable(policy, duty.idle), key=duty.rank)


def next_rung(
    policy: EscalationPolicy,
    standing: Standing,
    duty: Duty = NOBODY,
    dialogue: UUID | None = None,
) -> Rung:
    """What follows when the last of an ask's prompts was not answered; `dialogue` is what it is of.

    Nobody is asked again or next who is away or has something to do before it while somebody else
    is here and idle. Raises `ValueError` without a prompt: an ask that was never put cannot be
    escalated.
    """
    asked, within_s = standing.asked, policy.answer_within_s
    if not asked:
        raise ValueError("an ask has 1 or more prompts when it is escalated, not 0")
    again, idle = asked[-1], [each for each in _in_order(policy, duty.idle) if each not in asked]
    if len(asked) <= policy.repeats:
        if policy.helpers and again is not None and duty.rank(again, dialogue) > FIRST and idle:
            return ToHelper(idle[0], within_s)
        return Repeat(again, within_s)
    if any(each not in asked for each in policy.helpers):
        unasked = [each for each in _askable(policy, idle) if each not in asked]
        return ToHelper(min(unasked, key=duty.rank), within_s)
    asked_last = _last_round(policy, standing)
    if policy.helpers and (left := [each for each in duty.free if each not in asked_last]):
        return ToHelper(min(left, key=duty.rank), within_s)
    if policy.operators and not standing.mailed:
        return Mail(policy.operators, policy.mail_answer_within_s)
    return Exhausted()


def handed_on(policy: EscalationPolicy, duty: Duty) -> dict[UUID, str]:
    """Which questions go on at once to whom, so that none waits for somebody who is busy or away.

    The one that was put first goes to the first who is here, idle and was not asked it before, and
    so on. None goes on to who is away: who is here may be done sooner than they come.
    """
    idle, found = _in_order(policy, duty.idle), dict[UUID, str]()
    for question in duty.questions if policy.helpers else ():
        helper = question.helper
        if helper is None or not question.may_go_on:
            continue
        if duty.rank(helper, question.dialogue) == FIRST:
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


def _askable(policy: EscalationPolicy, idle: Sequence[str]) -> list[str]:
    """The policy's helpers, then who else is idle."""
    return [*policy.helpers, *(each for each in idle if each not in policy.helpers)]


def _last_round(policy: EscalationPolicy, standing: Standing) -> Sequence[str | None]:
    """Who was asked since the last of the policy's helpers was, that one included."""
    heard = set[str | None]()
    for number, each in enumerate(standing.asked):
        heard.add(each)
        if number >= policy.repeats and heard.issuperset(policy.helpers):
            return standing.asked[number:]
    return standing.asked
