"""Identifiers and counts as people say them."""

import re

from mend.dialogue.other_scripts import as_written
from mend.dialogue.worded import Worded, worded

_COUNTS = (
    "never",
    "once",
    "twice",
    *(f"{each} times" for each in ("three", "four", "five", "six", "seven", "eight", "nine")),
)


NAMELESS = "thing_to_be_brought"
"""What is carried for people who have only pointed at it."""
_NAMELESS = worded("thing to be brought")
_MARK = re.compile(r"(?<=\w)(?<!\bxn)(?<!\bq0)--[0-9a-f]{8}\b")
"""What only tells equal names apart; but for the beginnings of words of `other_scripts`."""


def spoken(identifier: str) -> str:
    """A text with identifiers as people say it: `sugar_bowl` is a sugar bowl.

    What only tells equal names apart is not said: `cup_of_tea--0afba7d8` is a cup of tea. Words of
    other scripts are as they were written (`other_scripts`).
    """
    without_mark = as_written(_MARK.sub("", identifier))
    if without_mark == NAMELESS:
        return _NAMELESS
    if without_mark.startswith(f"{NAMELESS}-"):
        place = _without_joints(without_mark.removeprefix(f"{NAMELESS}-"))
        return worded("thing to be brought from {place}", place=place)
    return _without_joints(without_mark.replace(f"{NAMELESS}-", f"{NAMELESS} from "))


def _without_joints(name: str) -> str:
    return re.sub(r"(?<=\w)[_-](?=\w)", " ", name)


def called(robots: str) -> str:
    """What people call a robot, or those in a text: `robot2-0afba7d8` of a site is robot2."""
    return spoken(re.sub(r"(?<=\w)-[0-9a-f]{8}\b", "", robots))


def count_of(times: int) -> Worded:
    """How often: `once`, `twice`, `three times`, `12 times`."""
    if 0 <= times < len(_COUNTS):
        return worded(_COUNTS[times])
    return worded("{count} times", count=str(times))


MOST_NAMES = 4
"""Of several things so many are of use: one more than are named."""


def the(name: str) -> Worded:
    """A part, or what is carried, as one speaks of it: `the sugar bowl`."""
    return worded("the {part}", part=spoken(name))


def bound_for(name: str, place: str) -> str:
    """A part by where it is to go, where several leaves handle it: `cup for the tray`."""
    return f"{name} for the {place}"


def choice_of(names: tuple[str, ...]) -> Worded:
    """Some of several things: `the cup`, `the cup or the saucer`, `the cup, the saucer, ...`."""
    said = [the(name) for name in names[: MOST_NAMES - 1]]
    if not said:
        return worded("something else")
    if len(names) >= MOST_NAMES:
        return worded("{parts} or another part", parts=_listed(said))
    if len(said) == 1:
        return said[0]
    return worded("{parts} or {last}", parts=_listed(said[:-1]), last=said[-1])


def _listed(said: list[Worded]) -> Worded:
    first, *others = said
    return worded("{part}, {others}", part=first, others=_listed(others)) if others else first
