"""From a request to the event that begins a run."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from uuid import UUID, uuid4

from mend.errors import WrongInputError
from mend.server.journal import events as ev
from mend.server.limits import Limits
from mend.server.runtime.journaled_tree import read_nodes
from mend.server.runtime.ports import LIVE, Preparation, PreparedRun, SiteOffer, Worlds
from mend.server.runtime.requests import RunRequest, WorldOption
from mend.server.runtime.standing import stand
from mend.tasks.definition import TaskTreeDefinition
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
        if request.site is not None:
            request, offer = self._offered(request, request.site)
            prepared = await self._preparation.prepare(request, offer.scene)
            return await self._begun(uuid4(), request, prepared, offer.robots, author)
        if request.world == LIVE:
            if request.world_options:
                raise WrongInputError("'world_options' is for simulated worlds; 'live' has none")
        else:
            if request.robots:
                raise WrongInputError(
                    f"'robots' is for the world 'live'; '{request.world}' brings its own"
                )
            self._worlds.check(request.world, request.world_options)
        run = uuid4()
        prepared = await self._preparation.prepare(request)
        if request.world == LIVE:
            robots, scene = stand(request.robots, prepared.scene)
        else:
            robots, scene = robot_names(prepared.scene, run), prepared.scene
        return await self._begun(run, request, replace(prepared, scene=scene), robots, author)

    async def make_of(self, run: UUID, request: RunRequest, tree: TaskTreeDefinition) -> NewRun:
        """A run at a site of a tree that is no document; `run` is its id.

        Raises `NotFoundError`, `WrongInputError`, or `ConflictError` where a run has its robots.
        """
        assert request.site is not None, "only where there are robots already"
        request, offer = self._offered(request, request.site)
        prepared = PreparedRun(tree.name, tree.model_dump_json(), offer.scene)
        return await self._begun(run, request, prepared, offer.robots, None)

    def _offered(self, request: RunRequest, site: UUID) -> tuple[RunRequest, SiteOffer]:
        """The request with what a site says: there is a world already, with robots in it."""
        if isinstance(request.robots, dict):
            raise WrongInputError(
                "'robots' says who stands where, but those of a site stand where they are: list "
                "those that the run is to have"
            )
        offer = self._worlds.offer(site, request.robots)
        _refuse_what_the_site_says(request, offer)
        there = {"world": offer.world, "seed": offer.seed, "speed": offer.speed}
        return request.model_copy(update={**there, "robots": offer.robots}), offer

    async def _begun(
        self,
        run: UUID,
        request: RunRequest,
        prepared: PreparedRun,
        robots: Sequence[str],
        author: ev.Author | None,
    ) -> NewRun:
        started = ev.RunStarted(
            time=0.0,
            wall_time=self._utc_now(),
            run=run,
            tree_name=prepared.tree_name,
            tree={},
            scene=prepared.scene.model_dump(mode="json"),
            world=request.world,
            robots=list(robots),
            seed=request.seed,
            speed=request.speed,
            scenario=request.scenario,
            script=None if prepared.script is None else prepared.script.model_dump(mode="json"),
            options=request.model_dump(mode="json"),
            author=author,
            site=request.site,
        )
        return NewRun(started, prepared.tree, await read_nodes(prepared.tree))


def robot_names(scene: Scene, owner: UUID) -> list[str]:
    """What the robots of a simulated world are called, in the scene's order.

    `owner`: the run or the site that the world is of.
    """
    return [f"{each}-{str(owner)[:8]}" for each in frames_of(scene)]


def _refuse_too_much(request: RunRequest, limits: Limits) -> None:
    """Raises `WrongInputError`."""
    answers = request.answers if isinstance(request.answers, list) else []
    if len(answers) > limits.answers:
        raise WrongInputError(
            f"'answers' has {len(answers)} entries; at most {limits.answers} are taken",
            limit="answers",
        )
    refuse_too_many_options(request.world_options, limits)


def _refuse_what_the_site_says(request: RunRequest, offer: SiteOffer) -> None:
    """Raises `WrongInputError`."""
    for name in ("world", "seed", "speed"):
        wanted, there = getattr(request, name), getattr(offer, name)
        # Clients that send every field say the default where nobody has said anything.
        if wanted not in (RunRequest.model_fields[name].default, there):
            raise WrongInputError(
                f"'{name}' is {wanted}, but that of site {request.site} is {there}: leave it out"
            )
    for name in ("scene", "scenario", "interventions", "world_options"):
        if getattr(request, name):
            raise WrongInputError(
                f"'{name}' is for a run with a world of its own; that of site {request.site} is "
                "there already: leave it out"
            )


def refuse_too_many_options(options: Mapping[str, WorldOption], limits: Limits) -> None:
    """Raises `WrongInputError`."""
    if len(options) > limits.world_options:
        raise WrongInputError(
            f"'world_options' has {len(options)} entries; at most {limits.world_options} are taken",
            limit="world_options",
        )
    for name, value in options.items():
        if max(len(name), len(str(value))) > limits.option_chars:
            raise WrongInputError(
                f"the world option '{name[:40]}' is too long: its name and its text may have "
                f"{limits.option_chars} characters each",
                limit="option_chars",
            )
