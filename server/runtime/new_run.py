"""From a request to the event that begins a run."""

import asyncio
from collections.abc import Callable
from datetime import datetime
from uuid import uuid4

from server.behaviors import behavior_step_counts
from server.errors import InvalidError
from server.journal import events as ev
from server.limits import Limits
from server.runtime.ports import LIVE, ScenarioSource, TreeSource, Worlds
from server.runtime.requests import RunRequest
from tasks.definition import TaskTreeDefinition
from tasks.scenario import Scenario
from tasks.scenario_file import find_misfits, moved_scene
from tasks.scene import Scene


class NewRuns:
    """Makes `run_started` of what a request names: the tree, the scene, the world, the scenario."""

    def __init__(
        self,
        trees: TreeSource,
        scenarios: ScenarioSource,
        worlds: Worlds,
        utc_now: Callable[[], datetime],
        limits: Limits,
    ) -> None:
        self._trees = trees
        self._scenarios = scenarios
        self._worlds = worlds
        self._utc_now = utc_now
        self._limits = limits

    async def make(self, request: RunRequest, author: ev.Author | None = None) -> ev.RunStarted:
        """Raises `NotFoundError` or `InvalidError`."""
        _refuse_too_much(request, self._limits)
        scenario = None
        if request.scenario:
            scenario = await self._scenarios.load_scenario(request.scenario)
        if scenario is not None and scenario.tree != request.tree:
            raise InvalidError(
                f"scenario '{scenario.name}' is for the tree '{scenario.tree}', "
                f"not '{request.tree}'"
            )
        tree = await self._trees.load(request.tree, request.scene)
        if request.world == LIVE:
            scene = tree.scene or Scene(name="live", objects={}, places={})
        else:
            if request.robots:
                raise InvalidError(
                    f"'robots' is for the world 'live'; '{request.world}' brings its own"
                )
            self._worlds.check(request.world, request.world_options)
            scene = tree.scene or self._worlds.lay_out(request.world, tree, request.seed)
            # Before the scenario has its way: out of reach is what it may put things to.
            refuse = self._worlds.refuse_impossible
            await asyncio.to_thread(refuse, request.world, scene, tree)
        if scenario is not None:
            scene = _moved(scene, scenario, tree.definition)
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
            script=None if scenario is None else scenario.model_dump(mode="json"),
            options=request.model_dump(mode="json"),
            author=author,
        )


def _refuse_too_much(request: RunRequest, limits: Limits) -> None:
    """Raises `InvalidError`."""
    answers = request.answers if isinstance(request.answers, list) else []
    if len(answers) > limits.answers:
        raise InvalidError(
            f"'answers' has {len(answers)} entries; at most {limits.answers} are taken",
            limit="answers",
        )
    if len(request.world_options) > limits.world_options:
        raise InvalidError(
            f"'world_options' has {len(request.world_options)} entries; "
            f"at most {limits.world_options} are taken",
            limit="world_options",
        )
    for name, value in request.world_options.items():
        if max(len(name), len(str(value))) > limits.option_chars:
            raise InvalidError(
                f"the world option '{name[:40]}' is too long: its name and its text may have "
                f"{limits.option_chars} characters each",
                limit="option_chars",
            )


def _moved(scene: Scene, scenario: Scenario, tree: TaskTreeDefinition) -> Scene:
    """The scene as the scenario begins it. Raises `InvalidError` where the two do not fit."""
    misfits = find_misfits(scenario, tree, scene, behavior_step_counts())
    if misfits:
        problems = [each.message for each in misfits]
        raise InvalidError(f"scenario '{scenario.name}' does not fit this run", problems)
    return moved_scene(scene, scenario)
