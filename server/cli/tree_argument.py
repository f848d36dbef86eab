"""The TREE of `mend run`: the name of a task tree, or a task file."""

from dataclasses import dataclass
from pathlib import Path

from server.cli.failures import CommandLineError
from server.cli.task_files import read_task, read_text
from tasks.library import TREES

SUFFIXES = (".yaml", ".yml", ".json")


@dataclass(frozen=True, slots=True)
class TreeArgument:
    """The tree's name and, where it is not built in, its file's text and scenes folder."""

    name: str
    text: str | None = None
    scenes: Path | None = None


def read_tree_argument(argument: str) -> TreeArgument:
    """Take what names a file for one, everything else for a tree's name.

    Raises `InvalidFileError` for a file with mistakes, `CommandLineError` for one that goes by the
    name of a built-in tree, and `OSError` for one that cannot be read.
    """
    path = Path(argument)
    if path.suffix not in SUFFIXES and "/" not in argument:
        return TreeArgument(argument)
    text = read_text(path)
    name = read_task(path).definition.name
    if name not in TREES.names():
        scenes = path.parent / "scenes"
        return TreeArgument(name, text, scenes if scenes.is_dir() else None)
    if text == TREES.read(name):
        return TreeArgument(name)
    raise CommandLineError(
        f"'{path}' has the name of a built-in task tree, '{name}': give it another name"
    )
