"""The TREE of `mend run`: the name of a task tree, or a task file."""

from dataclasses import dataclass
from pathlib import Path

SUFFIXES = (".yaml", ".yml", ".json")


@dataclass(frozen=True, slots=True)
class TreeArgument:
    """The tree's name and, where it is a file's, the file's text."""

    name: str
    text: str | None = None


def read_tree_argument(argument: str) -> TreeArgument:
    if Path(argument).suffix not in SUFFIXES and "/" not in argument:
        return TreeArgument(argument)
    path = Path(argument)
    return TreeArgument(path.stem, path.read_text(encoding="utf-8"))
