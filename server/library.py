"""Everything that runs name, by kind: for the API, and as the runtime takes it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from mend.server.document_checks import ScenarioChecker, SceneFileChecker, TreeChecker
from mend.server.documents import (
    DocumentKind,
    DocumentSummary,
    FixedDocuments,
    ScenarioSummary,
    SceneSummary,
)
from mend.server.journal.journal import Journal
from mend.server.journaled_documents import JournaledDocuments
from mend.server.limits import Limits
from mend.server.off_loop import OffLoop
from mend.server.run_preparation import RunPreparer
from mend.server.runtime.ports import PreparedRun
from mend.server.runtime.requests import RunRequest
from mend.server.scene_checks import WorldChecks
from mend.server.uploads import Uploads
from mend.tasks.scene import Scene


@dataclass(frozen=True, slots=True)
class Library:
    """The documents of a service. Implements `mend.server.runtime.ports.Preparation`."""

    trees: JournaledDocuments
    scenes: JournaledDocuments
    scenarios: JournaledDocuments
    preparer: RunPreparer
    uploads: Uploads
    journal: Journal
    off_loop: OffLoop

    async def prepare(self, request: RunRequest, scene: Scene | None = None) -> PreparedRun:
        """Read and check what a request names, for a `scene` that is there already if given.

        Raises `NotFoundError`, `WrongInputError` or `BusyError`.
        """
        named = [each for each in (request.tree, request.scene, request.scenario) if each]
        kinds = (DocumentKind.SCENARIO, DocumentKind.TREE, DocumentKind.SCENE)
        uploaded = await self.uploads.named_in(named, kinds)
        chars = sum(len(text) for texts in uploaded.values() for text in texts.values())
        return await self.off_loop.run(chars, self.preparer.prepare, request, uploaded, scene)

    async def scene(self, name: str) -> Scene:
        """A scene by its name. Raises `NotFoundError`, `WrongInputError` or `BusyError`."""
        uploaded = await self.uploads.named_in([name], (DocumentKind.SCENE,))
        chars = sum(len(text) for texts in uploaded.values() for text in texts.values())
        return await self.off_loop.run(chars, self.preparer.scene, name, uploaded)


def build_library(
    journal: Journal,
    fixed: Mapping[DocumentKind, FixedDocuments],
    worlds: WorldChecks,
    limits: Limits | None = None,
    off_loop: OffLoop | None = None,
    *,
    utc_now: Callable[[], datetime],
) -> Library:
    """The documents that are fixed, and those that a journal keeps, since `utc_now` said."""
    limits = limits or Limits()
    off_loop = off_loop or OffLoop(limits)
    uploads = Uploads(journal, fixed, limits)
    tree, scene, scenario = DocumentKind.TREE, DocumentKind.SCENE, DocumentKind.SCENARIO
    scenarios = JournaledDocuments(
        scenario,
        journal,
        fixed[scenario],
        ScenarioChecker(fixed, worlds),
        limits,
        utc_now=utc_now,
        needs=(tree, scene),
        summarize=_about_scenario,
        uploads=uploads,
        off_loop=off_loop,
    )
    trees = JournaledDocuments(
        tree,
        journal,
        fixed[tree],
        TreeChecker(fixed, worlds),
        limits,
        utc_now=utc_now,
        needs=(scene,),
        users=[scenarios],
        uploads=uploads,
        off_loop=off_loop,
    )
    scenes = JournaledDocuments(
        scene,
        journal,
        fixed[scene],
        SceneFileChecker(fixed, worlds),
        limits,
        utc_now=utc_now,
        users=[trees, scenarios],
        summarize=_about_scene,
        uploads=uploads,
        off_loop=off_loop,
    )
    preparer = RunPreparer(fixed, worlds)
    return Library(trees, scenes, scenarios, preparer, uploads, journal, off_loop)


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
