"""What pydantic finds wrong with a part of a document, as problems with lines and sentences."""

import json
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from mend.documents.document import LinedMapping, LinedSequence
from mend.documents.plain_mistakes import what_it_must_be
from mend.documents.problem import Problem, list_names
from mend.documents.unit import model_at, unit_at, unit_of_name
from mend.errors import WrongInputError

_MAX_VALUE_CHARACTERS = 60
_OF_NUMBERS = ("greater_", "less_", "float_", "int_", "finite_")
"""How pydantic's types of mistakes begin that only a number can have."""
_TELLS_ITSELF = (
    "union_tag_not_found",
    "union_tag_invalid",
    "too_short",
    "too_long",
    "string_too_long",
    "string_too_short",
    "value_error",
)
"""What is too long to be taken tells nothing."""

Model = TypeVar("Model", bound=BaseModel)


def validate_part(model: type[Model], part: LinedMapping) -> tuple[Model | None, list[Problem]]:
    """Check a part of a document against a model; None with at least one problem if it is wrong."""
    try:
        # As JSON, because a list may stand for a tuple there even in a strict model.
        return model.model_validate_json(json.dumps(part)), []
    except ValidationError as error:
        found = error.errors(include_url=False)
        return None, [
            Problem(find_line(part, each["loc"]), None, describe_mistake(each, model))
            for each in found
        ]
    except (RecursionError, ValueError):
        return None, [Problem(part.line, None, "values nest too deeply here")]


@contextmanager
def refusing(model: type[BaseModel], what: str | None = None) -> Iterator[None]:
    """Have what a model does not take be a `WrongInputError`, a sentence per mistake; `what`: of
    what they are."""
    try:
        yield
    except ValidationError as error:
        said = [describe_mistake(each, model) for each in error.errors(include_url=False)]
        of = "" if what is None else f"{what}: "
        raise WrongInputError(of + "; ".join(said), said) from error


def describe_mistake(mistake: ErrorDetails, model: type[BaseModel]) -> str:
    """One sentence: which field is wrong and what would be right."""
    where = ".".join(str(each) for each in mistake["loc"] if each != "[key]")
    if mistake["type"] == "missing":
        return f"'{where}' is missing"
    if mistake["type"] == "extra_forbidden":
        known = _known_keys(mistake, model)
        return f"unknown key '{where}'" + (f"; known are {known}" if known else "")
    if mistake["type"] == "value_error":
        message = what_it_must_be(mistake)
        return f"'{where}': {message}" if where else message
    unit = unit_at(model, mistake["loc"]) or unit_of_name(mistake["loc"])
    return f"'{where}' {what_is_right([mistake], unit)}"


def what_is_right(mistakes: Sequence[ErrorDetails], unit: str | None) -> str:
    """What a value must be, in its unit, and what it is; `mistakes`: one for each of its types."""
    first = mistakes[0]
    said, *others = dict.fromkeys(what_it_must_be(each) for each in mistakes)
    for other in others:
        said += f" or {other.removeprefix('must be ')}"
    if unit is not None and first["type"] == "tuple_type":
        said += f" of {unit}"
    elif unit is not None and first["type"].startswith(_OF_NUMBERS):
        said += f" (in {unit})"
    is_told = "input" in first and first["type"] not in _TELLS_ITSELF
    return f"{said}, but it is {_show(first['input'])}" if is_told else said


def find_extra_keys(part: LinedMapping, known: Iterable[str], what: str) -> list[Problem]:
    """A problem for each key of a mapping that `what` does not know."""
    allowed = frozenset(known)
    return [
        Problem(
            part.line_of(key), None, f"unknown key '{key}'; {what} may have {list_names(allowed)}"
        )
        for key in part
        if key not in allowed
    ]


def show_kind(value: Any) -> str:
    """What a value of a document is, for a sentence."""
    if isinstance(value, LinedMapping):
        return "a mapping"
    if isinstance(value, LinedSequence):
        return "a list"
    return "empty" if value is None else _show(value)


def _known_keys(mistake: ErrorDetails, model: type[BaseModel]) -> str:
    """What there may be where a key is unknown; empty where that depends."""
    inner = model_at(model, mistake["loc"][:-1])
    return "" if inner is None else list_names(inner.model_fields)


def _show(value: Any) -> str:
    if isinstance(value, str | bytes):
        value = value[: _MAX_VALUE_CHARACTERS + 1]
    try:
        shown = json.dumps(value, default=str)
    except (RecursionError, ValueError):
        # Also what has itself as a part, as an alias can make it.
        return "nested too deeply to be shown"
    if len(shown) > _MAX_VALUE_CHARACTERS:
        return shown[:_MAX_VALUE_CHARACTERS] + "..."
    return shown


def find_line(part: LinedMapping, location: Sequence[int | str]) -> int:
    """The line of the innermost value on the way to a location."""
    line, value = part.line, part
    for step in location:
        if isinstance(value, LinedMapping) and isinstance(step, str) and step in value:
            line, value = value.line_of(step), value[step]
        elif isinstance(value, LinedSequence) and isinstance(step, int) and step < len(value):
            line, value = value.item_lines[step], value[step]
        else:
            break
    return line
