"""Scenario files: reading and checking them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from mend.documents.document import DocumentError, LinedMapping, read_document, read_text
from mend.documents.problem import InvalidFileError, Problem
from mend.documents.validation import find_line, show_kind, validate_part
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.intervention import OF_BUILDINGS, Act
from mend.tasks.library import SCENARIOS
from mend.tasks.scenario import Scenario, Trigger
from mend.tasks.scenario_heights import heights_out_of_place
from mend.tasks.scene import Scene


@dataclass(frozen=True, slots=True)
class Misfit:
    """What a scenario expects of its tree or scene and does not get.

    `where` are the keys to it in the scenario's document.
    """

    where: tuple[int | str, ...]
    message: str


@dataclass(frozen=True, slots=True)
class ReadScenario:
    """A scenario, and the document that it was read from."""

    scenario: Scenario
    document: LinedMapping

    def problem(self, misfit: Misfit) -> Problem:
        """A misfit with its line."""
        return Problem(find_line(self.document, misfit.where), None, misfit.message)


def check_scenario_text(text: str, *, source: str = "scenario") -> Scenario:
    """Check the text of a scenario file; `source` names it in errors.

    Raises `InvalidFileError`.
    """
    return read_scenario_text(text, source=source).scenario


def read_scenario_file(path: Path) -> ReadScenario:
    """Read and check a scenario file, and keep the line of everything.

    Raises `InvalidFileError`.
    """
    try:
        text = read_text(path)
    except DocumentError as error:
        raise InvalidFileError(str(path), [error.problem]) from error
    return read_scenario_text(text, source=str(path))


def read_scenario_text(text: str, *, source: str = "scenario") -> ReadScenario:
    """As `read_scenario_file`, for the text of one. Raises `InvalidFileError`."""
    try:
        document, problems = read_document(text)
    except DocumentError as error:
        raise InvalidFileError(source, [error.problem]) from error
    if not isinstance(document, LinedMapping):
        message = f"a scenario file is a mapping, but this is {show_kind(document)}"
        raise InvalidFileError(source, [*problems, Problem(1, None, message)])
    scenario, mistakes = validate_part(Scenario, document)
    problems += mistakes
    if scenario is None or problems:
        raise InvalidFileError(source, problems)
    return ReadScenario(scenario, document)


@cache
def built_in_scenario(name: str) -> Scenario:
    """A scenario of the library. Raises `NotInLibraryError`."""
    return check_scenario_text(SCENARIOS.read(name), source=f"scenarios/{name}.yaml")


def find_misfits(
    scenario: Scenario,
    tree: TaskTreeDefinition,
    scene: Scene | None,
    step_counts: Mapping[str, int | None],
) -> list[Misfit]:
    """What a scenario names and the tree's behaviors or the scene, where it is known, have not.

    `step_counts` says by the name of a behavior how many steps it has, None where that depends.
    """
    misfits = [] if scene is None else _missing_in_scene(scenario, scene)
    for pose, why in [] if scene is None else heights_out_of_place(scenario, scene):
        misfits.append(Misfit(pose, f"{_spoken(pose)} {why}"))
    for index, each in enumerate(scenario.interventions):
        if each.do.act is Act.PLACE and each.do.place is None:
            where = ("interventions", index, "do")
            misfits.append(Misfit(where, f"{_spoken(where)}: act 'place' needs a 'place'"))
        if each.when is not None and (scene is None or each.when.object in scene.objects):
            misfits += _missing_steps(each.when, index, tree, step_counts)
    return misfits


def _missing_in_scene(scenario: Scenario, scene: Scene) -> list[Misfit]:
    def unknown(kind: str, name: str | None, known: Any, *where: int | str) -> Iterator[Misfit]:
        if name is not None and name not in known:
            has_not = f"'{name}', which the scene '{scene.name}' has not"
            key = name if where == ("scene",) else kind
            yield Misfit((*where, key), f"{_spoken(where)} names the {kind} {has_not}")

    misfits: list[Misfit] = []
    for name in scenario.scene:
        misfits += unknown("object", name, scene.objects, "scene")
    for index, each in enumerate(scenario.interventions):
        where = ("interventions", index)
        if each.do.act in OF_BUILDINGS and not scene.setting:
            do = (*where, "do")
            message = f"'{each.do.act}' is for buildings, and the scene '{scene.name}' is none"
            misfits.append(Misfit((*do, "act"), f"{_spoken(do)}: {message}"))
        if each.when is not None:
            misfits += unknown("object", each.when.object, scene.objects, *where, "when")
        misfits += unknown("object", each.do.object, scene.objects, *where, "do")
        misfits += unknown("place", each.do.place, scene.places, *where, "do")
    return misfits


def _missing_steps(
    when: Trigger, index: int, tree: TaskTreeDefinition, step_counts: Mapping[str, int | None]
) -> Iterator[Misfit]:
    """A step that none of the behaviors has that handle the object, or that nothing handles."""
    where = ("interventions", index, "when")
    leaves = [each for each in tree.nodes if isinstance(each, BehaviorNode) and each.object]
    behaviors = {each.behavior for each in leaves if each.object == when.object}
    if not behaviors:
        handled = ", ".join(sorted({each.object for each in leaves if each.object}))
        yield Misfit(
            (*where, "object"),
            f"{_spoken(where)} waits for a step with '{when.object}', which no leaf of the task "
            f"tree '{tree.name}' handles; name an object that one handles ({handled or 'none'}), "
            "or a time (at_s)",
        )
        return
    counts = {each: step_counts.get(each) for each in sorted(behaviors)}
    if any(count is None or count >= when.step for count in counts.values()):
        return
    have = " and ".join(f"'{name}' has the steps 1 to {count}" for name, count in counts.items())
    yield Misfit(
        (*where, "step"),
        f"{_spoken(where)} names step {when.step} for '{when.object}', but {have}",
    )


def _spoken(where: Sequence[int | str]) -> str:
    """Where something stands, as in `interventions[0].when`."""
    spoken = "".join(f"[{each}]" if isinstance(each, int) else f".{each}" for each in where)
    return spoken.removeprefix(".")


def moved_scene(scene: Scene, scenario: Scenario) -> Scene:
    """The scene with its objects where the scenario wants them.

    Raises `ValueError` for an object that the scene does not have.
    """
    unknown = sorted(set(scenario.scene) - set(scene.objects))
    if unknown:
        raise ValueError(
            f"scenario '{scenario.name}' moves '{unknown[0]}', which scene '{scene.name}' "
            "does not have"
        )
    objects = {
        name: part.model_copy(update={"pose": scenario.scene.get(name, part.pose)})
        for name, part in scene.objects.items()
    }
    return scene.model_copy(update={"objects": objects})
