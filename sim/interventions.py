"""Which interventions are still to come in a run, and when each is due."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mend.documents.strict_model import StrictModel
from mend.robots.link.messages import Intervene
from mend.robots.task_progress import TaskProgress
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention, Trigger

SCENARIO = "scenario"
"""In whose name scripted interventions happen."""
HELPER = "helper"
"""Who acts where a promise is kept."""

_EPSILON = 1e-9


class Queued(StrictModel):
    """An intervention that a robot's command asked for, to happen when the clock reaches `at_s`."""

    command: str
    do: Intervention
    by: str
    at_s: float
    robot: str = ""


@dataclass(frozen=True, slots=True)
class PersonAction:
    """Something that a person does now.

    `command` of `robot` asked for it, None if a script did.
    """

    do: Intervention
    by: str
    command: str | None = None
    robot: str = ""


class PendingSnapshot(StrictModel):
    """What is kept of pending interventions: which scripted ones have been, what is queued."""

    fired: list[int]
    queued: list[Queued]


class PendingInterventions:
    """A scenario's interventions and those that were asked for ahead of time."""

    def __init__(self, scripted: Sequence[ScriptedIntervention]) -> None:
        self._scripted = tuple(scripted)
        self._fired: set[int] = set()
        self._queued: list[Queued] = []

    @property
    def any_left(self) -> bool:
        """Whether anything is still to come."""
        return bool(self._queued) or len(self._fired) < len(self._scripted)

    @property
    def due_s(self) -> float:
        """When the next one is due by the clock; infinite where none is."""
        scripted = (
            each.at_s or 0.0
            for index, each in enumerate(self._scripted)
            if index not in self._fired and each.when is None
        )
        return min((*scripted, *(each.at_s for each in self._queued)), default=math.inf)

    def queue(self, robot: str, command_id: str, command: Intervene, at_s: float) -> None:
        """Let somebody do something when the clock reaches `at_s`, as a robot was told.

        A command that waits already is not doubled: a rebuilt world is told again what it may know.
        """
        if any(each.command == command_id for each in self._queued):
            return
        queued = Queued(
            command=command_id, do=command.intervention, by=command.by, at_s=at_s, robot=robot
        )
        self._queued.append(queued)

    def withdraw(self, robot: str, handled: str | None) -> None:
        """Nobody needs to do any more what a robot was promised for an object.

        Who promised to get out of the way still does: an arm that has only just touched somebody
        may take its way for free.
        """
        self._queued = [
            each
            for each in self._queued
            if each.robot != robot
            or each.do.act is Act.RELEASE
            or each.do.object not in (None, handled, robot)
        ]

    def take_due(self, time_s: float, progress: TaskProgress | None) -> list[PersonAction]:
        """Those that are due now; they are no longer pending."""
        due: list[PersonAction] = []
        for index, scripted in enumerate(self._scripted):
            if index not in self._fired and _is_due(scripted, time_s, progress):
                self._fired.add(index)
                due.append(PersonAction(scripted.do, SCENARIO))
        ripe = [each for each in self._queued if each.at_s <= time_s + _EPSILON]
        self._queued = [each for each in self._queued if each.at_s > time_s + _EPSILON]
        ripe.sort(key=lambda each: each.at_s)
        due.extend(PersonAction(each.do, each.by, each.command, each.robot) for each in ripe)
        return due

    def snapshot(self) -> PendingSnapshot:
        return PendingSnapshot(fired=sorted(self._fired), queued=list(self._queued))

    def restore(self, snapshot: PendingSnapshot) -> None:
        self._fired = set(snapshot.fired)
        self._queued = list(snapshot.queued)


def _is_due(scripted: ScriptedIntervention, time_s: float, progress: TaskProgress | None) -> bool:
    if scripted.when is not None:
        return progress is not None and _has_reached(scripted.when, progress)
    return time_s + _EPSILON >= (scripted.at_s or 0.0)


def _has_reached(trigger: Trigger, progress: TaskProgress) -> bool:
    """Whether the moment has come, or has gone by within the same attempt."""
    if (progress.object, progress.attempt) != (trigger.object, trigger.attempt):
        return False
    return (progress.step, progress.fraction + _EPSILON) >= (trigger.step, trigger.fraction)
