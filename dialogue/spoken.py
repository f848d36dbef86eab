"""Identifiers and counts as people say them."""

import re

_COUNTS = ("never", "once", "twice", "three", "four", "five", "six", "seven", "eight", "nine")


def spoken(identifier: str) -> str:
    """A text with identifiers as people say it: `sugar_bowl` is a sugar bowl."""
    return re.sub(r"(?<=\w)[_-](?=\w)", " ", identifier)


def called(robots: str) -> str:
    """What people call a robot, or those in a text: `robot2-0afba7d8` of a site is robot2."""
    return spoken(re.sub(r"(?<=\w)-[0-9a-f]{8}\b", "", robots))


def count_of(times: int) -> str:
    """How often: `once`, `twice`, `three times`, `12 times`."""
    if 0 <= times < 3:
        return _COUNTS[times]
    return f"{_COUNTS[times] if times < len(_COUNTS) else times} times"


MOST_NAMES = 4
"""Of several things so many are of use: one more than are named."""


def bound_for(name: str, place: str) -> str:
    """A part by where it is to go, where several leaves handle it: `cup for the tray`."""
    return f"{name} for the {place}"


def choice_of(names: tuple[str, ...]) -> str:
    """Some of several things: `the cup`, `the cup or the saucer`, `the cup, the saucer, ...`."""
    said = [f"the {spoken(name)}" for name in names[: MOST_NAMES - 1]]
    if not said:
        return "something else"
    if len(names) >= MOST_NAMES:
        return f"{', '.join(said)} or another part"
    return " or ".join([", ".join(said[:-1]), said[-1]] if said[:-1] else said)
