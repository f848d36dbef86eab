"""An unanswered ask climbs a ladder that ends."""

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
    ToHelper,
    first_helper,
    next_rung,
)


def rungs(policy: EscalationPolicy) -> list[Rung]:
    """Every rung, up to and with the one that says that nobody is left."""
    climbed: list[Rung] = []
    while not climbed or climbed[-1] != Exhausted():
        climbed.append(next_rung(policy, prompts=len(climbed) + 1))
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
        next_rung(EscalationPolicy(), prompts=0)


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
    assert next_rung(policy, prompts=len(climbed) + 1) == Exhausted()


@pytest.mark.parametrize("wrong", [{"repeats": -1}, {"answer_within_s": 0}, {"helper": "ana"}])
def test_a_wrong_policy_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        EscalationPolicy.model_validate(wrong)
