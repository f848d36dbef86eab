"""From a request to the event that begins a run."""

from collections.abc import Callable
from datetime import datetime
from uuid import uuid4

from server.errors import InvalidError
from server.journal import events as ev
from server.runtime.ports import LIVE, ScenarioSource, TreeSource, Worlds
from server.runtime.requests import RunRequest
from tasks.scenario import Scenario
from tasks.scene import Scene


class NewRuns:
    """Makes `run_started` of what a request names: the tree, the scene, the world, the scenario."""

    def __init__(
        self,
        trees: TreeSource,
        scenarios: ScenarioSource,
        worlds: Worlds,
        utc_now: Callable[[], datetime],
    ) -> None:
        self._trees = trees
        self._scenarios = scenarios
        self._worlds = worlds
        self._utc_now = utc_now

    async def make(self, request: RunRequest) -> ev.RunStarted:
        """Raises `NotFoundError` or `InvalidError`."""
        scenario = self._scenarios.load(request.scenario) if request.scenario else None
        if scenario is not None and scenario.tree != request.tree:
            raise InvalidError(
                f"scenario '{scenario.name}' is for the tree '{scenario.tree}', "
                f"not '{request.tree}'"
            )
        tree = await self._trees.load(request.tree)
        if request.world == LIVE:
            scene = tree.scene or Scene(name="live", objects={}, places={})
        else:
            if request.robots:
                raise InvalidError(
                    f"'robots' is for the world 'live'; '{request.world}' brings its own"
                )
            self._worlds.check(request.world)
            scene = tree.scene or self._worlds.lay_out(request.world, tree, request.seed)
        if scenario is not None:
            scene = _moved(scene, scenario)
        run = uuid4()
        return ev.RunStarted(
            time=0.0,
            wall_time=self._utc_now(),
            run=run,
            tree_name=tree.name,
            tree=tree.definition.to_json(),
            scene=scene.model_dump(mode="json"),
            world=request.world,
            robots=request.robots if request.world == LIVE else [f"pr2-{str(run)[:8]}"],
            seed=request.seed,
            speed=request.speed,
            scenario=request.scenario,
            options=request.model_dump(mode="json"),
        )


def _moved(scene: Scene, scenario: Scenario) -> Scene:
    """The scene with the objects where the scenario wants them. Raises `InvalidError`."""
    unknown = sorted(set(scenario.scene) - set(scene.objects))
    if unknown:
        raise InvalidError(
            f"scenario '{scenario.name}' moves '{unknown[0]}', which scene '{scene.name}' "
            "does not have"
        )
    objects = {
        name: part.model_copy(update={"pose": scenario.scene.get(name, part.pose)})
        for name, part in scene.objects.items()
    }
    return scene.model_copy(update={"objects": objects})
