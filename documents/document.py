"""A YAML or JSON document with the line of every value, read safely and within limits.

Plain values are read as YAML 1.2 does (`yes` is text, `true` is not); JSON is a part of that.
"""

import re
from pathlib import Path
from typing import Any

import yaml

from mend.documents.parser_mistakes import TAB, UNKNOWN, parser_mistake
from mend.documents.problem import Problem
from mend.errors import WrongInputError

MAX_BYTES = 32 * 1024 * 1024
MAX_DEPTH = 4_000
"""How deep mappings and lists may nest. The time to read them grows with the square of it."""
MAX_VALUES = 4_000_000
"""How many values a document may have, those repeated by aliases counted again."""

_NULL = re.compile(r"null|Null|NULL|~|")
_INTEGER = re.compile(r"[-+]?[0-9]{1,18}")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_BOOLEANS = {
    "true": True,
    "True": True,
    "TRUE": True,
    "false": False,
    "False": False,
    "FALSE": False,
}
_SURROGATES = re.compile(r"(\\\\)|\\u([dD][89abAB][0-9a-fA-F]{2})\\u([dD][c-fC-F][0-9a-fA-F]{2})")

_NOT_VALID = "the text is not valid YAML or JSON"

_LOADER: type[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class DocumentError(WrongInputError):
    """A text cannot be read at all; raised by `read_document` and `read_text`."""

    def __init__(self, line: int | None, message: str, column: int | None = None) -> None:
        super().__init__(message)
        self.problem = Problem(line, None, message, column)


class LinedMapping(dict[str, Any]):
    """A mapping that knows its line and those of its keys."""

    __slots__ = ("key_lines", "line", "size")

    def __init__(self, line: int) -> None:
        super().__init__()
        self.line = line
        self.key_lines: dict[str, int] = {}
        self.size = 1

    def line_of(self, key: str) -> int:
        """The line of a key, or of the mapping where it does not have it."""
        return self.key_lines.get(key, self.line)


class LinedSequence(list[Any]):
    """A list that knows its line and those of its items."""

    __slots__ = ("item_lines", "line", "size")

    def __init__(self, line: int) -> None:
        super().__init__()
        self.line = line
        self.item_lines: list[int] = []
        self.size = 1


def read_text(path: Path) -> str:
    """The text of a file. Raises `DocumentError` if it cannot be read, is too big or no UTF-8."""
    try:
        if path.stat().st_size > MAX_BYTES:
            raise DocumentError(None, f"the file is larger than {MAX_BYTES // 1024**2} MiB")
        return path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise DocumentError(None, f"the file cannot be read: {reason}") from error
    except UnicodeDecodeError as error:
        raise DocumentError(None, f"the file is not UTF-8 text (byte {error.start})") from error


def read_document(text: str) -> tuple[Any, list[Problem]]:
    """The document's value and the keys that it gives twice (the first one counts).

    Mappings and lists are `LinedMapping` and `LinedSequence`. Raises `DocumentError` if the text
    is not YAML or JSON or goes beyond a limit.
    """
    if len(text) > MAX_BYTES:
        raise DocumentError(None, f"the text is larger than {MAX_BYTES // 1024**2} MiB")
    if text.lstrip().startswith("{"):
        text = _join_surrogates(text)
    builder = _Builder()
    try:
        for event in yaml.parse(text, Loader=_LOADER):
            builder.take(event)
    except yaml.YAMLError as error:
        raise _translate(error, text) from error
    return builder.root, builder.problems


class _Builder:
    """Builds a document from the parser's events, without recursion."""

    def __init__(self) -> None:
        self.root: Any = None
        self.problems: list[Problem] = []
        self._open: list[LinedMapping | LinedSequence] = []
        self._keys: list[str | None] = []
        self._anchors: dict[str, Any] = {}
        self._starts: list[int] = []
        self._values = 0
        self._documents = 0

    def take(self, event: Any) -> None:
        kind = type(event)
        if kind is yaml.ScalarEvent:
            self._take_scalar(event)
        elif kind is yaml.MappingStartEvent or kind is yaml.SequenceStartEvent:
            self._begin(event)
        elif kind is yaml.MappingEndEvent or kind is yaml.SequenceEndEvent:
            self._end()
        elif kind is yaml.AliasEvent:
            self._repeat(event)
        elif kind is yaml.DocumentStartEvent:
            self._documents += 1
            if self._documents > 1:
                raise DocumentError(_line(event), "there is more than one document in the text")

    def _take_scalar(self, event: Any) -> None:
        line = event.start_mark.line + 1
        if event.tag is not None:
            raise DocumentError(line, f"the tag '{event.tag}' is not allowed")
        if self._open and self._keys[-1] is None and type(self._open[-1]) is LinedMapping:
            self._take_key(self._open[-1], event.value, line)
            return
        value = event.value if event.style else _resolve(event.value)
        self._remember(event, value)
        self._add(value, line, 1)

    def _take_key(self, mapping: LinedMapping, key: str, line: int) -> None:
        if key == "<<":
            raise DocumentError(line, "'<<' merges nothing here: write out the keys it stands for")
        if key in mapping:
            first = mapping.key_lines[key]
            message = f"the key '{key}' is given twice, first in line {first}"
            self.problems.append(Problem(line, None, message))
        else:
            mapping.key_lines[key] = line
        self._keys[-1] = key

    def _begin(self, event: Any) -> None:
        line = _line(event)
        if event.tag is not None:
            raise DocumentError(line, f"the tag '{event.tag}' is not allowed")
        if len(self._open) >= MAX_DEPTH:
            raise DocumentError(line, f"values nest deeper than {MAX_DEPTH} levels")
        is_mapping = type(event) is yaml.MappingStartEvent
        value = LinedMapping(line) if is_mapping else LinedSequence(line)
        self._add(value, line, 1)
        self._remember(event, value)
        self._open.append(value)
        self._keys.append(None)
        self._starts.append(self._values)

    def _end(self) -> None:
        closed = self._open.pop()
        self._keys.pop()
        closed.size += self._values - self._starts.pop()

    def _repeat(self, event: Any) -> None:
        line = _line(event)
        if event.anchor not in self._anchors:
            raise DocumentError(line, f"the alias '*{event.anchor}' names no anchor")
        value = self._anchors[event.anchor]
        if any(value is each for each in self._open):
            raise DocumentError(line, f"the alias '*{event.anchor}' stands inside what it repeats")
        size = value.size if isinstance(value, LinedMapping | LinedSequence) else 1
        self._add(value, line, size)

    def _remember(self, event: Any, value: Any) -> None:
        if event.anchor is not None:
            self._anchors[event.anchor] = value

    def _add(self, value: Any, line: int, size: int) -> None:
        self._values += size
        if self._values > MAX_VALUES:
            raise DocumentError(line, f"there are more than {MAX_VALUES} values")
        if not self._open:
            self.root = value
            return
        parent = self._open[-1]
        if isinstance(parent, LinedSequence):
            parent.append(value)
            parent.item_lines.append(line)
            return
        key = self._keys[-1]
        if key is None:
            raise DocumentError(line, "a key must be text")
        parent.setdefault(key, value)
        self._keys[-1] = None


def _resolve(text: str) -> Any:
    """The value of a plain scalar."""
    if text in _BOOLEANS:
        return _BOOLEANS[text]
    if text[:1].isalpha() and text[:1] not in "nN":
        return text
    if _INTEGER.fullmatch(text):
        return int(text)
    if _FLOAT.fullmatch(text):
        return float(text)
    return None if _NULL.fullmatch(text) else text


def _join_surrogates(text: str) -> str:
    """JSON writes a character beyond 16 bits as two escapes, which YAML does not know."""

    def join(match: re.Match[str]) -> str:
        if match[1]:
            return match[1]
        return chr(0x10000 + ((int(match[2], 16) - 0xD800) << 10) + int(match[3], 16) - 0xDC00)

    return _SURROGATES.sub(join, text)


def _line(event: Any) -> int:
    return int(event.start_mark.line) + 1


def _translate(error: yaml.YAMLError, text: str) -> DocumentError:
    if isinstance(error, yaml.reader.ReaderError):
        before = text.encode("utf-8", "surrogatepass")[: error.position].decode("utf-8", "ignore")
        line, column = before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1
        return DocumentError(line, f"{_NOT_VALID}: {parser_mistake(error.reason)}", column)
    if not isinstance(error, yaml.MarkedYAMLError) or error.problem_mark is None:
        return DocumentError(None, f"{_NOT_VALID}: {UNKNOWN}")
    mark, begun = error.problem_mark, error.context_mark
    lines = text.split("\n")
    if mark.line < len(lines) and lines[mark.line][mark.column :][:1] == "\t":
        return DocumentError(mark.line + 1, TAB, mark.column + 1)
    earlier = begun.line + 1 if begun is not None and begun.line < mark.line else None
    told = parser_mistake(error.problem or "", error.context or "", earlier)
    return DocumentError(mark.line + 1, f"{_NOT_VALID}: {told}", mark.column + 1)
