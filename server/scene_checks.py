"""Asking worlds, before anything moves, what in a scene their robots cannot do."""

from collections.abc import Callable, Sequence

from server.errors import InvalidError
from sim.world import SceneChecker, WorldAdapter
from tasks.definition import BehaviorNode
from tasks.plugins import load_plugins
from tasks.scene import Scene
from tasks.scene_problem import SceneProblem

WorldCheck = Callable[[Scene, Sequence[BehaviorNode]], list[SceneProblem]]


def world_check(world: str) -> WorldCheck | None:
    """How a world checks scenes; None where it does not.

    Raises `InvalidError` where there is no such world, and `WorldUnavailableError`.
    """
    adapters: dict[str, WorldAdapter] = dict(load_plugins("mend.worlds"))
    if world not in adapters:
        raise InvalidError(f"there is no world '{world}'; there are {', '.join(sorted(adapters))}")
    adapter = adapters[world]
    adapter.check_available()
    return adapter.check_scene if isinstance(adapter, SceneChecker) else None
