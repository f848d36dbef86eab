"""Everything that runs name, by kind: for the API, and as the runtime takes it."""

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from server.document_checks import Finder, ScenarioChecker, SceneFileChecker, TreeChecker
from server.documents import (
    SPOKEN,
    DocumentKind,
    DocumentSummary,
    FixedDocuments,
    ScenarioSummary,
    SceneSummary,
)
from server.errors import InvalidError, NotFoundError
from server.journal.journal import Journal
from server.journaled_documents import JournaledDocuments
from server.limits import Limits
from server.runtime.ports import LoadedTree
from server.scene_checks import WorldChecks
from tasks.library import NotInLibraryError
from tasks.problem import InvalidFileError
from tasks.scenario import Scenario


@dataclass(frozen=True, slots=True)
class Library:
    """The documents of a service.

    Implements `TreeSource` and `ScenarioSource` of `server.runtime.ports`.
    """

    trees: JournaledDocuments
    scenes: JournaledDocuments
    scenarios: JournaledDocuments
    fixed: Mapping[DocumentKind, FixedDocuments]
    journal: Journal

    async def load(self, name: str, scene: str | None = None) -> LoadedTree:
        """A tree and its scene; `scene` names another one that the tree fits.

        Raises `NotFoundError` or `InvalidError`.
        """
        finder = await self._finder(DocumentKind.TREE, name)
        return await asyncio.to_thread(_load_tree, finder, name, scene)

    async def load_scenario(self, name: str) -> Scenario:
        """Raises `NotFoundError` or `InvalidError`."""
        finder = await self._finder(DocumentKind.SCENARIO, name)
        try:
            return finder.scenario(name)
        except InvalidFileError as error:
            raise _unusable(DocumentKind.SCENARIO, name, error) from error

    async def _finder(self, kind: DocumentKind, name: str) -> Finder:
        uploaded = {each: await self.journal.documents(each) for each in DocumentKind}
        if name not in self.fixed[kind].names() and name not in uploaded[kind]:
            raise NotFoundError(f"there is no {SPOKEN[kind]} '{name}'")
        return Finder(self.fixed, uploaded)


def build_library(
    journal: Journal,
    fixed: Mapping[DocumentKind, FixedDocuments],
    worlds: WorldChecks,
    limits: Limits | None = None,
) -> Library:
    """The documents that are fixed, and those that a journal keeps."""
    most = (limits or Limits()).uploaded_chars
    tree, scene, scenario = DocumentKind.TREE, DocumentKind.SCENE, DocumentKind.SCENARIO
    scenarios = JournaledDocuments(
        scenario,
        journal,
        fixed[scenario],
        ScenarioChecker(fixed, worlds),
        most,
        needs=(tree, scene),
        summarize=_about_scenario,
    )
    trees = JournaledDocuments(
        tree,
        journal,
        fixed[tree],
        TreeChecker(fixed, worlds),
        most,
        needs=(scene,),
        users=[scenarios],
    )
    scenes = JournaledDocuments(
        scene,
        journal,
        fixed[scene],
        SceneFileChecker(fixed, worlds),
        most,
        users=[trees, scenarios],
        summarize=_about_scene,
    )
    return Library(trees, scenes, scenarios, fixed, journal)


def _load_tree(finder: Finder, name: str, scene: str | None) -> LoadedTree:
    try:
        chosen = finder.scene(scene) if scene else None
    except NotInLibraryError as error:
        raise NotFoundError(str(error)) from error
    except InvalidFileError as error:
        raise _unusable(DocumentKind.SCENE, scene or "", error) from error
    try:
        task = finder.task(name, chosen)
    except InvalidFileError as error:
        raise _unusable(DocumentKind.TREE, name, error) from error
    definition = task.definition.model_copy(
        update={"name": name, "scene": chosen.name if chosen else task.definition.scene}
    )
    return LoadedTree(name, definition, task.scene)


def _unusable(kind: DocumentKind, name: str, error: InvalidFileError) -> InvalidError:
    sentences = str(error).splitlines()
    return InvalidError(f"the {SPOKEN[kind]} '{name}' cannot be used", sentences)


def _about_scene(
    name: str, built_in: bool, definition: Mapping[str, Any] | None
) -> DocumentSummary:
    objects = None if definition is None else len(definition["objects"])
    places = None if definition is None else len(definition["places"])
    return SceneSummary(name=name, built_in=built_in, objects=objects, places=places)


def _about_scenario(
    name: str, built_in: bool, definition: Mapping[str, Any] | None
) -> DocumentSummary:
    fields = definition or {}
    return ScenarioSummary(
        name=name,
        built_in=built_in,
        tree=fields.get("tree"),
        description=fields.get("description", ""),
        answers=fields.get("answers", []),
    )
