"""The library: the task trees, scenes and scenarios that come with Mend, found by name."""

from dataclasses import dataclass
from importlib.resources import files

from mend.documents.problem import list_names
from mend.errors import NotFoundError

MOST_SHOWN = 64
"""Characters of an unknown name in a sentence; no name that there is has more."""


class NotInLibraryError(NotFoundError):
    """The library has nothing of that name; raised by `Shelf.read`."""


@dataclass(frozen=True, slots=True)
class Shelf:
    """One kind of file in the library: `folder` of the package, `what` for sentences."""

    folder: str
    what: str

    def names(self) -> list[str]:
        """What there is, sorted."""
        folder = files("mend.tasks").joinpath(self.folder)
        if not folder.is_dir():
            return []
        found = [entry.name for entry in folder.iterdir()]
        return sorted(name.removesuffix(".yaml") for name in found if name.endswith(".yaml"))

    def read(self, name: str) -> str:
        """The text of a file. Raises `NotInLibraryError`."""
        # Only a listed name is opened, so that a name is never taken for a path.
        if name not in self.names():
            shown = name if len(name) <= MOST_SHOWN else f"{name[:MOST_SHOWN]}..."
            raise NotInLibraryError(
                f"there is no {self.what} '{shown}' in the library; "
                f"it has {list_names(self.names()) or 'none'}"
            )
        return files("mend.tasks").joinpath(self.folder, f"{name}.yaml").read_text(encoding="utf-8")


TREES = Shelf("library", "task tree")
SCENES = Shelf("scenes", "scene")
SCENARIOS = Shelf("scenarios", "scenario")
