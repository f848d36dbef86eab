"""Reading YAML (and so JSON) from strangers: safely, within limits, and knowing every line."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import yaml

MAX_BYTES = 256 * 1024
MAX_DEPTH = 20


class DocumentError(Exception):
    """A text cannot be read as a document; `problems` has one sentence with its line each."""

    def __init__(self, problems: list[str]) -> None:
        super().__init__("; ".join(problems))
        self.problems = problems


@dataclass(frozen=True, slots=True)
class Document:
    """What a text says, and where it says it."""

    data: Any
    root: yaml.Node

    def line_of(self, location: Sequence[int | str]) -> int:
        """The line of what is at a path of keys and indices, or of the nearest thing above it."""
        node = self.root
        for part in location:
            match node, part:
                case yaml.SequenceNode(value=values), int() if part < len(values):
                    node = values[part]
                case yaml.MappingNode(value=pairs), str():
                    node = next((value for key, value in pairs if key.value == part), node)
        return _line(node)


class _Loader(yaml.SafeLoader):
    """Safe, and with YAML 1.2's booleans: an answer `no` is a word, not False."""

    def construct_scalar(self, node: yaml.ScalarNode | yaml.MappingNode) -> Any:
        """A scalar's text; JSON writes rare characters as two escapes, which belong together."""
        text = str(super().construct_scalar(node))
        try:
            return text.encode("utf-16", "surrogatepass").decode("utf-16")
        except UnicodeDecodeError as error:
            raise yaml.constructor.ConstructorError(
                None, None, "this has half of a surrogate pair", node.start_mark
            ) from error


_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:bool", re.compile(r"^(?:true|True|TRUE|false|False|FALSE)$"), list("tTfF")
)


def read_document(text: str, max_bytes: int = MAX_BYTES, max_depth: int = MAX_DEPTH) -> Document:
    """Read a text. Raises `DocumentError`."""
    try:
        if len(text.encode()) > max_bytes:
            raise DocumentError([f"the file is larger than {max_bytes // 1024} KiB"])
        if excess := _excess(text, max_depth):
            raise DocumentError([excess])
        root = yaml.compose(text, _Loader)
        if root is None:
            raise DocumentError(["the file is empty"])
        if repeated := list(_repeated_keys(root)):
            raise DocumentError(repeated)
        return Document(_Loader("").construct_document(root), root)
    except (yaml.YAMLError, ValueError) as error:
        raise DocumentError([_sentence(error)]) from error


def _excess(text: str, max_depth: int) -> str | None:
    """What makes a document larger than it looks, found before anything is built from it."""
    depth = 0
    for event in yaml.parse(text, _Loader):
        where = f"line {event.start_mark.line + 1}" if event.start_mark else "somewhere"
        if isinstance(event, yaml.AliasEvent):
            return f"{where}: aliases (*) are not allowed here; write it out"
        if (tag := getattr(event, "tag", None)) is not None:
            return f"{where}: tags (!) are not allowed here; leave '{tag}' out"
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > max_depth:
            return f"{where}: this is nested deeper than {max_depth}"
    return None


def _repeated_keys(node: yaml.Node) -> Iterator[str]:
    match node:
        case yaml.MappingNode(value=pairs):
            seen = set[str]()
            for key, value in pairs:
                name = str(key.value)
                if name in seen:
                    yield f"line {_line(key)}: '{name}' is there twice"
                seen.add(name)
                yield from _repeated_keys(value)
        case yaml.SequenceNode(value=values):
            for value in values:
                yield from _repeated_keys(value)


def _sentence(error: Exception) -> str:
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark is not None:
        return f"line {error.problem_mark.line + 1}: {error.problem}"
    return str(error)


def _line(node: yaml.Node) -> int:
    return int(node.start_mark.line) + 1
