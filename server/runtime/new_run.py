"""From a request to the event that begins a run."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from uuid import UUID, uuid4

from mend.errors import WrongInputError
from mend.server.journal import events as ev
from mend.server.limits import Limits
from mend.server.runtime.journaled_tree import read_nodes
from mend.server.runtime.ports import LIVE, Preparation, Worlds
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.standing import stand
from mend.tasks.frames import frames_of
from mend.tasks.node_table import NodeTable
from mend.tasks.scene import Scene


@dataclass(frozen=True, slots=True)
class NewRun:
    """The event that begins a run, its tree left empty, and that tree: in JSON, and read."""

    started: ev.RunStarted
    tree: str
    nodes: NodeTable


class NewRuns:
    """Makes `run_started` of what a request names: the tree, the scene, the world, the scenario."""

    def __init__(
        self,
        preparation: Preparation,
        worlds: Worlds,
        utc_now: Callable[[], datetime],
        limits: Limits,
    ) -> None:
        self._preparation = preparation
        self._worlds = worlds
        self._utc_now = utc_now
        self._limits = limits

    async def make(self, request: RunRequest, author: ev.Author | None = None) -> NewRun:
        """Raises `NotFoundError` or `WrongInputError`."""
        _refuse_too_much(request, self._limits)
        if request.world == LIVE:
            if request.world_options:
                raise WrongInputError("'world_options' is for simulated worlds; 'live' has none")
        else:
            if request.robots:
                raise WrongInputError(
                    f"'robots' is for the world 'live'; '{request.world}' brings its own"
                )
            self._worlds.check(request.world, request.world_options)
        prepared = await self._preparation.prepare(request)
        run = uuid4()
        if request.world == LIVE:
            robots, scene = stand(request.robots, prepared.scene)
        else:
            robots, scene = _names(prepared.scene, run), prepared.scene
        started = ev.RunStarted(
            time=0.0,
            wall_time=self._utc_now(),
            run=run,
            tree_name=prepared.tree_name,
            tree={},
            scene=scene.model_dump(mode="json"),
            world=request.world,
            robots=robots,
            seed=request.seed,
            speed=request.speed,
            scenario=request.scenario,
            script=None if prepared.script is None else prepared.script.model_dump(mode="json"),
            options=request.model_dump(mode="json"),
            author=author,
        )
        return NewRun(started, prepared.tree, await read_nodes(prepared.tree))


def _names(scene: Scene, run: UUID) -> list[str]:
    """What the robots of a simulated world are called, in the scene's order."""
    return [f"{each}-{str(run)[:8]}" for each in frames_of(scene)]


def _refuse_too_much(request: RunRequest, limits: Limits) -> None:
    """Raises `WrongInputError`."""
    answers = request.answers if isinstance(request.answers, list) else []
    if len(answers) > limits.answers:
        raise WrongInputError(
            f"'answers' has {len(answers)} entries; at most {limits.answers} are taken",
            limit="answers",
        )
    if len(request.world_options) > limits.world_options:
        raise WrongInputError(
            f"'world_options' has {len(request.world_options)} entries; "
            f"at most {limits.world_options} are taken",
            limit="world_options",
        )
    for name, value in request.world_options.items():
        if max(len(name), len(str(value))) > limits.option_chars:
            raise WrongInputError(
                f"the world option '{name[:40]}' is too long: its name and its text may have "
                f"{limits.option_chars} characters each",
                limit="option_chars",
            )
