"""The time-outs of the robot link, in seconds of wall time."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LinkTimes:
    """How often a robot must be heard of, and what happens when it is not.

    A connection on which nothing came for `silence_s` is closed; a robot that has not come back
    `absence_s` after its connection ended is lost.
    """

    heartbeat_s: float = 1.0
    silence_s: float = 5.0
    absence_s: float = 3.0
