"""What a base that stands sees of the way that it is to go on."""

from enum import StrEnum


class WayAhead(StrEnum):
    """Whether it gets on, and how."""

    BARRED = "barred"
    FREE = "free"
    ROUND = "round"
    """Still barred, but another way leads round."""
