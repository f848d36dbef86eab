"""XML from outside, read without anything that could name what is elsewhere or grow."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol
from xml.parsers import expat

from mend.errors import WrongInputError

MOST_LEVELS = 200
"""Elements in one another; far more than any model has, and less than hurts who reads it."""


class ElementReader(Protocol):
    """Hears of each element of a document, in its order."""

    def begin(self, name: str, attributes: Mapping[str, str]) -> None: ...

    def text(self, text: str) -> None: ...

    def end(self, name: str) -> None: ...


@dataclass(slots=True)
class _Levels:
    reader: ElementReader
    file: str
    level: int = 0

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        self.level += 1
        if self.level > MOST_LEVELS:
            raise WrongInputError(
                f"{self.file}: its elements are in one another {MOST_LEVELS} levels deep and more"
            )
        self.reader.begin(name, attributes)

    def end(self, name: str) -> None:
        self.level -= 1
        self.reader.end(name)


def read_elements(content: bytes, file: str, reader: ElementReader) -> None:
    """Tell a reader of the elements of a file. Raises `WrongInputError`.

    A document type is refused, and with it every entity that is not XML's own: those expand
    without bounds, or stand for what is elsewhere.
    """
    parser = expat.ParserCreate("utf-8")
    levels = _Levels(reader, file)
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = _refuse_doctype(file)
    parser.StartElementHandler = levels.begin
    parser.EndElementHandler = levels.end
    parser.CharacterDataHandler = reader.text
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        raise WrongInputError(
            f"{file}, line {error.lineno}: it is not XML ({expat.ErrorString(error.code)})"
        ) from None


def _refuse_doctype(file: str) -> Callable[..., None]:
    def refuse(*_declared: object) -> None:
        raise WrongInputError(f"{file}: it has a document type (<!DOCTYPE>): leave that out")

    return refuse
