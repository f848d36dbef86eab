"""An unanswered ask climbs a ladder that ends."""

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from mend.server.dialogues.escalation import (
    EscalationPolicy,
    Exhausted,
    Mail,
    Repeat,
    Rung,
    Standing,
    ToHelper,
    first_helper,
    next_rung,
)


def rungs(policy: EscalationPolicy, idle: Sequence[str] = ()) -> list[Rung]:
    """Every rung, up to and with the one that says that nobody is left."""
    climbed: list[Rung] = []
    asked: list[str | None] = [first_helper(policy)]
    while not climbed or climbed[-1] != Exhausted():
        mailed = any(isinstance(each, Mail) for each in climbed)
        rung = next_rung(policy, Standing(tuple(asked), mailed), idle)
        climbed.append(rung)
        asked.append(rung.helper if isinstance(rung, Repeat | ToHelper) else asked[-1])
    return climbed


def test_an_ask_is_repeated_then_goes_to_other_helpers_then_to_the_operators() -> None:
    policy = EscalationPolicy(
        helpers=("ana", "ben", "cem"),
        repeats=2,
        operators=("ops@example.org",),
        answer_within_s=30.0,
        mail_answer_within_s=900.0,
    )
    assert first_helper(policy) == "ana"
    assert rungs(policy) == [
        Repeat("ana", 30.0),
        Repeat("ana", 30.0),
        ToHelper("ben", 30.0),
        ToHelper("cem", 30.0),
        Mail(("ops@example.org",), 900.0),
        Exhausted(),
    ]


def test_without_named_helpers_everybody_is_asked_and_asked_again() -> None:
    policy = EscalationPolicy()
    assert first_helper(policy) is None
    assert rungs(policy) == [Repeat(None, 60.0), Exhausted()]


def test_an_ask_that_was_never_put_cannot_be_escalated() -> None:
    with pytest.raises(ValueError, match="1 or more prompts"):
        next_rung(EscalationPolicy(), Standing(()))


def test_before_it_is_mailed_it_goes_to_whoever_is_signed_in_and_was_not_asked_last() -> None:
    policy = EscalationPolicy(
        helpers=("ana", "ben"), repeats=1, operators=("ops@example.org",), answer_within_s=30.0
    )
    assert rungs(policy, idle=["dan", "ben", "ana"]) == [
        Repeat("ana", 30.0),
        ToHelper("ben", 30.0),
        ToHelper("dan", 30.0),
        ToHelper("ana", 30.0),
        Mail(("ops@example.org",), 600.0),
        Exhausted(),
    ]


def test_who_signs_in_after_the_operators_were_written_to_is_called_all_the_same() -> None:
    policy = EscalationPolicy(helpers=("ana",), repeats=0, operators=("ops@example.org",))
    standing = Standing(("ana", "ana"), mailed=True)
    assert next_rung(policy, standing) == Exhausted()
    assert next_rung(policy, standing, ["dan"]) == ToHelper("dan", 60.0)


def test_where_everybody_is_asked_nobody_is_called_once_more() -> None:
    assert rungs(EscalationPolicy(), idle=["dan"]) == [Repeat(None, 60.0), Exhausted()]


def test_what_a_robot_does_not_wait_for_is_asked_of_somebody_who_is_there() -> None:
    policy = EscalationPolicy(helpers=("ana", "ben"))
    assert first_helper(policy, ["dan", "ben"], waits=False) == "ben"
    assert first_helper(policy, ["dan"], waits=False) == "dan"
    assert first_helper(policy, [], waits=False) == "ana"
    assert first_helper(policy, ["dan"]) == "ana"


@given(
    helpers=st.lists(st.sampled_from("abcdef"), unique=True),
    repeats=st.integers(0, 5),
    operators=st.lists(st.just("ops@example.org"), max_size=1),
)
def test_every_ladder_ends_and_asks_every_helper(
    helpers: list[str], repeats: int, operators: list[str]
) -> None:
    policy = EscalationPolicy(helpers=tuple(helpers), repeats=repeats, operators=tuple(operators))
    climbed = rungs(policy)
    assert len(climbed) <= repeats + len(helpers) + len(operators) + 1
    asked = [first_helper(policy)] + [r.helper for r in climbed if isinstance(r, ToHelper)]
    assert asked == (list(policy.helpers) if helpers else [None])
    assert climbed[-1] == Exhausted()


@pytest.mark.parametrize("wrong", [{"repeats": -1}, {"answer_within_s": 0}, {"helper": "ana"}])
def test_a_wrong_policy_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        EscalationPolicy.model_validate(wrong)
