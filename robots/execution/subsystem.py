"""A subsystem of a robot: one effector, the behaviors that it can do, and the looks of its own."""

from collections.abc import Callable, Collection, Sequence
from typing import Any, Protocol

from mend.robots.body import CameraImage
from mend.robots.execution.effector import Effector
from mend.robots.execution.execution import AnyExecution
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import (
    Avoid,
    BaseLimits,
    Detection,
    Driven,
    Look,
    Looked,
    MakeWay,
    NoteTaken,
    PoseLayout,
    Poses,
    ReachLimits,
    ReportBody,
    RoomLimits,
    Start,
)


class Subsystem(Protocol):
    """What a robot does with an arm, or with a base; a robot may have both."""

    @property
    def behaviors(self) -> Collection[str]:
        """The names of the behaviors that it can do."""
        ...

    @property
    def effector(self) -> Effector[Any]: ...

    @property
    def reach(self) -> ReachLimits | None:
        """From where to where it can take things; None if it takes nothing."""
        ...

    @property
    def room(self) -> RoomLimits | None:
        """The room that it takes while it works; None if that is not known."""
        ...

    @property
    def keeps_clear(self) -> bool:
        """Whether it keeps clear of other robots by what it senses, so that it needs no room."""
        ...

    @property
    def driven(self) -> Driven | None:
        """What it has driven so far, by its wheels; None if it has none."""
        ...

    @property
    def avoids_ways(self) -> bool:
        """Whether it keeps off ways that it is told of."""
        ...

    def avoid(self, told: Avoid) -> None:
        """Keep off ways where others lead."""
        ...

    @property
    def base(self) -> BaseLimits | None:
        """How wide and fast it is where it meets another robot; None if it does not drive."""
        ...

    def make_way(self, told: MakeWay) -> None:
        """Make way for another robot, or wait for one that does."""
        ...

    @property
    def notes_taken(self) -> bool:
        """Whether it has a basket out of which things may be taken for others."""
        ...

    def note_taken(self, told: NoteTaken) -> None:
        """Forget what was taken out of its basket for others."""
        ...

    @property
    def between_floors(self) -> bool:
        """Whether it rides, so that nothing can be begun from where it is."""
        ...

    def execution_of(self, start: Start, report: Callable[[ReportBody], None]) -> AnyExecution:
        """What a start command asks for, not begun. Raises `CommandError`."""
        ...

    def look(
        self,
        command: str,
        look: Look,
        held: AnyExecution | None,
        report: Callable[[ReportBody], None],
    ) -> Routine[Looked]:
        """The routine of a look; `held` is the execution that waits. Raises `CommandError`."""
        ...

    def glance(self, command: str, held: AnyExecution | None) -> Looked:
        """What is seen now, without moving anything; it judges no results."""
        ...

    def retreat(self) -> Routine[None]:
        """Go to rest while nothing is executed."""
        ...

    def sought_in(self, camera: str, image: CameraImage) -> Detection | None:
        """Where in a camera's picture is to be what its latest look looks for; None if unknown."""
        ...

    # --- For people who watch -------------------------------------------------------------------

    def film(self) -> None:
        """A control cycle of an execution has passed: take a picture for the clip if one is due."""
        ...

    @property
    def clip(self) -> Sequence[CameraImage]:
        """What was seen in the last seconds, oldest first."""
        ...

    def layout(self, layout: PoseLayout) -> PoseLayout:
        """What it adds to what the robot shows."""
        ...

    def show(self, poses: Poses) -> Poses:
        """Where that is now."""
        ...

    def note(self, looked: Looked) -> None:
        """This was reported: what was located is shown there."""
        ...
