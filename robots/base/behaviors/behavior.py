"""A behavior of a base: the list of its drives, and what it may know when it lays them out."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mend.documents.strict_model import StrictModel
from mend.robots.base.body import BasePose
from mend.robots.execution.behavior import Behavior
from mend.robots.execution.phase import Phase


@dataclass(frozen=True, slots=True)
class Drive:
    """One step: drive to a pose, at `speed` in (0, 1] of the base's best.

    `wait_s` passes there before the next step. `phase` says what the step is for: monitors watch
    phases.
    """

    name: str
    to: BasePose
    speed: float = 1.0
    wait_s: float = 0.0
    phase: Phase = Phase.TRAVEL


@dataclass(frozen=True, slots=True)
class BaseSituation:
    """What a behavior may know when it lays out its drives.

    `here` is where the base is; `places` are the poses of all that the task's scene names so, and
    `target` is that of the behavior's `place`, None where it has none.
    """

    here: BasePose
    places: Mapping[str, BasePose]
    target: BasePose | None


class BaseBehavior(Behavior):
    """What a base does, as a list of drives; a `place` among its parameters is its target."""

    @abstractmethod
    def drives(self, parameters: StrictModel, situation: BaseSituation) -> Sequence[Drive]:
        """Lay out all drives. Raises `CommandError` where the parameters name what is not there."""
