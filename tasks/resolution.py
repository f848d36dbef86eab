"""The four ways in which an issue is resolved (Blankenburg et al. 2020, Section 3.2)."""

from enum import StrEnum


class Resolution(StrEnum):
    """Who finishes a leaf after an issue, and so what becomes of the leaf."""

    HUMAN_FINISH = "human_finish"
    """The helper does the rest: the leaf is done."""
    ROBOT_FINISH = "robot_finish"
    """The robot goes on after a brief help: the leaf stays active, then is done."""
    COLLAB_FINISH = "collab_finish"
    """Both at once, the robot slowed down: the leaf stays active, then is done."""
    ROBOT_RETRY = "robot_retry"
    """The robot tries again later: the leaf is put back."""
