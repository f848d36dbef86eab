"""Reading scenario files: YAML or JSON, one sentence with its line per mistake."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from tasks.scenario import Scenario
from tasks.scene import Scene

SCENARIOS = Path(__file__).parent / "scenarios"
MAX_BYTES = 256 * 1024
MAX_DEPTH = 20


class ScenarioFileError(Exception):
    """A scenario file cannot be used; `problems` has one sentence per mistake."""

    def __init__(self, source: str, problems: list[str]) -> None:
        super().__init__("\n".join(f"{source}: {problem}" for problem in problems))
        self.source = source
        self.problems = problems


class _Loader(yaml.SafeLoader):
    """Safe, and with YAML 1.2's booleans: an answer `no` is a word, not False."""


_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:bool", re.compile(r"^(?:true|True|TRUE|false|False|FALSE)$"), list("tTfF")
)


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
    root = _compose(text, source)
    if repeated := list(_repeated_keys(root)):
        raise ScenarioFileError(source, repeated)
    try:
        data = _Loader("").construct_document(root)
    except (yaml.YAMLError, ValueError) as error:
        raise ScenarioFileError(source, [_yaml_problem(error)]) from error
    try:
        return Scenario.model_validate(data)
    except ValidationError as error:
        problems = [_problem(root, each["loc"], each["msg"]) for each in error.errors()]
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


def _compose(text: str, source: str) -> yaml.Node:
    """The checked document as nodes, which know their lines."""
    if len(text.encode()) > MAX_BYTES:
        raise ScenarioFileError(source, [f"the file is larger than {MAX_BYTES // 1024} KiB"])
    try:
        if problem := _excess(text):
            raise ScenarioFileError(source, [problem])
        root = yaml.compose(text, _Loader)
    except yaml.YAMLError as error:
        raise ScenarioFileError(source, [_yaml_problem(error)]) from error
    if root is None:
        raise ScenarioFileError(source, ["the file is empty"])
    return root


def _excess(text: str) -> str | None:
    """What makes a document larger than it looks, found before anything is built from it."""
    depth = 0
    for event in yaml.parse(text, _Loader):
        where = f"line {event.start_mark.line + 1}" if event.start_mark else "somewhere"
        if isinstance(event, yaml.AliasEvent):
            return f"{where}: aliases (*) are not allowed here; write it out"
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > MAX_DEPTH:
            return f"{where}: this is nested deeper than {MAX_DEPTH}"
    return None


def _repeated_keys(node: yaml.Node) -> Iterator[str]:
    match node:
        case yaml.MappingNode(value=pairs):
            seen = set[str]()
            for key, value in pairs:
                name = str(key.value)
                if name in seen:
                    yield f"line {key.start_mark.line + 1}: '{name}' is there twice"
                seen.add(name)
                yield from _repeated_keys(value)
        case yaml.SequenceNode(value=values):
            for value in values:
                yield from _repeated_keys(value)


def _yaml_problem(error: Exception) -> str:
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark is not None:
        return f"line {error.problem_mark.line + 1}: {error.problem}"
    return str(error)


def _problem(root: yaml.Node, location: tuple[int | str, ...], message: str) -> str:
    node = root
    for part in location:
        match node, part:
            case yaml.SequenceNode(value=values), int() if part < len(values):
                node = values[part]
            case yaml.MappingNode(value=pairs), str():
                node = next((value for key, value in pairs if key.value == part), node)
    where = ".".join(str(part) for part in location) or "the file"
    return f"line {node.start_mark.line + 1}: {where}: {message.removeprefix('Value error, ')}"
