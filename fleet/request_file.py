"""Request files: what people of a building want, and what happens there meanwhile."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from pydantic import Field

from mend.documents.document import DocumentError, LinedMapping, read_document, read_text
from mend.documents.kinds_of_files import not_the_kind
from mend.documents.problem import InvalidFileError, Problem
from mend.documents.spellings import SEEN_CHARACTERS
from mend.documents.strict_model import StrictModel
from mend.documents.validation import find_line, show_kind, validate_part
from mend.fleet.happenings import Cancelled, Happening
from mend.fleet.requests import Moment, PlaceName, Request, RequestName

MOST_REQUESTS = 1000

Place = tuple[str | int, ...]
"""Where something is in a request file: the keys and numbers on the way to it."""

HelperName = Annotated[str, Field(min_length=1, max_length=64, pattern=SEEN_CHARACTERS)]


class RequestFileError(InvalidFileError):
    """A request file has mistakes."""


class RequestsDocument(StrictModel):
    """What a request file says.

    `asked_s`: when a request is made, by its name; at once if it is not among them. `helpers`: whom
    robots ask, in this order; `transfer_places`: where things may change robots.
    """

    requests: Annotated[tuple[Request, ...], Field(min_length=1, max_length=MOST_REQUESTS)]
    asked_s: dict[RequestName, Moment] = {}
    happenings: Annotated[tuple[Happening, ...], Field(max_length=MOST_REQUESTS)] = ()
    helpers: Annotated[tuple[HelperName, ...], Field(max_length=20)] = ()
    transfer_places: Annotated[tuple[PlaceName, ...], Field(max_length=100)] = ()


@dataclass(frozen=True, slots=True)
class ReadRequests:
    """A request file with its lines, and what it is called in sentences."""

    document: RequestsDocument
    lines: LinedMapping
    source: str

    def refuse(self, mistakes: Iterable[tuple[Place, str]]) -> None:
        """Raises `RequestFileError` where there are any, each with its line."""
        problems = [Problem(find_line(self.lines, at), None, told) for at, told in mistakes]
        if problems:
            raise RequestFileError(self.source, problems)


def read_request_file(path: Path) -> RequestsDocument:
    """Read and check a request file (YAML or JSON). Raises `RequestFileError`."""
    return read_requests(path).document


def read_request_text(text: str, *, source: str = "requests") -> RequestsDocument:
    """Check the text of a request file; `source` names it. Raises `RequestFileError`."""
    return _read(text, source).document


def read_requests(path: Path) -> ReadRequests:
    """Read and check a request file, and keep its lines. Raises `RequestFileError`."""
    try:
        text = read_text(path)
    except DocumentError as error:
        raise RequestFileError(str(path), [error.problem]) from error
    return _read(text, str(path))


def _read(text: str, source: str) -> ReadRequests:
    try:
        content, problems = read_document(text)
    except DocumentError as error:
        raise RequestFileError(source, [error.problem]) from error
    if not isinstance(content, LinedMapping):
        message = f"a request file is a mapping with 'requests', but this is {show_kind(content)}"
        raise RequestFileError(source, [*problems, Problem(1, None, message)])
    if other := not_the_kind(content, "a request file"):
        raise RequestFileError(source, [other])
    document, wrong = validate_part(RequestsDocument, content)
    problems += wrong
    if document is not None:
        problems += _names_given_twice(content, document)
        problems += _unknown_names(content, document)
    if document is None or problems:
        raise RequestFileError(source, problems)
    return ReadRequests(document, content, source)


def _names_given_twice(content: LinedMapping, document: RequestsDocument) -> list[Problem]:
    """Requests, and helpers, that could not be told apart."""
    names = [each.name for each in document.requests]
    twice: list[tuple[Place, str]] = [
        (("requests", number, "name"), f"two requests are called '{name}': give each its own name")
        for number, name in enumerate(names)
        if name in names[:number]
    ]
    twice += [
        (("helpers", number), f"the helper '{name}' is named twice: name each once")
        for number, name in enumerate(document.helpers)
        if name in document.helpers[:number]
    ]
    return [Problem(find_line(content, at), None, told) for at, told in twice]


def _unknown_names(content: LinedMapping, document: RequestsDocument) -> list[Problem]:
    """Requests that are named where something is said of them, but are not there."""
    # One that recurs is called after its first, `NAME/1` and so on.
    known = {each.name for each in document.requests}
    named: list[tuple[str, Place]]
    named = [(name, ("asked_s", name)) for name in document.asked_s]
    named += [
        (each.request, ("happenings", number, "request"))
        for number, each in enumerate(document.happenings)
        if isinstance(each, Cancelled)
    ]
    return [
        Problem(find_line(content, where), None, f"no request here is called '{name}'")
        for name, where in named
        if name.split("/", 1)[0] not in known
    ]
