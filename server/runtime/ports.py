"""What the runtime needs of its surroundings, as it sees them: documents, robots and worlds."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol
from uuid import UUID

from mend.robots.link.messages import Hello
from mend.server.camera_picture import CameraPicture
from mend.server.runtime.clock import RunClock, WallClock
from mend.server.runtime.hardware import Hardware
from mend.server.runtime.pose_sink import PoseSink
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.robot_proxy import CommandSender, RobotProxy
from mend.server.runtime.run import Run
from mend.server.runtime.run_state import RunState
from mend.server.runtime.team import Neighbour
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

    async def prepare(self, request: RunRequest, scene: Scene | None = None) -> PreparedRun:
        """Read and check what a request names, for a `scene` that is there already if given.

        Raises `NotFoundError` or `WrongInputError`.
        """
        ...


class Robots(CommandSender, Protocol):
    """The service's end of the robot link."""

    def assign(self, robot: str, sink: Run) -> None: ...

    def unassign(self, robot: str) -> None: ...

    async def take_picture(
        self, robot: str, camera: str, timeout_s: float = 2.0
    ) -> CameraPicture: ...

    def has_time(self, robot: str) -> bool: ...

    def hello(self, robot: str) -> Hello | None: ...

    def connected(self, robot: str) -> bool: ...

    def known(self) -> list[str]: ...


@dataclass(frozen=True, slots=True)
class SiteOffer:
    """What a run finds at a site: the scene as far as it is known by now, and its robots."""

    world: str
    scene: Scene
    robots: list[str]
    seed: int
    speed: float | Literal["max"]


class Worlds(Protocol):
    """The worlds that a run can be in, apart from `live`."""

    def offer(self, site: UUID, robots: list[str]) -> SiteOffer:
        """What a run finds at a site, with these of its robots, or with all.

        Raises `NotFoundError`, `WrongInputError`, or `ConflictError` where a run has one of them.
        """
        ...

    def now_s(self, site: UUID) -> float | None:
        """What a site's clock says, as far as it is known. Raises `NotFoundError`."""
        ...

    def check(self, world: str, options: Mapping[str, Any]) -> None:
        """Raises `WrongInputError` where there is no such world, or none with such options here."""
        ...

    def open(self, state: RunState, run: Callable[[], Run]) -> Hardware:
        """The hardware of a run, which starts it; `run` is asked for only then.

        Raises `NotFoundError` where its site is there no more.
        """
        ...


class Poses(Protocol):
    """Where runs pass on what their robots show."""

    def open(self, state: RunState) -> PoseSink: ...

    def close(self, run: UUID) -> None: ...


class RealRobots:
    """The robots of a `live` run: nothing to start again, only to let go of."""

    simulated = False

    def __init__(self, monotonic: Callable[[], float]) -> None:
        self._monotonic = monotonic

    def clock(self, start_s: float) -> RunClock:
        """Real time, from where the run is."""
        return WallClock(self._monotonic, start_s)

    def lend(self) -> None:
        """The runtime assigns them."""

    async def begin(self, robot: str) -> None:
        """A real robot comes by itself."""

    async def restart(self, robot: str) -> None:
        """A real robot comes back by itself."""

    def came(self, proxy: RobotProxy) -> None:
        """Nothing to do, as for `restart`."""

    def neighbours(self) -> Sequence[Neighbour]:
        """Nobody that the service knows of."""
        return ()

    def tell_neighbours(self) -> None:
        """There is nobody to tell."""

    async def release(self) -> None:
        """The runtime unassigns them."""
