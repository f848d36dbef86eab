"""Which robots were told in an ordeal that they are where they are not, and go on by that.

A robot that does not know where it is believes a person as far as its laser agrees; among rooms
that look alike it cannot know of a lie, so that what it says of doors, and where it says that it
has come to, is by the wrong place until somebody tells it the right one.
"""

import re
from bisect import bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterable
from datetime import datetime
from typing import Any

ASKED = re.compile(r"Am I (?:at|near) (.+)\?$")

IsThere = Callable[[str, str, float], bool]
"""Whether a robot was at a place, as it is said, at a wall time."""


class Misled:
    """From when to when each robot went by a lie, in wall time."""

    def __init__(self, events: Iterable[dict[str, Any]], is_there: IsThere) -> None:
        """`events`: those of the journal in their order."""
        self._told: dict[str, list[tuple[float, bool]]] = defaultdict(list)
        asked: dict[str, tuple[str, str]] = {}
        for each in events:
            if each["type"] == "prompt" and (place := ASKED.search(each["text"])):
                asked[each["prompt"]] = each["robot"], place[1]
            elif each["type"] == "answered" and each["prompt"] in asked:
                robot, said = asked[each["prompt"]]
                at_s = datetime.fromisoformat(each["wall_time"]).timestamp()
                true = is_there(robot, said, at_s)
                if true or each["answer"] == "yes":
                    self._told[robot].append((at_s, true != (each["answer"] == "yes")))

    def is_misled(self, robot: str, at_s: float) -> bool:
        """Whether the last thing that it was told of its place before then was a lie."""
        told = self._told[robot]
        last = bisect_right(told, (at_s, True)) - 1
        return last >= 0 and told[last][1]
