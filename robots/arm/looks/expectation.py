"""What a look waits for, and the two expectations that one head picture answers."""

from typing import Protocol

from mend.robots.arm.looks.looker import Looker
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location


class VisualCheck(Protocol):
    """Something that a look waits for."""

    def is_fulfilled(self) -> bool:
        """Look once more."""
        ...


class AtPlace:
    """An object, or one just like it, rests at its place."""

    def __init__(self, looker: Looker, part: Part, target: Location) -> None:
        self._looker, self._part, self._target = looker, part, target

    def is_fulfilled(self) -> bool:
        image = self._looker.look_at_table()
        if image is None:
            return False
        return self._looker.perception.head.recognize_at(image, self._part, self._target)


class ViewClear:
    """The head camera shows the table."""

    def __init__(self, looker: Looker) -> None:
        self._looker = looker

    def is_fulfilled(self) -> bool:
        return self._looker.look_at_table() is not None
