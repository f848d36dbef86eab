"""What the service refuses, and why: each becomes one problem document on the API."""

from collections.abc import Sequence
from uuid import UUID

from mend.errors import ConflictError, NotFoundError, UnavailableError, WrongInputError
from mend.tasks.scene_problem import SceneProblem


class BusyError(UnavailableError):
    """The service has too much to do for this just now; nothing of it was done."""

    retry_after_s = 5


class LostRaceError(ConflictError):
    """Somebody else answered first."""

    def __init__(self, prompt: UUID, answered_by: str) -> None:
        super().__init__(f"this question was already answered by {answered_by}")
        self.prompt = prompt
        self.answered_by = answered_by


class NotConnectedError(NotFoundError):
    """Robots that a run is to have are not connected; `robots` names those."""

    def __init__(self, message: str, robots: Sequence[str]) -> None:
        super().__init__(message)
        self.robots = list(robots)


class ImpossibleError(WrongInputError):
    """A world's robot cannot do a tree in a scene; `scene_problems` say where in that, and why."""

    def __init__(self, message: str, scene_problems: Sequence[SceneProblem]) -> None:
        super().__init__(message, [each.message for each in scene_problems])
        self.scene_problems = scene_problems

    def __reduce__(self) -> tuple[type["ImpossibleError"], tuple[str, Sequence[SceneProblem]]]:
        # It goes from one process to another.
        return type(self), (str(self), self.scene_problems)
