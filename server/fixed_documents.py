"""Documents that cannot be changed: files that were named, files of a folder, the library."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mend.server.documents import DocumentKind, FixedDocuments
from mend.tasks.library import SCENARIOS, SCENES, TREES, NotInLibraryError


@dataclass(frozen=True, slots=True)
class GivenFiles:
    """The texts of the files that a command was given, by kind and name."""

    texts: Mapping[DocumentKind, Mapping[str, str]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class NamedTexts:
    """Texts by name."""

    texts: Mapping[str, str]

    def names(self) -> Sequence[str]:
        return sorted(self.texts)

    def read(self, name: str) -> str:
        return self.texts[name]


@dataclass(frozen=True, slots=True)
class Folder:
    """The YAML files of a folder, by their names without the ending."""

    path: Path

    def names(self) -> Sequence[str]:
        return sorted(each.stem for each in self.path.glob("*.yaml"))

    def read(self, name: str) -> str:
        return (self.path / f"{name}.yaml").read_text(encoding="utf-8")


@dataclass(frozen=True, slots=True)
class FirstOf:
    """Several holders of documents; of two with one name, the first one counts."""

    holders: Sequence[FixedDocuments]

    def names(self) -> Sequence[str]:
        return sorted({name for each in self.holders for name in each.names()})

    def read(self, name: str) -> str:
        """The text of a document. Raises `NotInLibraryError`."""
        # Only a listed name is opened, so that a name is never taken for a path.
        for each in self.holders:
            if name in each.names():
                return each.read(name)
        raise NotInLibraryError(f"there is no '{name}'")


def fixed_documents(
    given: GivenFiles, scenes_folder: Path | None
) -> Mapping[DocumentKind, FirstOf]:
    """What a service has from its start: what it was given, its folder of scenes, the library."""
    library = {
        DocumentKind.TREE: TREES,
        DocumentKind.SCENE: SCENES,
        DocumentKind.SCENARIO: SCENARIOS,
    }
    holders: dict[DocumentKind, list[FixedDocuments]] = {
        kind: [NamedTexts(given.texts.get(kind, {}))] for kind in library
    }
    if scenes_folder is not None:
        holders[DocumentKind.SCENE].append(Folder(scenes_folder))
    for kind, shelf in library.items():
        holders[kind].append(shelf)
    return {kind: FirstOf(each) for kind, each in holders.items()}
