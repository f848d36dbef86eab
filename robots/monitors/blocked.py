"""`blocked`: something is in the arm's way or at the object's place, seen or felt."""

from collections.abc import Sequence
from typing import ClassVar

from pydantic import Field

from robots.behaviors.phase import Phase
from robots.behaviors.pick_and_place import PickAndPlace
from robots.link.messages import Detection
from robots.monitors.monitor import BEFORE_FIRST_STEP, Meanwhile, Monitor, MonitorView
from tasks.scene import StrictModel


class BlockedParameters(StrictModel):
    """A force above `limit_n` against the arm for `cycles` control cycles on end is a contact."""

    limit_n: float = Field(default=40.0, gt=0.0)
    cycles: int = Field(default=4, ge=1)


class Blocked(Monitor[BlockedParameters]):
    """Raises `blocked` before step 1 (by what is seen) and in every step (by what is felt)."""

    issue: ClassVar[str] = "blocked"
    behaviors: ClassVar[frozenset[str]] = frozenset({PickAndPlace.name})
    phases: ClassVar[frozenset[Phase]] = frozenset(Phase) - {Phase.CONFIRM}
    meanwhile: ClassVar[Meanwhile] = Meanwhile.STOP_IN_PLACE
    camera: ClassVar[str | None] = "head"
    parameters: ClassVar[type[StrictModel]] = BlockedParameters

    def __init__(self, settings: BlockedParameters) -> None:
        super().__init__(settings)
        self._cycles = 0

    def check(self, view: MonitorView) -> Detection | None:
        felt = self._feel(view.contact_forces_n)
        if felt is not None:
            return Detection(
                camera="head", felt=True, explanation=f"{felt:.0f} N push against the arm"
            )
        if view.step == BEFORE_FIRST_STEP and view.obstruction is not None:
            x, y, z = view.obstruction.position
            return Detection(
                camera="head",
                center=view.obstruction.center,
                area_px=view.obstruction.area_px,
                explanation=f"{view.obstruction.what} at ({x:.2f}, {y:.2f}, {z:.2f})",
            )
        return None

    def _feel(self, forces_n: Sequence[float]) -> float | None:
        for force in forces_n:
            self._cycles = self._cycles + 1 if force > self.settings.limit_n else 0
            if self._cycles >= self.settings.cycles:
                return force
        return None
