"""The documents that runs name: task trees, scenes and scenarios, built-in or uploaded."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Literal, Protocol

from mend.errors import WrongInputError
from mend.server.journal.events import Author
from mend.server.rendered import Rendered
from mend.server.runtime.views import View


class DocumentKind(StrEnum):
    """The kinds of document; the journal keeps uploaded ones by these names."""

    TREE = "tree"
    SCENE = "scene"
    SCENARIO = "scenario"


SPOKEN = {
    DocumentKind.TREE: "task tree",
    DocumentKind.SCENE: "scene",
    DocumentKind.SCENARIO: "scenario",
}
"""What a kind is called in a sentence."""


class DocumentSummary(View):
    """One line about a document. `built_in` ones cannot be replaced or deleted.

    They come with Mend, or are in the folder of scenes that the service was started with.
    """

    name: str
    built_in: bool


class SceneSummary(DocumentSummary):
    """One line about a scene; the numbers are None where its file has mistakes by now."""

    objects: int | None
    places: int | None


class ScenarioSummary(DocumentSummary):
    """One line about a scenario; `tree` is None where its file has mistakes by now."""

    tree: str | None
    description: str
    answers: list[Literal["yes", "no", "silence"]]


class DocumentView(DocumentSummary):
    """A document: its file's `text`, and the `definition` in its JSON form."""

    text: str
    definition: dict[str, Any]


class DocumentMistake(View):
    """One mistake of a document: where it is, from 1, and one sentence.

    `column` is where the line's content begins, or exactly where a text stops being readable;
    `node` the path of a task tree's node.
    """

    line: int | None
    column: int | None
    node: str | None
    message: str


class RobotReach(View):
    """How far a robot of a scene reaches: between two distances in metres from a point of the
    scene's plane. `robot` is what the scene calls it.
    """

    robot: str
    x: float
    y: float
    min_m: float
    max_m: float


class WorldFit(View):
    """What keeps the robot of one world from doing what a document says; nothing if it can.

    `reach` is told of a scene, where the world knows it.
    """

    world: str
    problems: list[DocumentMistake]
    reach: list[RobotReach] = []


class KeptDocument(DocumentView):
    """A document that was just kept, and how the worlds that check scenes can do it."""

    worlds: list[WorldFit]


class DocumentCheck(View):
    """What a document is worth: its `definition` in JSON form, or what is wrong with it.

    `worlds` are those that were asked; where none of them can do it, their problems are the errors.
    """

    name: str | None
    definition: dict[str, Any] | None
    errors: list[DocumentMistake]
    worlds: list[WorldFit]


MOST_MISTAKES = 1000
"""So many mistakes of one document are told."""


class WrongDocumentError(WrongInputError):
    """A document has mistakes; after the first 1000 only how many more there are is told.

    `worlds`: how they can do it, where they were asked.
    """

    def __init__(
        self,
        what: str,
        mistakes: Sequence[DocumentMistake],
        worlds: Sequence[WorldFit] = (),
    ) -> None:
        count = "a mistake" if len(mistakes) == 1 else f"{len(mistakes)} mistakes"
        told = list(mistakes[:MOST_MISTAKES])
        if len(mistakes) > MOST_MISTAKES:
            more = f"there are {len(mistakes) - MOST_MISTAKES} more mistakes"
            told.append(DocumentMistake(line=None, column=None, node=None, message=more))
        super().__init__(f"the {what} file has {count}", [_sentence(each) for each in told])
        self.mistakes = told
        self.worlds = worlds

    def __reduce__(self) -> tuple[Any, ...]:
        # It goes from one process to another; it is made of other things than it says.
        return _as_it_was, (type(self), self.args, vars(self))


def _as_it_was(
    kind: type[WrongDocumentError], args: tuple[Any, ...], fields: dict[str, Any]
) -> WrongDocumentError:
    error = kind.__new__(kind)
    error.args = args
    vars(error).update(fields)
    return error


def _sentence(mistake: DocumentMistake) -> str:
    where = "" if mistake.line is None else f"line:{mistake.line}: "
    return where + (f"{mistake.node}: " if mistake.node else "") + mistake.message


Uploaded = Mapping[DocumentKind, Mapping[str, str]]
"""The texts of uploaded documents by kind and name."""


@dataclass(frozen=True, slots=True)
class CheckedDocument:
    """A document without mistakes; `name` None where the file has none.

    `uses` are the documents without which this one means nothing.
    """

    name: str | None
    definition: dict[str, Any]
    uses: frozenset[tuple[DocumentKind, str]] = frozenset()
    worlds: Sequence[WorldFit] = ()


@dataclass(frozen=True, slots=True)
class Kept:
    """A document that was kept; `new`: its name was not there before."""

    name: str
    new: bool
    view: Rendered[KeptDocument]


class DocumentChecker(Protocol):
    """Reads documents of one kind."""

    def check(self, text: str, uploaded: Uploaded) -> CheckedDocument:
        """Raises `WrongDocumentError` with every mistake."""
        ...

    def try_in_worlds(self, text: str, uploaded: Uploaded) -> CheckedDocument:
        """As `check`, and asks every world whether its robot can do it.

        Raises `WrongDocumentError` also where no world's robot can.
        """
        ...


class FixedDocuments(Protocol):
    """Documents of one kind that cannot be changed."""

    def names(self) -> Sequence[str]: ...

    def read(self, name: str) -> str:
        """The text of one of the names."""
        ...


class DocumentLibrary(Protocol):
    """Where the API finds, keeps and deletes the documents of one kind."""

    async def summaries(self, offset: int = 0, limit: int = 1000) -> Sequence[DocumentSummary]: ...

    async def get(self, name: str) -> Rendered[DocumentView]:
        """Raises `NotFoundError`, and `WrongInputError` where it has mistakes by now."""
        ...

    async def kept(self, name: str) -> Rendered[KeptDocument]:
        """What `save` tells of a document that is kept. Raises what `get` does."""
        ...

    async def check(self, text: str, name: str | None = None) -> Rendered[DocumentCheck]:
        """Check a document without keeping it; `name` wins over the file's own."""
        ...

    async def save(self, name: str | None, text: str, author: Author | None = None) -> Kept:
        """Check and keep a document.

        `name` wins over the file's own. Raises `WrongInputError`, and `ConflictError` (built in, or
        another uploaded document would no longer fit).
        """
        ...

    async def delete(self, name: str, author: Author | None = None) -> None:
        """Raises `NotFoundError`, `ConflictError` (built in, or used by an uploaded one)."""
        ...
