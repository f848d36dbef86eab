"""Whether a part is still where it was put, as far as a picture can tell."""

from enum import StrEnum


class Presence(StrEnum):
    """What a picture says of a part at a place."""

    THERE = "there"
    """It is seen at its place."""
    GONE = "gone"
    """Its place is seen, and it is not there."""
    HIDDEN = "hidden"
    """Something in front of its place keeps the camera from telling."""
