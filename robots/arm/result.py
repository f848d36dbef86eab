"""What finished leaves left behind, as one robot understands it."""

from dataclasses import dataclass

from mend.robots.catalogue import Part
from mend.robots.link.messages import FinishedResult, Location


@dataclass(frozen=True, slots=True)
class JudgedResult:
    """A finished result to judge: the message that names it, and what it means to this robot."""

    message: FinishedResult
    part: Part
    target: Location
