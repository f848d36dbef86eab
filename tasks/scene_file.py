"""Scene files: reading and checking them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from mend.documents.document import DocumentError, LinedMapping, read_document, read_text
from mend.documents.kinds_of_files import not_the_kind
from mend.documents.problem import InvalidFileError, Problem
from mend.documents.validation import find_line, show_kind, validate_part
from mend.tasks.library import SCENES
from mend.tasks.part_rows import expand_rows
from mend.tasks.scene import Scene


@dataclass(frozen=True, slots=True)
class ReadScene:
    """A scene, and the document that it was read from, several poses as several entries."""

    scene: Scene
    document: LinedMapping

    def line_of(self, where: Sequence[str]) -> int:
        """The line of what a `SceneProblem` is about."""
        return find_line(self.document, where)


def check_scene_file(path: Path) -> Scene:
    """Read and check a scene file (YAML or JSON). Raises `InvalidFileError`."""
    return read_scene_file(path).scene


def check_scene_text(text: str, *, source: str = "scene") -> Scene:
    """Check the text of a scene file; `source` names it in errors. Raises `InvalidFileError`."""
    return read_scene_text(text, source=source).scene


def read_scene_file(path: Path) -> ReadScene:
    """Read and check a scene file, and keep the line of everything. Raises `InvalidFileError`."""
    try:
        text = read_text(path)
    except DocumentError as error:
        raise InvalidFileError(str(path), [error.problem]) from error
    return read_scene_text(text, source=str(path))


def read_scene_text(text: str, *, source: str = "scene") -> ReadScene:
    """As `read_scene_file`, for the text of one. Raises `InvalidFileError`."""
    try:
        document, problems = read_document(text)
    except DocumentError as error:
        raise InvalidFileError(source, [error.problem]) from error
    if not isinstance(document, LinedMapping):
        message = f"a scene file is a mapping, but this is {show_kind(document)}"
        raise InvalidFileError(source, [*problems, Problem(1, None, message)])
    if other := not_the_kind(document, "a scene"):
        raise InvalidFileError(source, [other])
    problems += expand_rows(document)
    scene, mistakes = validate_part(Scene, document)
    problems += mistakes
    if scene is None or problems:
        raise InvalidFileError(source, problems)
    return ReadScene(scene, document)


@cache
def built_in_scene(name: str) -> Scene:
    """A scene of the library. Raises `NotInLibraryError`."""
    return check_scene_text(SCENES.read(name), source=f"scenes/{name}.yaml")
