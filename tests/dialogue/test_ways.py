"""Every way of help may be chosen at once: it is the answers that lead to it, and nothing else."""

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import pytest

from mend.dialogue.calls import ConversationPhase
from mend.dialogue.conversation import Conversation
from mend.dialogue.outlook import Next, Outlook, Sequel
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, CloseState, Felt, Remark, Script, Turn, Way
from mend.tasks.issue import Issue, Sensed
from mend.tasks.resolution import Resolution

SCRIPTS = load_scripts()
OUTLOOKS = {
    "first": Outlook(),
    "again": Outlook(attempt=2, times=2),
    "last": Outlook(attempt=3, failed=Sequel(Next.RUN_FAILS), times=3, unchanged=3),
    "helped out": Outlook(attempt=2, times=3, helped_out=True),
}
PART = Issue(
    kind="dropped",
    robot="pr2",
    node="/0/1",
    name="pink_bar",
    object="pink_bar",
    place="tray",
    step=5,
    guesses=("at F1 101", "at F1 103", "near F2 204"),
    message="Lunch is ready",
    person="Dr Lee",
)
ISSUES = {
    "a part": PART,
    "felt": replace(PART, sensed=Sensed.FELT),
    "seen nowhere": replace(PART, sensed=Sensed.NOWHERE),
    "in a building": replace(
        PART, object=None, name="fetch_mail", item="mail", sensed=Sensed.BY_LASER
    ),
    "held by another": replace(
        PART, object=None, item="mail", held_by="robot2-0a1b2c3d", away_m=30.0
    ),
    "without a part": replace(PART, object=None, name="wave", guesses=()),
}

every_kind = pytest.mark.parametrize("kind", sorted(SCRIPTS))


@cache
def every_question(kind: str) -> list[tuple[Issue, Outlook, tuple[str, ...], Ask]]:
    """What may be asked about one kind of issue, with the answers that lead there."""
    return [
        (issue, outlook, calls, ask)
        for issue in ISSUES.values()
        for outlook in OUTLOOKS.values()
        for calls, ask in asked(kind, issue, outlook)
    ]


def asked(kind: str, issue: Issue, outlook: Outlook) -> Iterator[tuple[tuple[str, ...], Ask]]:
    """Every question that answers lead to, with them; promised help is not seen once."""
    waiting: list[tuple[str, ...]] = [()]
    while waiting:
        calls = waiting.pop()
        conversation, turns = after(kind, issue, outlook, calls)
        if conversation.phase is ConversationPhase.ASKING:
            [*_, ask] = turns
            assert isinstance(ask, Ask)
            yield calls, ask
            if "not seen" not in calls:
                waiting += [(*calls, "yes"), (*calls, "no")]
        elif conversation.phase is ConversationPhase.AWAITING_HELP:
            waiting.append((*calls, "not seen"))


def after(
    kind: str, issue: Issue, outlook: Outlook, calls: tuple[str, ...]
) -> tuple[Conversation, list[Turn]]:
    conversation = Conversation(SCRIPTS[kind], replace(issue, kind=kind), outlook)
    turns = conversation.open()
    for call in calls:
        if call == "not seen":
            turns = conversation.help_not_seen()
        else:
            turns = conversation.answer("yes" if call == "yes" else "no")
    return conversation, turns


def names(ask: Ask) -> list[str]:
    return [way.name for way in ask.ways]


@every_kind
def test_ways_are_all_that_can_be_answered_in_their_order(kind: str) -> None:
    for *_, ask in every_question(kind):
        number = len(ask.ways)
        assert number >= 2
        yeses = [("no",) * before + ("yes",) for before in range(number - 1)]
        assert [way.answers for way in ask.ways] == [*yeses, ("no",) * (number - 1)]
        assert len(set(names(ask))) == number


@every_kind
def test_a_way_does_what_its_last_answer_does(kind: str) -> None:
    for issue, outlook, calls, ask in every_question(kind):
        for way in ask.ways:
            *before, last = way.answers
            _, turns = after(kind, issue, outlook, (*calls, *before))
            [*_, put] = turns
            assert isinstance(put, Ask)
            effects = {"yes": put.yes_effect, "no": put.no_effect}
            finals = {"yes": put.yes_final, "no": put.no_final}
            assert (way.effect, way.final) == (effects[last], finals[last])


@every_kind
def test_questions_on_the_way_offer_what_is_left(kind: str) -> None:
    for issue, outlook, calls, ask in every_question(kind):
        if ask.no_final:
            continue
        _, turns = after(kind, issue, outlook, (*calls, "no"))
        [*_, then] = turns
        assert isinstance(then, Ask)
        assert names(then) == names(ask)[1:]


@every_kind
def test_whoever_helps_with_nothing_says_not_now(kind: str) -> None:
    for *_, ask in every_question(kind):
        assert [way.label for way in ask.ways if "yes" not in way.answers] == ["Not now"]


@every_kind
def test_at_most_twenty_three_words_stand_before_the_last_way(kind: str) -> None:
    """The robot's name and how long it waits stand there as well."""
    for *_, ask in every_question(kind):
        words = f"{ask.headline} {' '.join(way.label for way in ask.ways)}".split()
        assert len(words) <= 23, words


@every_kind
def test_it_is_named_before_it_is_called_it(kind: str) -> None:
    it = re.compile(r"\bit\b", re.IGNORECASE)
    for issue, _, _, ask in every_question(kind):
        if any(it.search(way.label) for way in ask.ways if way.label != way.deed):
            named = issue.object or issue.item or issue.name
            assert named.replace("_", " ") in ask.headline


def the_ways(kind: str, *calls: str, issue: Issue = PART) -> list[tuple[str, str]]:
    conversation, _ = after(kind, issue, Outlook(), calls)
    return [(way.name, way.label) for way in conversation.ways]


def test_a_lost_part_is_put_back_or_placed() -> None:
    conversation, [ask] = after("dropped", PART, Outlook(), ())
    assert isinstance(ask, Ask)
    assert ask.headline == "Put the pink bar back on the table"
    assert conversation.ways == ask.ways
    assert ask.ways == (
        Way(
            name="put_back",
            deed="Put the pink bar back on the table",
            label="Put it back on the table",
            effect="You put the pink bar back on the table, "
            "and I try again (still attempt 1 of 3).",
            answers=("yes",),
        ),
        Way(
            name="place",
            deed="Place the pink bar yourself",
            label="Place it yourself",
            effect="You put the pink bar at its place; it is done once I see it there "
            "(attempt 1 of 3).",
            answers=("no", "yes"),
        ),
        Way(
            name="later",
            deed="Not now",
            label="Not now",
            effect="Attempt 1 of 3 has failed, and I try again (attempt 2 of 3).",
            answers=("no", "no"),
            final=True,
        ),
    )


def test_a_lost_robot_is_told_one_of_several_places() -> None:
    assert the_ways("lost") == [
        ("told_1", "At F1 101"),
        ("told_2", "At F1 103"),
        ("told_3", "Near F2 204"),
        ("left_out", "Leave the pink bar out"),
        ("later", "Not now"),
    ]


def test_of_places_that_it_has_not_guessed_none_is_offered() -> None:
    one = replace(PART, guesses=("at F1 101",))
    assert [name for name, _ in the_ways("lost", issue=one)] == ["told_1", "left_out", "later"]


def test_whoever_promised_help_that_is_not_seen_may_choose_another_way() -> None:
    assert the_ways("unreachable", "yes", "not seen") == [
        ("hand_over", "Hold it between my fingers"),
        ("place", "Place it yourself"),
        ("later", "Not now"),
    ]


def test_what_a_basket_feels_instead_is_what_there_is_to_do_about() -> None:
    mail = replace(PART, kind="item_not_given", object=None, item="mail")
    conversation = Conversation(SCRIPTS["item_not_given"], mail, Outlook())
    conversation.open()
    conversation.answer("yes")
    conversation.help_not_seen(Felt.TOO_MUCH)
    assert conversation.ways[0].label == "Take out what is not the mail"


def test_a_closed_dialogue_and_promised_help_offer_nothing() -> None:
    assert the_ways("dropped", "yes") == []
    assert the_ways("dropped", "no", "no") == []


def test_a_script_without_deeds_is_answered_with_yes_and_no_alone() -> None:
    states = dict(SCRIPTS["positioning"].states)
    together = states["together"]
    assert isinstance(together, CloseState)
    states["together"] = replace(together, deed="")
    script = Script(opening="help_me", states=states)
    [ask] = Conversation(script, replace(PART, kind="positioning"), Outlook()).open()
    assert isinstance(ask, Ask)
    assert (ask.ways, ask.headline) == ((), "")


@pytest.mark.parametrize("kind", ["missed", "dropped", "undone"])
def test_who_says_yes_is_told_to_do_what_was_asked(kind: str) -> None:
    """A robot that asks whether it shall try again must not then send somebody for the part."""
    conversation, [ask] = after(kind, PART, Outlook(), ())
    assert isinstance(ask, Ask)
    assert ask.text.rsplit(". ", 1)[-1].startswith("Will you put it ")
    told = conversation.answer("yes")[0]
    assert isinstance(told, Remark)
    assert told.text.startswith("Please put the pink bar ")


@pytest.mark.parametrize("kind", sorted(SCRIPTS))
def test_the_robot_asks_for_help_that_a_person_gives(kind: str) -> None:
    """What a yes makes the robot alone do, nobody has to be asked for; but to leave it out."""
    for *_, ask in every_question(kind):
        if "Shall I" in ask.text:
            assert "leave" in ask.text or "go on without" in ask.text
            assert names(ask)[0] == "left_out"


def test_no_resolution_is_reached_by_a_way_that_answers_do_not_reach() -> None:
    conversation, _ = after("dropped", PART, Outlook(), ())
    way = next(each for each in conversation.ways if each.name == "later")
    for answer in way.answers:
        turns = conversation.answer(answer)
    assert turns[-1].resolution is Resolution.ROBOT_RETRY  # type: ignore[union-attr]
