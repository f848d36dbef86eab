"""Reading scenario files: YAML or JSON, one sentence with its line per mistake."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from tasks.document import Document, DocumentError, read_document
from tasks.scenario import Scenario
from tasks.scene import Scene

SCENARIOS = Path(__file__).parent / "scenarios"


class ScenarioFileError(Exception):
    """A scenario file cannot be used; `problems` has one sentence per mistake."""

    def __init__(self, source: str, problems: list[str]) -> None:
        super().__init__("\n".join(f"{source}: {problem}" for problem in problems))
        self.source = source
        self.problems = problems


def scenario_names() -> list[str]:
    """The scenarios that come with Mend."""
    return sorted(path.stem for path in SCENARIOS.glob("*.yaml"))


def load_scenario(name: str) -> Scenario:
    """Read a scenario that comes with Mend; never any other file, whatever the name.

    Raises `ScenarioFileError`.
    """
    if name not in scenario_names():
        known = ", ".join(scenario_names())
        raise ScenarioFileError(name, [f"there is no such scenario; there are {known}"])
    return read_scenario(SCENARIOS / f"{name}.yaml")


def read_scenario(path: Path) -> Scenario:
    """Read anybody's scenario file. Raises `ScenarioFileError`."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioFileError(str(path), [f"the file cannot be read: {error}"]) from error
    return parse_scenario(text, str(path))


def parse_scenario(text: str, source: str) -> Scenario:
    """Read a scenario from text; `source` says in errors where it is from.

    Raises `ScenarioFileError`.
    """
    try:
        document = read_document(text)
    except DocumentError as error:
        raise ScenarioFileError(source, error.problems) from error
    try:
        return Scenario.model_validate(document.data)
    except ValidationError as error:
        problems = [_problem(document, each["loc"], each["msg"]) for each in error.errors()]
        raise ScenarioFileError(source, problems) from error


def scene_problems(scenario: Scenario, scene: Scene) -> list[str]:
    """One sentence for each object or place of a scenario that the scene does not have."""

    def unknown(kind: str, name: str | None, known: Any, where: str) -> Iterator[str]:
        if name is not None and name not in known:
            yield f"{where} names the {kind} '{name}', which the scene '{scene.name}' has not"

    problems: list[str] = []
    for name in scenario.scene:
        problems += unknown("object", name, scene.objects, "scene")
    for index, each in enumerate(scenario.interventions):
        where = f"interventions[{index}]"
        if each.when is not None:
            problems += unknown("object", each.when.object, scene.objects, f"{where}.when")
        problems += unknown("object", each.do.object, scene.objects, f"{where}.do")
        problems += unknown("place", each.do.place, scene.places, f"{where}.do")
    return problems


def _problem(document: Document, location: tuple[int | str, ...], message: str) -> str:
    where = ".".join(str(part) for part in location) or "the file"
    message = message.removeprefix("Value error, ")
    return f"line {document.line_of(location)}: {where}: {message}"
