"""What a look waits for, and the two expectations that one head picture answers."""

from typing import Protocol

from mend.robots.arm.looks.looker import Looker
from mend.robots.arm.looks.shown import detection_of
from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.link.messages import Detection, Location


class VisualCheck(Protocol):
    """Something that a look waits for."""

    def is_fulfilled(self) -> bool:
        """Look once more."""
        ...

    def detection(self, image: CameraImage) -> Detection:
        """Where in a head picture the object is, and is to be, as far as that can be said."""
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

    def detection(self, image: CameraImage) -> Detection:
        perception = self._looker.perception
        sighting = perception.head.sight(self._part, image)
        return detection_of(perception, image, self._part, sighting, self._target)


class ViewClear:
    """The head camera shows the table."""

    def __init__(self, looker: Looker) -> None:
        self._looker = looker

    def is_fulfilled(self) -> bool:
        return self._looker.look_at_table() is not None

    def detection(self, image: CameraImage) -> Detection:
        return detection_of(self._looker.perception, image, None, None, None)
