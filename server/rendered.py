"""Views as the JSON that clients get: made where it holds nobody up, and passed on as it is."""

from dataclasses import dataclass
from typing import Generic, Self, TypeVar

from pydantic import BaseModel

V = TypeVar("V", bound=BaseModel)


@dataclass(frozen=True, slots=True)
class Rendered(Generic[V]):
    """A view in JSON."""

    shape: type[V]
    json: bytes

    @classmethod
    def of(cls, view: V) -> Self:
        """The JSON of a view."""
        return cls(type(view), view.model_dump_json().encode())

    def view(self) -> V:
        """The view itself."""
        return self.shape.model_validate_json(self.json)
