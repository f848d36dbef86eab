"""What a run begins with, from the documents that a request names: read and checked as a whole."""

from collections.abc import Mapping
from dataclasses import dataclass

from mend.documents.problem import InvalidFileError
from mend.errors import NotFoundError, WrongInputError
from mend.robots.arm.feasibility.transfers import plan_transfers
from mend.server.behaviors import behavior_step_counts
from mend.server.document_checks import Finder
from mend.server.documents import SPOKEN, DocumentKind, FixedDocuments, Uploaded
from mend.server.errors import ImpossibleError
from mend.server.runtime.ports import LIVE, PreparedRun
from mend.server.runtime.requests import RunRequest
from mend.server.scene_checks import WorldChecks
from mend.sim.world import KnownReach
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.library import NotInLibraryError
from mend.tasks.scenario import Scenario
from mend.tasks.scenario_file import find_misfits, moved_scene
from mend.tasks.scene import Scene


@dataclass(frozen=True, slots=True)
class RunPreparer:
    """Prepares runs wherever that is done; holds nothing of the journal."""

    fixed: Mapping[DocumentKind, FixedDocuments]
    worlds: WorldChecks

    def prepare(
        self, request: RunRequest, uploaded: Uploaded, there: Scene | None = None
    ) -> PreparedRun:
        """`there`: the scene of a site, in which it is to be done.

        Raises `NotFoundError` or `WrongInputError`.
        """
        finder = Finder(self.fixed, uploaded)
        scenario = self._scenario(request, finder)
        chosen = there or (_scene(finder, request.scene) if request.scene else None)
        tree, scene = _load_tree(finder, request.tree, chosen)
        if request.world == LIVE:
            scene = scene or Scene(name="live", objects={}, places={})
        else:
            scene = scene or self._lay_out(request, tree)
            tree, scene = self._with_transfers(request.world, tree, scene)
            # Before the scenario has its way: out of reach is what it may put things to.
            self._refuse_impossible(request.world, scene, tree)
        if scenario is not None:
            scene = _moved(scene, scenario, tree)
        return PreparedRun(request.tree, tree.model_dump_json(), scene, scenario)

    def _scenario(self, request: RunRequest, finder: Finder) -> Scenario | None:
        if not request.scenario:
            return None
        try:
            scenario = finder.scenario(request.scenario)
        except InvalidFileError as error:
            raise _unusable(DocumentKind.SCENARIO, request.scenario, error) from error
        if scenario.tree != request.tree:
            raise WrongInputError(
                f"scenario '{scenario.name}' is for the tree '{scenario.tree}', "
                f"not '{request.tree}'"
            )
        return scenario

    def _lay_out(self, request: RunRequest, tree: TaskTreeDefinition) -> Scene:
        """A scene for a tree that has none. Raises `WrongInputError` where the world cannot."""
        adapter = self.worlds.adapter(request.world)
        if not adapter.lays_out_anything:
            raise WrongInputError(
                f"tree '{tree.name}' names no scene, and the world '{request.world}' needs one"
            )
        leaves = [each for each in tree.nodes if isinstance(each, BehaviorNode)]
        names = [(each.object, each.place) for each in leaves if each.object is not None]
        try:
            return adapter.lay_out(names, request.seed)
        except WrongInputError as error:
            raise WrongInputError(f"tree '{tree.name}' cannot be laid out: {error}") from error

    def _with_transfers(
        self, world: str, tree: TaskTreeDefinition, scene: Scene
    ) -> tuple[TaskTreeDefinition, Scene]:
        """What one robot alone fetches and another alone places, as two leaves."""
        adapter = self.worlds.adapter(world)
        if not isinstance(adapter, KnownReach):
            return tree, scene
        planned = plan_transfers(tree, scene, adapter.reach(scene))
        return planned.tree, planned.scene

    def _refuse_impossible(self, world: str, scene: Scene, tree: TaskTreeDefinition) -> None:
        """Raise `ImpossibleError` where the world's robot cannot do the tree in the scene."""
        check = self.worlds.check_of(world)
        problems = check(scene, tree.nodes) if check is not None else []
        if problems:
            raise ImpossibleError(
                f"the robot of the world '{world}' cannot do the tree '{tree.name}' in the scene "
                f"'{scene.name}'",
                problems,
            )

    def scene(self, name: str, uploaded: Uploaded) -> Scene:
        """A scene by its name. Raises `NotFoundError` or `WrongInputError`."""
        return _scene(Finder(self.fixed, uploaded), name)


def _scene(finder: Finder, name: str) -> Scene:
    try:
        return finder.scene(name)
    except NotInLibraryError as error:
        raise NotFoundError(str(error)) from error
    except InvalidFileError as error:
        raise _unusable(DocumentKind.SCENE, name, error) from error


def _load_tree(
    finder: Finder, name: str, chosen: Scene | None
) -> tuple[TaskTreeDefinition, Scene | None]:
    """A tree and its scene; `chosen` is another one that the tree fits."""
    try:
        task = finder.task(name, chosen)
    except NotInLibraryError as error:
        raise NotFoundError(f"there is no {SPOKEN[DocumentKind.TREE]} '{name}'") from error
    except InvalidFileError as error:
        raise _unusable(DocumentKind.TREE, name, error) from error
    named = chosen.name if chosen else task.definition.scene
    return task.definition.model_copy(update={"name": name, "scene": named}), task.scene


def _moved(scene: Scene, scenario: Scenario, tree: TaskTreeDefinition) -> Scene:
    """The scene as the scenario begins it. Raises `WrongInputError` where the two do not fit."""
    misfits = find_misfits(scenario, tree, scene, behavior_step_counts())
    if misfits:
        problems = [each.message for each in misfits]
        raise WrongInputError(f"scenario '{scenario.name}' does not fit this run", problems)
    return moved_scene(scene, scenario)


def _unusable(kind: DocumentKind, name: str, error: InvalidFileError) -> WrongInputError:
    sentences = str(error).splitlines()
    return WrongInputError(f"the {SPOKEN[kind]} '{name}' cannot be used", sentences)
