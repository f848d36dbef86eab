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


def choice_of(names: tuple[str, ...]) -> str:
    """Some of several things: `the cup`, `the cup or the saucer`, `the cup, the saucer, ...`."""
    said = [f"the {spoken(name)}" for name in names[:3]]
    if not said:
        return "something else"
    if len(names) > 3:
        return f"{', '.join(said)} or another part"
    return " or ".join([", ".join(said[:-1]), said[-1]] if said[:-1] else said)
