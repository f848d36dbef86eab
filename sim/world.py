"""A world: stands in for hardware and the people around it; workcell and tabletop are two."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from pydantic import BaseModel

from mend.documents.strict_model import StrictModel
from mend.errors import UnavailableError
from mend.robots.agent import AgentGroup
from mend.robots.arm.body import Reach
from mend.robots.link.messages import ShownObject, ShownPose
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.intervention import Intervention
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

if TYPE_CHECKING:
    from mend.robots.vision.color_model import ColorModel


class WorldSetup(StrictModel):
    """Everything a simulated world's process is told at its start.

    `robots` are in the order of the scene's `robots`. `speed` is simulated seconds per second,
    None as fast as possible. `interventions` are a scenario's, triggered by task progress.
    `snapshot` rebuilds an earlier world.
    """

    robots: list[str]
    scene: Scene
    seed: int
    speed: float | None
    interventions: list[ScriptedIntervention] = []
    options: dict[str, Any] = {}
    snapshot: dict[str, Any] | None = None


class World(Protocol):
    """A simulated world with robots, which know it by their bodies alone.

    What is here belongs to the clock, to the person and to the journal.
    """

    def time_s(self) -> float:
        """The world's clock."""
        ...

    def advance_cycle(self) -> None:
        """Let one control cycle pass, for all bodies at once."""
        ...

    def intervene(self, intervention: Intervention) -> str:
        """Do what a person does, now (a pull or a hand-over goes on over the next cycles).

        Returns an empty string, or one sentence that says why it cannot be done.
        """
        ...

    def snapshot(self) -> dict[str, Any]:
        """The state from which `restore` can rebuild the world; JSON-compatible.

        Part poses, what is held (and where it last rested), stolen and blocked, and the clock.
        """
        ...

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Rebuild the world. What was held lies where it last rested; the arm is at neutral."""
        ...

    def close(self) -> None: ...


@runtime_checkable
class LeapingWorld(Protocol):
    """A world that knows of cycles in which nothing happens before they come."""

    def leap(self, until_s: float) -> None:
        """Let cycles that end before a time pass at once, as far as nothing happens in them.

        Called while no robot does anything, before a cycle; everything is then as if these had
        passed one by one.
        """
        ...


@runtime_checkable
class ShownWorld(Protocol):
    """A world that shows people where everything really is; no robot may ask for that."""

    @property
    def shown_objects(self) -> Sequence[ShownObject]:
        """What it shows, always the same."""
        ...

    def shown_poses(self) -> Sequence[ShownPose]:
        """Where that is now, in the same order."""
        ...


class WorldUnavailableError(UnavailableError):
    """A world cannot run on this machine; the message says what to install."""


class WorldAdapter(Protocol):
    """What the entry point group `mend.worlds` provides: one kind of world."""

    @property
    def own_process(self) -> bool:
        """Whether it has to run in a process of its own (it blocks, or may crash)."""
        ...

    @property
    def lays_out_anything(self) -> bool:
        """Whether it makes up objects and places that a tree names and no scene file describes."""
        ...

    @property
    def options(self) -> type[BaseModel]:
        """What a run may choose about it; every field has a default, others are forbidden."""
        ...

    def check_available(self) -> None:
        """Raise `WorldUnavailableError` if it cannot run here."""
        ...

    def lay_out(self, names: Iterable[tuple[str, str | None]], seed: int) -> Scene:
        """A scene for the (object, place) names of a tree, where `lays_out_anything`.

        Raises `ValueError` when there is no room for all of them.
        """
        ...

    def create_agents(self, setup: WorldSetup) -> AgentGroup:
        """Build the world and the robots in it."""
        ...


@runtime_checkable
class KnownReach(Protocol):
    """A world adapter that tells, before anything moves, how far each of its robots reaches."""

    def reach(self, scene: Scene) -> Reach:
        """In the robots' own base frames."""
        ...


@runtime_checkable
class ParticularWorld(Protocol):
    """A world adapter that tells scenes of its kind from those of others."""

    def takes(self, scene: Scene) -> bool:
        """Whether a scene is one of this kind at all, whatever may be wrong with it."""
        ...


@runtime_checkable
class ModelProvider(Protocol):
    """A world adapter whose robot can be drawn from model files."""

    @property
    def model(self) -> str:
        """What the files go by, as its bodies say."""
        ...

    def model_folder(self) -> Path:
        """Holds `robot.urdf` and the meshes that it names relative to itself.

        Raises `WorldUnavailableError` where they cannot be had.
        """
        ...


@runtime_checkable
class ColorTeacher(Protocol):
    """A world adapter whose pictures a colour model can be trained from."""

    def train_colors(self, scene: Scene) -> "ColorModel":
        """Learn the colours of a scene's objects from rendered pictures of them.

        Raises `WrongInputError` for an object without a colour of its own, and
        `WorldUnavailableError`.
        """
        ...


@runtime_checkable
class SceneChecker(Protocol):
    """A world adapter that tells, before anything moves, what in a scene its robot cannot do."""

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps its robot from doing the leaves among `nodes`; empty where nothing does.

        `nodes` are a whole tree's, for its order and its alternatives, or leaves alone, which all
        are done. Without any, every object of the scene is checked by itself. Raises
        `WorldUnavailableError`.
        """
        ...
