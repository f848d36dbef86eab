"""What is said of things that robots carry: only what a load cell felt, and whom somebody heard."""

import pytest

from mend.dialogue.conversation import Conversation
from mend.dialogue.evidence import Change, LookOutcome, PutRight, change_between, put_right
from mend.dialogue.outlook import Next, Outlook, Sequel
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, AwaitHelp, Close, CloseReason, Expectation, Felt, Help, Remark
from mend.tasks.issue import Issue
from mend.tasks.resolution import Resolution

SCRIPTS = load_scripts()
CARRYING = (
    "item_not_given",
    "item_not_taken",
    "item_taken",
    "item_missing",
    "nobody_answers",
    "low_battery",
)


def conversation(
    kind: str,
    *,
    reason: str = "I have come to F1-101 to collect the mail",
    message: str | None = None,
    outlook: Outlook | None = None,
    held_by: str | None = None,
    away_m: float | None = None,
) -> Conversation:
    issue = Issue(
        kind=kind,
        robot="robot1",
        node="/0",
        name="carry",
        object=None,
        place="F1-101",
        step=2,
        reason=reason,
        item="post_bag",
        message=message,
        held_by=held_by,
        away_m=away_m,
    )
    return Conversation(SCRIPTS[kind], issue, outlook or Outlook())


def asked(turns: list[object]) -> Ask:
    return next(each for each in turns if isinstance(each, Ask))


def said(turns: list[object]) -> str:
    return " ".join(each.text for each in turns if isinstance(each, Remark))


def closed(turns: list[object]) -> Close:
    return next(each for each in turns if isinstance(each, Close))


def test_an_item_is_asked_for_by_its_name() -> None:
    ask = asked(list(conversation("item_not_given").open()))
    assert ask.text == (
        "Please put the post bag into my basket. I have come to F1 101 to collect the mail. "
        "Will you do that?"
    )
    assert ask.yes_final


def test_what_is_in_the_basket_of_another_robot_is_asked_for_there() -> None:
    talk = conversation("item_not_given", held_by="robot_2")
    ask = asked(list(talk.open()))
    assert ask.text == (
        "Please take the post bag out of the basket of robot 2 and put it into mine. "
        "I have come to F1 101 to collect the mail. Will you do that?"
    )
    assert "take the post bag out of the basket of robot 2 and put it into mine" in ask.yes_effect
    of_a_site = conversation("item_not_given", held_by="robot2-0afba7d8")
    assert "out of the basket of robot2 and put" in asked(list(of_a_site.open())).text
    near = conversation("item_not_given", held_by="robot2", away_m=4.0)
    assert "out of the basket of robot2 and put" in asked(list(near.open())).text
    far = conversation("item_not_given", held_by="robot2", away_m=33.4)
    assert (
        "take the post bag out of the basket of robot2, which stands about 35 m from here, and put "
        "it into mine"
    ) in asked(list(far.open())).text
    assert "I wait until I feel something new in my basket." in said(list(talk.answer("yes")))


@pytest.mark.parametrize(
    ("kind", "promised", "thanks"),
    [
        ("item_not_given", Help.PUT_IN, "Thank you. I feel something new in my basket. I go on."),
        ("item_not_taken", Help.TAKE_OUT, "Thank you. I feel that my basket is lighter. I go on."),
        ("item_taken", Help.PUT_IN, "Thank you. My basket weighs what it did. I go on."),
        (
            "low_battery",
            Help.CHARGE,
            "Thank you. I feel current. I go on once my battery holds enough.",
        ),
    ],
)
def test_a_promise_is_watched_for_and_thanked_for_once_it_is_felt(
    kind: str, promised: Help, thanks: str
) -> None:
    talk = conversation(kind)
    talk.open()
    assert AwaitHelp(promised) in talk.answer("yes")
    turns = list(talk.help_seen(Change.LOADED))
    assert said(turns) == thanks
    assert closed(turns) == Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, helped=True)


@pytest.mark.parametrize(
    ("kind", "felt", "begins"),
    [
        ("item_not_given", Felt.NOTHING, "I feel nothing new in my basket."),
        ("item_not_given", Felt.TOO_LITTLE, "I feel very little that is new in my basket"),
        ("item_not_given", Felt.TOO_MUCH, "My basket is heavier now than I can carry."),
        ("item_not_given", Felt.LIGHTER, "My basket is lighter than it was, not heavier."),
        ("item_not_taken", Felt.NOTHING, "I do not feel my basket any lighter."),
        ("item_not_taken", Felt.HEAVIER, "My basket is heavier than it was, not lighter."),
        ("item_not_taken", Felt.ANOTHER, "My basket is lighter, but not by as much as when I"),
        ("item_taken", Felt.LIGHTER, "My basket is still lighter than it was."),
    ],
)
def test_what_is_felt_instead_is_said(kind: str, felt: Felt, begins: str) -> None:
    talk = conversation(kind)
    talk.open()
    talk.answer("yes")
    assert asked(list(talk.help_not_seen(felt))).text.startswith(begins)


@pytest.mark.parametrize("kind", ["item_not_given", "item_not_taken", "item_taken"])
def test_nobody_is_thanked_for_what_was_never_felt(kind: str) -> None:
    talk = conversation(kind)
    talk.open()
    talk.answer("yes")
    turns: list[object] = []
    while not any(isinstance(each, Close) for each in turns):
        turns = list(talk.help_not_seen(Felt.NOTHING))
        if not any(isinstance(each, Close) for each in turns):
            turns = list(talk.answer("yes"))
    assert "Thank" not in said(turns)
    assert closed(turns).reason is CloseReason.GAVE_UP
    assert "still" in said(turns)
    assert " see " not in said(turns)


def test_a_message_is_told_word_for_word_and_taken_for_heard_on_somebodys_word() -> None:
    talk = conversation("nobody_answers", message="Come to room_7 {now}, 10-12.", reason="")
    ask = asked(list(talk.open()))
    assert ask.text == (
        'I have a message for F1 101: "Come to room_7 {now}, 10-12." Have you heard it there?'
    )
    turns = list(talk.answer("yes"))
    assert closed(turns) == Close(CloseReason.RESOLVED, Resolution.ROBOT_FINISH, helped=True)


def test_a_message_that_nobody_confirms_fails() -> None:
    ends = Outlook(attempt=3, failed=Sequel(Next.RUN_FAILS))
    talk = conversation("nobody_answers", message="Hello.", outlook=ends)
    talk.open()
    turns = list(talk.silence())
    assert said(turns) == "I heard no answer. The task ends here, unfinished."
    assert closed(turns).failed


def test_who_was_given_nothing_asks_to_leave_it_out() -> None:
    talk = conversation("item_missing")
    assert asked(list(talk.open())).text.startswith("I am to hand over the post bag at F1 101, but")
    assert closed(list(talk.answer("yes"))).reason is CloseReason.LEFT_OUT


@pytest.mark.parametrize(
    ("expected", "change"),
    [
        (Expectation.LOADED, Change.LOADED),
        (Expectation.UNLOADED, Change.UNLOADED),
        (Expectation.CHARGED, Change.CHARGED),
    ],
)
def test_a_basket_that_weighs_what_it_must_tells_of_a_person(
    expected: Expectation, change: Change
) -> None:
    before, now = LookOutcome(frozenset(), None), LookOutcome(frozenset({expected}), None)
    assert change_between(before, now) is change
    assert change.by_a_person
    assert put_right((expected,), before, now) == PutRight(expected, change)
    assert put_right((expected,), now, now) is None


@pytest.mark.parametrize("kind", CARRYING)
def test_every_question_about_things_says_what_each_answer_does(kind: str) -> None:
    ask = asked(list(conversation(kind, message="Hello.").open()))
    assert ask.yes_effect
    assert ask.no_effect
    assert ask.timeout_effect.startswith("Attempt 1 of 3 has failed")
