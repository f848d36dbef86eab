"""Units: what a number of a model is in, and which one a place in a document asks for."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel

_BY_ENDING = {
    "m_s": "metres per second",
    "rad_s": "radians per second",
    "s": "seconds",
    "m": "metres",
    "rad": "radians",
    "n": "newtons",
    "kg": "kilograms",
}
"""The longer ending first."""


@dataclass(frozen=True, slots=True)
class Unit:
    """Stands in the type of a number: `name` says what it is in, as in `metres`.

    In that of a list of so many numbers it says what they are.
    """

    name: str


def unit_at(model: type[BaseModel], location: Sequence[int | str]) -> str | None:
    """What the number at a location of a model's document is in; None if that is not said."""
    found = _at(model, location)
    return next((each.name for each in found if isinstance(each, Unit)), None)


def model_at(model: type[BaseModel], location: Sequence[int | str]) -> type[BaseModel] | None:
    """The model of a part of a model's document; None if there is none, or several may be meant."""
    models = [
        each
        for each in _at(model, location)
        if isinstance(each, type) and issubclass(each, BaseModel)
    ]
    return models[0] if len(models) == 1 else None


def unit_of_name(location: Sequence[int | str]) -> str | None:
    """What the number at a location is in, by the end of its name, as in `timeout_s`."""
    name = next((each for each in reversed(location) if isinstance(each, str)), "")
    return next((unit for end, unit in _BY_ENDING.items() if name.endswith(f"_{end}")), None)


def _at(model: type[BaseModel], location: Sequence[int | str]) -> list[Any]:
    found: list[Any] = [model]
    for step in location:
        found = [inner for each in found for inner in _inside(each, step)]
    return found


def _inside(kind: Any, step: int | str) -> Iterator[Any]:
    """What may stand at a key or an index of a kind of value, and what its type says of it."""
    origin, inner = get_origin(kind), get_args(kind)
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        if step in kind.model_fields:
            field = kind.model_fields[str(step)]
            yield from field.metadata
            yield from _said_of(field.annotation)
    elif origin is dict:
        yield from _said_of(inner[1])
    elif origin is list:
        yield from _said_of(inner[0])
    elif origin is tuple and isinstance(step, int) and step < len(inner):
        yield from _said_of(inner[step])


def _said_of(kind: Any) -> Iterator[Any]:
    """The alternatives of a type, and everything that stands beside them in it."""
    if get_origin(kind) is Annotated:
        plain, *beside = get_args(kind)
        yield from beside
        yield from _said_of(plain)
    elif get_origin(kind) in (Union, UnionType):
        for each in get_args(kind):
            yield from _said_of(each)
    else:
        yield kind
