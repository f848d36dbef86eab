"""The task trees that runs may name: the built-in ones and those that were uploaded."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from server.errors import ConflictError, InvalidError, NotFoundError
from server.journal.journal import Journal
from server.runtime.views import View
from tasks.scenario import Scenario
from tasks.scene import Scene


class TreeSummary(View):
    """One line about a task tree. `built_in` ones cannot be replaced or deleted."""

    name: str
    built_in: bool


class TreeView(TreeSummary):
    """A task tree: its file's `text`, and the `definition` in its JSON form."""

    text: str
    definition: dict[str, Any]


class TreeMistake(View):
    """One mistake of a task file: where it is, from 1, and one sentence.

    `column` is where the line's content begins, or exactly where a text stops being readable.
    """

    line: int | None
    column: int | None
    node: str | None
    message: str


class TreeCheck(View):
    """What a task file is worth: its `definition` in JSON form, or what is wrong with it."""

    name: str | None
    definition: dict[str, Any] | None
    errors: list[TreeMistake]


class WrongTreeError(InvalidError):
    """A task file has mistakes."""

    def __init__(self, mistakes: Sequence[TreeMistake], sentences: list[str]) -> None:
        count = "a mistake" if len(mistakes) == 1 else f"{len(mistakes)} mistakes"
        super().__init__(f"the task file has {count}", sentences)
        self.mistakes = list(mistakes)


@dataclass(frozen=True, slots=True)
class CheckedTree:
    """What a checker found in a file without mistakes; `name` None where the file has none."""

    name: str | None
    definition: dict[str, Any]


TreeChecker = Callable[[str], CheckedTree]
"""Reads a task file. Raises `WrongTreeError` with every mistake."""


class TreeLibrary(Protocol):
    """Where the API finds, keeps and deletes task trees."""

    async def trees(self) -> list[TreeSummary]: ...

    async def tree(self, name: str) -> TreeView:
        """Raises `NotFoundError`."""
        ...

    def check(self, text: str) -> TreeCheck:
        """Check a task file without keeping it."""
        ...

    async def save(self, name: str | None, text: str) -> tuple[TreeView, bool]:
        """Check and keep a task file; the second value says whether its name is new.

        `name` wins over the file's own. Raises `InvalidError`, `ConflictError` (built in).
        """
        ...

    async def delete(self, name: str) -> None:
        """Raises `NotFoundError`, `ConflictError` (built in)."""
        ...


class SceneShelf(Protocol):
    """Where the API finds scenes."""

    def names(self) -> list[str]: ...

    def scene(self, name: str) -> Scene:
        """Raises `NotFoundError`, `InvalidError` (a file with mistakes)."""
        ...


class ScenarioLibrary(Protocol):
    """Where the API finds scenarios."""

    def scenarios(self) -> list[Scenario]: ...


class JournaledTrees:
    """A `TreeLibrary` that keeps uploaded task files in the journal."""

    def __init__(self, journal: Journal, built_in: Mapping[str, str], check: TreeChecker) -> None:
        self._journal = journal
        self._built_in = built_in
        self._check = check

    async def trees(self) -> list[TreeSummary]:
        uploaded = await self._journal.trees()
        names = {**dict.fromkeys(uploaded, False), **dict.fromkeys(self._built_in, True)}
        return [TreeSummary(name=name, built_in=names[name]) for name in sorted(names)]

    async def tree(self, name: str) -> TreeView:
        if name in self._built_in:
            return self._view(name, self._built_in[name], self._check(self._built_in[name]))
        text = (await self._journal.trees()).get(name)
        if text is None:
            raise NotFoundError(f"there is no tree '{name}'")
        return self._view(name, text, self._check(text))

    def check(self, text: str) -> TreeCheck:
        try:
            checked = self._check(text)
        except WrongTreeError as error:
            return TreeCheck(name=None, definition=None, errors=error.mistakes)
        return TreeCheck(name=checked.name, definition=checked.definition, errors=[])

    async def save(self, name: str | None, text: str) -> tuple[TreeView, bool]:
        checked = self._check(text)
        name = name or checked.name
        if name is None:
            raise InvalidError("the tree needs a name: send 'name' with it, or put it in the file")
        self._refuse_built_in(name)
        new = name not in await self._journal.trees()
        await self._journal.save_tree(name, text)
        return self._view(name, text, checked), new

    async def delete(self, name: str) -> None:
        self._refuse_built_in(name)
        if not await self._journal.delete_tree(name):
            raise NotFoundError(f"there is no tree '{name}'")

    def _refuse_built_in(self, name: str) -> None:
        if name in self._built_in:
            raise ConflictError(f"'{name}' is built in and can be neither replaced nor deleted")

    def _view(self, name: str, text: str, checked: CheckedTree) -> TreeView:
        return TreeView(
            name=name,
            built_in=name in self._built_in,
            text=text,
            definition=checked.definition,
        )
