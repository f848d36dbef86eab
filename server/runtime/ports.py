"""What the runtime needs of its surroundings, as it sees them: documents, robots and worlds."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol
from uuid import UUID

from mend.robots.link.messages import Hello
from mend.server.runtime.hardware import Hardware
from mend.server.runtime.pose_sink import PoseSink
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.robot_side import CommandSender
from mend.server.runtime.run import Run
from mend.server.runtime.run_state import RunState
from mend.tasks.scenario import Scenario
from mend.tasks.scene import Scene

LIVE = "live"
"""The world of real robots."""


@dataclass(frozen=True, slots=True)
class PreparedRun:
    """What a run begins with, all of it checked; `tree` is the definition in JSON."""

    tree_name: str
    tree: str
    scene: Scene
    script: Scenario | None = None


class Preparation(Protocol):
    """Where runs come from."""

    async def prepare(self, request: RunRequest) -> PreparedRun:
        """Read and check what a request names. Raises `NotFoundError` or `WrongInputError`."""
        ...


class Robots(CommandSender, Protocol):
    """The service's end of the robot link."""

    def assign(self, robot: str, sink: Run) -> None: ...

    def unassign(self, robot: str) -> None: ...

    async def take_picture(self, robot: str, camera: str, timeout_s: float = 2.0) -> bytes: ...

    def hello(self, robot: str) -> Hello | None: ...

    def connected(self, robot: str) -> bool: ...

    def known(self) -> list[str]: ...


class Worlds(Protocol):
    """The worlds that a run can be in, apart from `live`."""

    def check(self, world: str, options: Mapping[str, Any]) -> None:
        """Raises `WrongInputError` where there is no such world, or none with such options here."""
        ...

    def open(self, state: RunState, run: Callable[[], Run]) -> Hardware:
        """The hardware of a run, which starts it; `run` is asked for only then."""
        ...


class Poses(Protocol):
    """Where runs pass on what their robots show."""

    def open(self, state: RunState) -> PoseSink: ...

    def close(self, run: UUID) -> None: ...


class RealRobots:
    """The robots of a `live` run: nothing to start again, only to let go of."""

    simulated = False

    async def restart(self, robot: str) -> None:
        """A real robot comes back by itself."""

    def came(self, robot: str) -> None:
        """Nothing to do, as for `restart`."""

    async def release(self) -> None:
        """The runtime unassigns them."""
