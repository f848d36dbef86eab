"""What a fault monitor of an arm is, and all that it may look at."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, TypeVar

from mend.documents.strict_model import StrictModel
from mend.robots.arm.behaviors.contact import Contact, Try
from mend.robots.arm.body import Reach
from mend.robots.arm.grip import GripReading
from mend.robots.catalogue import Part
from mend.robots.execution.monitor import Monitor, MonitorView
from mend.robots.link.messages import Location, WasDone
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.obstruction import Obstruction
from mend.robots.vision.presence import Presence

P = TypeVar("P", bound=StrictModel)


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmView(MonitorView):
    """What an arm, its head camera and its hand sense at one moment.

    `part` is the
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


class ArmMonitor(Monitor[P, ArmView]):
    """A monitor of an arm's behaviors; it checks at the forearm camera's period.

    By pictures of a camera that shows nothing of the table none is asked to judge.
    """

    view: ClassVar[type[MonitorView]] = ArmView

    @property
    def tries(self) -> Sequence[Try]:
        """How often, how hard and how fast the arm tries a motion in which it feels something.

        Empty for a monitor to which it does not matter what is felt.
        """
        return ()
