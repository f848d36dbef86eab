"""Asking worlds, before anything moves, what in a scene their robots cannot do."""

from collections.abc import Callable, Mapping, Sequence

from mend.errors import WrongInputError
from mend.robots.arm.body import Reach
from mend.sim.world import (
    KnownReach,
    ParticularWorld,
    SceneChecker,
    WorldAdapter,
    WorldUnavailableError,
)
from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition
from mend.tasks.frames import frames_of
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

WorldCheck = Callable[[Scene, Sequence[GoalNode | BehaviorNode]], list[SceneProblem]]


class WorldChecks:
    """The worlds that check scenes and can run here.

    Each checks the scenes that are for it; one that was `asked_for` checks whatever it is given.
    """

    def __init__(self, adapters: Mapping[str, WorldAdapter], *, asked_for: bool = False) -> None:
        self._adapters = adapters
        self._asked_for = asked_for

    def __reduce__(
        self,
    ) -> "tuple[Callable[[list[str], bool], WorldChecks], tuple[list[str], bool]]":
        # Another process loads them itself: a world need not be picklable.
        return _load_worlds, (list(self._adapters), self._asked_for)

    def only(self, world: str) -> "WorldChecks":
        """One of the worlds alone.

        Raises `WrongInputError` where there is no such world, and `WorldUnavailableError`.
        """
        if world not in self._adapters:
            known = ", ".join(sorted(self._adapters))
            raise WrongInputError(f"there is no world '{world}'; there are {known}")
        self._adapters[world].check_available()
        return WorldChecks({world: self._adapters[world]}, asked_for=True)

    def adapter(self, world: str) -> WorldAdapter:
        """A world by its name."""
        return self._adapters[world]

    def check_of(self, world: str) -> WorldCheck | None:
        """How a world checks scenes; None where it does not."""
        adapter = self._adapters[world]
        return adapter.check_scene if isinstance(adapter, SceneChecker) else None

    def try_scene(self, scene: Scene) -> dict[str, list[SceneProblem]]:
        """What each world's robot cannot do with the objects of a scene by themselves."""
        return {name: check(scene, []) for name, check in self._checks(scene)}

    def reaches(self, world: str, scene: Scene) -> dict[str, tuple[Reach, float, float]]:
        """How far each robot of a scene reaches in a world, and from which point of the scene's
        plane; nothing where the world does not know.
        """
        adapter = self._adapters[world]
        if not isinstance(adapter, KnownReach):
            return {}
        reach = adapter.reach(scene)
        return {
            name: (reach, *frame.to_scene(*reach.origin))
            for name, frame in frames_of(scene).items()
        }

    def try_tree(self, scene: Scene, tree: TaskTreeDefinition) -> dict[str, list[SceneProblem]]:
        """What keeps each world's robot from doing a tree in a scene."""
        return {name: check(scene, tree.nodes) for name, check in self._checks(scene)}

    def _checks(self, scene: Scene) -> list[tuple[str, WorldCheck]]:
        found = []
        for name, adapter in sorted(self._adapters.items()):
            asked = self._asked_for or _takes(adapter, scene)
            check = self.check_of(name) if asked and _can_run(adapter) else None
            if check is not None:
                found.append((name, check))
        return found


def _load_worlds(names: list[str], asked_for: bool) -> WorldChecks:
    """The installed worlds of these names."""
    installed = load_plugins("mend.worlds")
    return WorldChecks({name: installed[name] for name in names}, asked_for=asked_for)


def load_world_checks() -> WorldChecks:
    """The worlds that are installed."""
    return WorldChecks(load_plugins("mend.worlds"))


def _takes(adapter: WorldAdapter, scene: Scene) -> bool:
    return not isinstance(adapter, ParticularWorld) or adapter.takes(scene)


def _can_run(adapter: WorldAdapter) -> bool:
    try:
        adapter.check_available()
    except WorldUnavailableError:
        return False
    return True
