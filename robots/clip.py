"""The clip: the last seconds of what the forearm camera saw, kept for when a fault is detected."""

from collections import deque
from collections.abc import Sequence

from mend.robots.body import CameraImage
from mend.robots.link.messages import ClipPicture
from mend.robots.vision.drawing import encode_jpeg

LENGTH_S = 8.0
PERIOD_S = 0.2

MOST_CHARS = 600_000
"""What all pictures together may take in a message, as base64."""


class Clip:
    """Pictures `PERIOD_S` apart or more, none older than `LENGTH_S`; encoded only on demand."""

    def __init__(self) -> None:
        self._images: deque[CameraImage] = deque()

    def due(self, time_s: float) -> bool:
        """Whether a picture taken now would be kept."""
        return not self._images or time_s - self._images[-1].time >= PERIOD_S - 1e-9

    def note(self, image: CameraImage) -> None:
        """A picture was taken; it is kept if it is due."""
        if not self.due(image.time):
            return
        self._images.append(image)
        while image.time - self._images[0].time > LENGTH_S:
            self._images.popleft()

    def begin(self) -> None:
        """What was seen before is of no interest any more."""
        self._images.clear()

    def images(self) -> Sequence[CameraImage]:
        """What is kept, oldest first."""
        return tuple(self._images)


def encode_clip(images: Sequence[CameraImage], until_s: float) -> list[ClipPicture]:
    """The pictures for a message, oldest first; every other one is left out while all are too big.

    `until_s` is when the fault was detected, on the clock of the pictures.
    """
    pictures = [
        ClipPicture(before_s=max(0.0, until_s - each.time), jpeg=encode_jpeg(each.bgr))
        for each in images
    ]
    while len(pictures) > 1 and sum(len(each.jpeg) for each in pictures) > MOST_CHARS:
        # From the end, as the last moments matter most.
        pictures = pictures[::-1][::2][::-1]
    return pictures
