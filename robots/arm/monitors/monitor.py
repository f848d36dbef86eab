"""What a fault monitor is, and all that it may look at."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, ClassVar, Generic, TypeVar

from mend.robots.arm.behaviors.contact import Contact, Try
from mend.robots.arm.behaviors.phase import Phase
from mend.robots.arm.body import Reach
from mend.robots.arm.grip import GripReading
from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.link.messages import Detection, Location, WasDone
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.obstruction import Obstruction
from mend.robots.vision.presence import Presence
from mend.tasks.scene import StrictModel

BEFORE_FIRST_STEP = 0

ANY_BEHAVIOR: frozenset[str] = frozenset({"*"})
"""Names every behavior: for what no behavior can go on without."""

P = TypeVar("P", bound=StrictModel)


class NoParameters(StrictModel):
    """The settings of a monitor that has none."""


class Reaction(StrEnum):
    """What the robot does once the issue is raised."""

    GO_TO_NEUTRAL = "go_to_neutral"
    """It stops, lets go, moves to neutral and holds."""
    STOP_IN_PLACE = "stop_in_place"
    """It stops where it is, before the first step at neutral, and holds."""
    SLOW_DOWN = "slow_down"
    """It goes on, slowly, until the behavior's last step is done."""


@dataclass(frozen=True, slots=True)
class MonitorView:
    """What the robot senses at one moment; nothing in it comes from a simulator.

    `step` counts from 1 and is 0 before the first; `phase` is what it is for. `part` is the
    behavior's object and `target` where it is to be, `was_done` what is known of one whose leaf
    was done before. `sighting`
    is where the head camera saw it, `refusal` why the arm cannot grasp and place it, and
    `obstruction` what it saw in the way; all three are from before the first step. `grip` is what
    the newest forearm picture says, from when the gripper has closed on the object until it opens.
    `blind` says why the head camera shows nothing of the table, in `PREPARE` and in `CONFIRM`.
    `placed` and `presence` say where the object was seen in `CONFIRM`, after the last step.
    `contact` is what pushed against the arm in every try of a motion.
    `contact_forces_n` are the readings of every control cycle since the last check.
    """

    time_s: float
    step: int
    phase: Phase
    part: Part | None
    needs_help: bool
    reach: Reach
    table_z: float
    target: Location | None = None
    was_done: WasDone | None = None
    sighting: HeadSighting | None = None
    refusal: str | None = None
    obstruction: Obstruction | None = None
    blind: str | None = None
    grip: GripReading | None = None
    placed: HeadSighting | None = None
    presence: Presence | None = None
    contact: Contact | None = None
    contact_forces_n: Sequence[float] = ()
    pictures: Mapping[str, CameraImage] = field(default_factory=dict)


class Monitor(ABC, Generic[P]):
    """Watches one execution for one kind of issue; a package adds its own by an entry point.

    `issue` is the kind, under which dialogue scripts are registered too. It checks in the
    `phases` of the `behaviors` that it names (a behavior says in `monitored_as` by which name it
    is watched), at the forearm camera's period, and never in any other. `camera` is the one whose
    pictures it judges, None if it judges by something else; by pictures of a camera that shows
    nothing of the table none is asked to judge. `parameters` is the pydantic model of
    its settings. A monitor is made anew for each execution, so it may remember what it saw.
    """

    issue: ClassVar[str]
    behaviors: ClassVar[frozenset[str]]
    phases: ClassVar[frozenset[Phase]]
    reaction: ClassVar[Reaction]
    camera: ClassVar[str | None] = None
    parameters: ClassVar[type[StrictModel]]

    def __init__(self, settings: P) -> None:
        self.settings = settings

    @classmethod
    def create(cls, parameters: Mapping[str, Any]) -> "Monitor[Any]":
        """Make one from a mapping. Raises pydantic's `ValidationError` for wrong parameters."""
        return cls(cls.parameters.model_validate(parameters))  # type: ignore[arg-type]

    @property
    def interrupts(self) -> bool:
        """Whether the behavior does not simply go on."""
        return self.reaction is not Reaction.SLOW_DOWN

    def watches(self, behavior: str, phase: Phase) -> bool:
        """Whether it checks in this phase of what is monitored as this behavior."""
        named = behavior in self.behaviors or self.behaviors == ANY_BEHAVIOR
        return named and phase in self.phases

    @property
    def tries(self) -> Sequence[Try]:
        """How often, how hard and how fast the arm tries a motion in which it feels something.

        Empty for a monitor to which it does not matter what is felt.
        """
        return ()

    @abstractmethod
    def check(self, view: MonitorView) -> Detection | None:
        """What it detected, or None if all is as it must be."""
