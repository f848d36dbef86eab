"""How a script's sentences are filled in, so that a busy person can take them in by ear."""

import re
from string import Formatter

from mend.dialogue.outlook import Outlook
from mend.dialogue.spoken import called, spoken
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
basket of another one (`put the mail into my basket`), and `fetch` the same in few words. `it`: the
object, named once and `it` from then on.
`with_object`: ` with the cup` with a blank before it, or nothing where there is no object.
`why`: what the robot sensed, as a sentence with a blank before it, or nothing. `attempt`:
`attempt 1 of 3`. `times`: how often this has happened. `again`, `later`, `go_on`: what the robot
does next after help, after a failed attempt, and if it need not begin anew. `guess_1` to
`guess_3`: where a lost robot may be (`at 101`), or nothing where it has not as many guesses."""

_AT_HAND_M = 5.0
"""Whoever stands no farther off is in plain sight,"""
_ROUNDED_M = 5.0
"""and how far off others stand is said as roundly as people take it."""


def word(text: str, issue: Issue, outlook: Outlook, *, named: bool = False) -> str:
    """Fill in a sentence; a leaf without an object or place is spoken of by its own name.

    `named`: the object was named just before.
    """
    it = "it" if named else f"the {spoken(issue.object or issue.item or issue.name)}"
    guesses = dict.fromkeys(_GUESSES, "")
    guesses.update(zip(_GUESSES, map(spoken, issue.guesses), strict=False))
    return text.format(
        **guesses,
        item=spoken(issue.item or issue.name),
        it=it,
        put_in=_put_in(issue),
        fetch=_fetch(issue, it),
        message=issue.message or "",
        person=issue.person or "somebody",
        object=spoken(issue.object or issue.item or issue.name),
        with_object=f" with the {spoken(issue.object)}" if issue.object else "",
        place=spoken(issue.place or issue.name),
        name=spoken(issue.name),
        robot=called(issue.robot),
        why=_why(issue),
        attempt=f"attempt {outlook.attempt} of {outlook.attempts}",
        times=outlook.times_spoken,
        again=outlook.after_help(),
        later=outlook.if_it_fails(),
        go_on=outlook.going_on(),
    )


def _put_in(issue: Issue) -> str:
    item = f"the {spoken(issue.item or issue.name)}"
    if issue.held_by is None:
        return f"put {item} into my basket"
    there = called(issue.held_by)
    if issue.away_m is not None and issue.away_m > _AT_HAND_M:
        there += f", which stands about {_roundly(issue.away_m):.0f} m from here,"
    return f"take {item} out of the basket of {there} and put it into mine"


def _fetch(issue: Issue, it: str) -> str:
    if issue.held_by is None:
        return f"put {it} into my basket"
    return f"bring {it} from {called(issue.held_by)}"


def _roundly(length_m: float) -> float:
    return _ROUNDED_M * max(round(length_m / _ROUNDED_M), 1)


def without_question(text: str) -> str:
    """What a text states, without the questions at its end; empty if it only asks."""
    sentences = re.split(r"(?<=[.!?]) ", text)
    while sentences and sentences[-1].endswith("?"):
        sentences.pop()
    return " ".join(sentences)


def sentence(clause: str) -> str:
    """A clause as a sentence of its own."""
    return f"{clause[:1].upper()}{clause[1:].rstrip('.')}."


def unknown_fields(text: str) -> list[str]:
    """The fields of a sentence that `word` cannot fill in.

    Raises `ValueError` when its braces do not match.
    """
    fields = [field for _, field, _, _ in Formatter().parse(text) if field is not None]
    return [field for field in fields if field not in FIELDS]


def _why(issue: Issue) -> str:
    reason = issue.reason
    if issue.object:
        named = rf"(?<!the )(?<!a )\b{re.escape(issue.object)}\b"
        reason = re.sub(named, f"the {issue.object}", reason)
    return f" {sentence(called(reason))}" if reason else ""
