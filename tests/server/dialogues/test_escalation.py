"""Who is idle is asked first, and an unanswered ask climbs a ladder that ends."""

from uuid import UUID

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from mend.server.dialogues.duty import Duty, WaitingQuestion
from mend.server.dialogues.escalation import (
    FIRST,
    NOBODY,
    EscalationPolicy,
    Exhausted,
    Mail,
    Repeat,
    Rung,
    Standing,
    ToHelper,
    first_helper,
    handed_on,
    next_rung,
)


def rungs(policy: EscalationPolicy, duty: Duty = NOBODY) -> list[Rung]:
    """Every rung, up to and with the one that says that nobody is left; nobody has other work."""
    climbed: list[Rung] = []
    asked: list[str | None] = [first_helper(policy, duty)]
    while not climbed or climbed[-1] != Exhausted():
        mailed = any(isinstance(each, Mail) for each in climbed)
        rung = next_rung(policy, Standing(tuple(asked), mailed), duty)
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
    assert rungs(policy, Duty(["dan", "ben", "ana"])) == [
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
    assert next_rung(policy, standing, Duty(["dan"])) == ToHelper("dan", 60.0)


def test_where_everybody_is_asked_nobody_is_called_once_more() -> None:
    assert rungs(EscalationPolicy(), Duty(["dan"])) == [Repeat(None, 60.0), Exhausted()]


def test_what_a_robot_does_not_wait_for_is_asked_of_somebody_who_is_there() -> None:
    policy = EscalationPolicy(helpers=("ana", "ben"))
    assert first_helper(policy, Duty(["dan", "ben"]), waits=False) == "ben"
    assert first_helper(policy, Duty(["dan"]), waits=False) == "dan"
    assert first_helper(policy, Duty(), waits=False) == "ana"
    assert first_helper(policy, Duty(["dan"], on=[(UUID(int=1), "dan")])) == "ana"
    busy = Duty(["dan"], questions=[WaitingQuestion(UUID(int=1), ["dan"])])
    assert first_helper(policy, busy, waits=False) == "dan"
    assert first_helper(policy, Duty(["dan"], on=[(UUID(int=1), "dan")]), waits=False) == "ana"


def put(number: int, *asked: str | None, may_go_on: bool = True) -> WaitingQuestion:
    return WaitingQuestion(UUID(int=number), asked, may_go_on)


TWO = EscalationPolicy(helpers=("ana", "ben"), repeats=1)


def test_who_is_idle_is_asked_before_who_is_busy() -> None:
    on = [(UUID(int=7), "ana")]
    assert first_helper(TWO, Duty(["ana", "ben"], on)) == "ben"
    assert first_helper(TWO, Duty(["ana", "dan"], on)) == "dan"
    assert first_helper(TWO, Duty(["ana"], on)) == "ben"
    assert first_helper(TWO, Duty(["ana", "ben"], questions=[put(1, "ana")])) == "ben"
    both = Duty(["ana", "ben"], on, [put(1, "ana"), put(2, "ben")])
    assert first_helper(TWO, both) == "ben"


def test_who_is_here_is_asked_before_who_is_away_and_who_is_away_before_who_is_busy() -> None:
    both = ["ben", "ana"]
    assert first_helper(TWO, Duty(both)) == "ana"
    assert first_helper(TWO, Duty(both, away=["ana"])) == "ben"
    assert first_helper(TWO, Duty(both, away=both)) == "ana"
    assert first_helper(TWO, Duty(both, [(UUID(int=7), "ben")], away=["ana"])) == "ana"
    # Of those who are not here, who hears a call: at a page that was left, or by a push.
    assert first_helper(TWO, Duty(["ben"], away=["ben"])) == "ben"
    assert first_helper(TWO, Duty(called=["ben"])) == "ben"
    assert first_helper(TWO, Duty(["ben"], away=["ben"], called=["ana"])) == "ana"
    # Somebody whom the policy does not name is asked where they are here, not where they were.
    assert first_helper(TWO, Duty(["dan"])) == "dan"
    assert first_helper(TWO, Duty(["dan"], away=["dan"])) == "ana"


def test_what_a_robot_does_not_wait_for_is_asked_of_who_is_here_first() -> None:
    assert first_helper(TWO, Duty(["ana", "ben"], away=["ana"]), waits=False) == "ben"
    assert first_helper(TWO, Duty(["dan"], away=["dan"]), waits=False) == "dan"


def test_who_is_away_is_called_though_later() -> None:
    assert rungs(TWO, Duty(["ana", "ben", "dan"], away=["ana"])) == [
        Repeat("ben", 60.0),
        ToHelper("dan", 60.0),
        ToHelper("ana", 60.0),
        ToHelper("ben", 60.0),
        ToHelper("dan", 60.0),
        Exhausted(),
    ]
    everybody = ["ana", "ben", "dan"]
    assert rungs(TWO, Duty(everybody, away=everybody)) == [
        Repeat("ana", 60.0),
        ToHelper("ben", 60.0),
        ToHelper("ana", 60.0),
        ToHelper("dan", 60.0),
        Exhausted(),
    ]


def test_a_question_goes_on_from_who_is_away_to_who_is_here_and_never_the_other_way() -> None:
    waiting = [put(1, "ana")]
    assert handed_on(TWO, Duty(["ana", "ben"], (), waiting, away=["ana"])) == {UUID(int=1): "ben"}
    assert handed_on(TWO, Duty(["ben"], (), waiting)) == {UUID(int=1): "ben"}
    assert handed_on(TWO, Duty(["ana", "ben"], (), waiting, away=["ana", "ben"])) == {}
    on = [(UUID(int=7), "ana")]
    assert handed_on(TWO, Duty(["ana", "ben"], on, waiting, away=["ben"])) == {}


def test_nobody_busy_is_asked_again_or_next_beside_somebody_idle() -> None:
    three = EscalationPolicy(helpers=("ana", "ben", "cem"), repeats=1)
    standing, on = Standing(("ana",)), [(UUID(int=7), "ana"), (UUID(int=8), "ben")]
    assert next_rung(three, standing, Duty(["ana", "cem"], on), UUID(int=1)) == ToHelper(
        "cem", 60.0
    )
    assert next_rung(three, standing, Duty(["ana"], on), UUID(int=1)) == Repeat("ana", 60.0)
    # What is asked of her itself is nothing that she has to do before.
    first = Duty(["ana", "cem"], questions=[put(1, "ana")])
    assert next_rung(three, standing, first, UUID(int=1)) == Repeat("ana", 60.0)
    again = Standing(("ana", "ana"))
    assert next_rung(three, again, Duty(["cem"], on)) == ToHelper("cem", 60.0)
    assert next_rung(three, again, Duty([], on)) == ToHelper("cem", 60.0)


def test_a_question_goes_on_from_who_is_busy_to_who_is_idle_the_first_one_first() -> None:
    questions = [put(1, "ana"), put(2, "ana"), put(3, "ana")]
    assert handed_on(TWO, Duty(["ana", "ben"], questions=questions)) == {UUID(int=2): "ben"}
    on = [(UUID(int=7), "ana")]
    both = Duty(["dan", "ana", "ben"], on, questions)
    assert handed_on(TWO, both) == {UUID(int=1): "ben", UUID(int=2): "dan"}
    assert handed_on(TWO, Duty(["ana"], on, questions)) == {}
    assert handed_on(EscalationPolicy(), Duty(["ben"], on, [put(1, None)])) == {}


def test_no_question_goes_on_that_somebody_is_at_or_to_who_was_asked_it() -> None:
    on, there = [(UUID(int=7), "ana")], ["ben"]
    assert handed_on(TWO, Duty(there, on, [put(1, "ana", may_go_on=False)])) == {}
    assert handed_on(TWO, Duty(there, on, [put(1, "ben", "ana")])) == {}


@given(
    there=st.lists(st.sampled_from("abcdef"), unique=True),
    on=st.lists(
        st.tuples(st.integers(100, 105).map(lambda n: UUID(int=n)), st.sampled_from("abcdef"))
    ),
    asked=st.lists(st.lists(st.sampled_from("abcdefg"), min_size=1, max_size=4), max_size=8),
    helpers=st.lists(st.sampled_from("abcdefg"), unique=True, min_size=1),
    left=st.sets(st.sampled_from("abcdefg")),
)
def test_no_question_waits_for_who_is_busy_or_away_while_somebody_is_idle(
    there: list[str],
    on: list[tuple[UUID, str]],
    asked: list[list[str]],
    helpers: list[str],
    left: set[str],
) -> None:
    policy = EscalationPolicy(helpers=tuple(helpers))
    questions = [put(number, *each) for number, each in enumerate(asked)]
    moves = 0
    while found := handed_on(policy, duty := Duty(there, on, questions, away=left)):
        # Whichever run is first.
        dialogue, to = next(iter(found.items()))
        assert to in duty.idle
        (moved,) = [each for each in questions if each.dialogue == dialogue]
        assert duty.rank(str(moved.helper), dialogue) > FIRST
        questions.remove(moved)
        questions.append(put(dialogue.int, *moved.asked, to))
        moves += 1
    assert moves <= len(asked) * len(there)
    for each in duty.questions:
        if duty.rank(str(each.helper), each.dialogue) > FIRST:
            assert set(duty.idle) <= set(each.asked)
    new = first_helper(policy, duty)
    assert new is not None
    assert not duty.idle or duty.rank(new) == FIRST


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
