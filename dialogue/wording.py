"""How a script's sentences are filled in, so that a busy person can take them in by ear."""

import re
from collections.abc import Callable, Collection, Mapping
from functools import lru_cache, partial
from itertools import zip_longest
from string import Formatter

from mend.dialogue.outlook import Outlook
from mend.dialogue.spoken import called, spoken, the
from mend.dialogue.worded import Worded, filled_in, sentences_of, worded
from mend.tasks.issue import Issue

_GUESSES = ("guess_1", "guess_2", "guess_3")
FIELDS = frozenset(
    {
        "object",
        "it",
        "item",
        "put_in",
        "fetch",
        "message",
        "person",
        "doing",
        "with_object",
        "place",
        "name",
        "robot",
        "why",
        "attempt",
        "times",
        "again",
        "later",
        "go_on",
        *_GUESSES,
    }
)
"""`item`: what is carried for people, `message`: what they are told, and `person`:
who is escorted. `put_in`: what is to be done so that the robot has the item, which may be in the
basket of another one (`put the mail into my basket`), and `fetch` the same in few words. `doing`:
what a base does with its leaf (`the mail`, `the drive to 101`). `it`: the object, named once and
`it` from then on. `with_object`: ` with the cup` with a blank before it, or nothing where there is
no object.
`why`: what the robot sensed, as a sentence with a blank before it, or nothing. `attempt`:
`attempt 1 of 3`. `times`: how often this has happened. `again`, `later`, `go_on`: what the robot
does next after help, after a failed attempt, and if it need not begin anew. `guess_1` to
`guess_3`: where a lost robot may be (`at 101`), or nothing where it has not as many guesses."""

_MOST_SENTENCES = 1024
"""More than all scripts have: each is said again and again."""

_AT_HAND_M = 5.0
"""Whoever stands no farther off is in plain sight,"""
_ROUNDED_M = 5.0
"""and how far off others stand is said as roundly as people take it."""


def word(text: str, issue: Issue, outlook: Outlook, *, named: bool = False) -> Worded:
    """Fill in a sentence; a leaf without an object or place is spoken of by its own name.

    `named`: the object was named just before.
    """
    used = _fields_of(text)
    words = _words(issue, outlook, named=named)
    return filled_in(text, {name: words[name]() for name in words if name in used})


def _words(issue: Issue, outlook: Outlook, *, named: bool) -> Mapping[str, Callable[[], str]]:
    """What each field is filled in with, made where a sentence has that field."""

    def it() -> Worded:
        return worded("it") if named else _thing(issue)

    guesses = dict(zip_longest(_GUESSES, issue.guesses[: len(_GUESSES)]))
    return {
        **{name: partial(_where, guess or "") for name, guess in guesses.items()},
        "item": lambda: spoken(issue.item or issue.name),
        "it": it,
        "put_in": lambda: _put_in(issue),
        "fetch": lambda: _fetch(issue, it()),
        "message": lambda: issue.message or "",
        "person": lambda: issue.person or worded("somebody"),
        "doing": lambda: _doing(issue),
        "object": lambda: spoken(issue.object or issue.item or issue.name),
        "with_object": lambda: worded(" with {it}", it=the(issue.object)) if issue.object else "",
        "place": lambda: spoken(issue.place or issue.name),
        "name": lambda: spoken(issue.name),
        "robot": lambda: called(issue.robot),
        "why": lambda: _why(issue),
        "attempt": lambda: outlook.attempt_spoken,
        "times": lambda: outlook.times_spoken,
        "again": outlook.after_help,
        "later": outlook.if_it_fails,
        "go_on": outlook.going_on,
    }


def _doing(issue: Issue) -> Worded:
    if (carried := issue.object or issue.item) is not None:
        return the(carried)
    if issue.place is None:
        return the(issue.name)
    place = spoken(issue.place)
    if issue.message is not None:
        return worded("the message for {place}", place=place)
    if issue.person is not None:
        meets = _is_called_after(issue, "meet_person")
        told = "the meeting with {person} at {place}" if meets else _WITH_PERSON
        return worded(told, person=issue.person, place=place)
    return worded("the drive to {place}", place=place)


def _thing(issue: Issue) -> Worded:
    """What a leaf handles, or does where nobody has named it: a behavior's name says nothing."""
    named = issue.object or issue.item
    if named is None and any(_is_called_after(issue, each) for each in _OF_BASES):
        return _doing(issue)
    return the(named or issue.name)


_WITH_PERSON = "the drive with {person} to {place}"
_OF_BASES = ("go_to", "charge", "deliver_message", "meet_person", "escort")
"""Behaviors that handle no thing."""


def _is_called_after(issue: Issue, behavior: str) -> bool:
    """Whether a leaf is called as its behavior is, as all are that nobody has named."""
    return issue.name == behavior or issue.name.startswith(f"{behavior}_")


def _where(guess: str) -> str:
    """Where a lost robot may be, `at 101`."""
    place = spoken(guess).removeprefix("at ")
    return worded("at {place}", place=place) if guess.startswith("at ") else place


def _put_in(issue: Issue) -> Worded:
    item = the(issue.item or issue.name)
    if issue.held_by is None:
        return worded("put {it} into my basket", it=item)
    robot = called(issue.held_by)
    if issue.away_m is None or issue.away_m <= _AT_HAND_M:
        return worded(
            "take {it} out of the basket of {robot} and put it into mine", it=item, robot=robot
        )
    return worded(
        "take {it} out of the basket of {robot}, which stands about {away} m from here, and put it "
        "into mine",
        it=item,
        robot=robot,
        away=f"{_roundly(issue.away_m):.0f}",
    )


def _fetch(issue: Issue, it: Worded) -> Worded:
    if issue.held_by is None:
        return worded("put {it} into my basket", it=it)
    return worded("bring {it} from {robot}", it=it, robot=called(issue.held_by))


def _roundly(length_m: float) -> float:
    return _ROUNDED_M * max(round(length_m / _ROUNDED_M), 1)


def without_question(text: str) -> str:
    """What a script's text states, without the questions at its end; empty if it only asks."""
    sentences = re.split(r"(?<=[.!?]) ", text)
    while sentences and sentences[-1].endswith("?"):
        sentences.pop()
    return " ".join(sentences)


def sentence(clause: str) -> Worded:
    """A clause as a sentence of its own."""
    whole = clause if isinstance(clause, Worded) else Worded(clause, sentences_of(clause))
    if clause.endswith("."):
        whole = Worded(clause.rstrip("."), sentences_of(clause.rstrip(".")))
    return worded("{clause}.", clause=whole).capitalized()


@lru_cache(_MOST_SENTENCES)
def _fields_of(text: str) -> Collection[str]:
    """The fields of a sentence of a script."""
    return tuple(field for _, field, _, _ in Formatter().parse(text) if field is not None)


def unknown_fields(text: str) -> list[str]:
    """The fields of a sentence that `word` cannot fill in.

    Raises `ValueError` when its braces do not match.
    """
    return [field for field in _fields_of(text) if field not in FIELDS]


def _why(issue: Issue) -> Worded | str:
    reason = issue.reason
    if issue.object:
        named = rf"(?<!the )(?<!a )\b{re.escape(issue.object)}\b"
        reason = re.sub(named, f"the {issue.object}", reason)
    if not reason:
        return ""
    why = sentence(called(reason))
    return Worded(f" {why}", why.sentences)
