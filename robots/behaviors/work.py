"""Work: an assignment, how far it has come, and the arm and senses that do it."""

from collections.abc import Callable
from dataclasses import dataclass

from robots.arm import Arm
from robots.behaviors.assignment import Assignment
from robots.behaviors.progress import Progress
from robots.link.messages import ReportBody
from robots.senses import Senses


@dataclass(frozen=True, slots=True)
class Work:
    """What all that prepares, walks and watches one execution shares; reports go to `report`."""

    assignment: Assignment
    progress: Progress
    arm: Arm
    senses: Senses
    report: Callable[[ReportBody], None]
