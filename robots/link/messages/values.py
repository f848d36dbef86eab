"""What messages are made of: names, numbers and JSON."""

import json
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from mend.documents.spellings import SEEN_CHARACTERS_OR_NONE
from mend.robots.link.shown_name import SHOWN

Identifier = Annotated[
    str,
    Field(min_length=1, max_length=128, pattern=SEEN_CHARACTERS_OR_NONE),
    SHOWN,
]
"""It is written to logs and terminals as it is."""

Word = Annotated[str, Field(max_length=128)]
"""A name or an id."""

Sentence = Annotated[str, Field(max_length=4000)]
"""What people are told."""

MOST = 10_000
"""So many objects, results or names are the most that one message tells of."""

MOST_GUESSES = 3
"""About so many places people are asked at most by a robot that is lost."""

MOST_MEASURED = 16
"""About so many figures one detection tells at most."""

Measure = Annotated[float, Field(ge=-1e12, le=1e12)]
"""A figure in the unit that its name tells."""

Time = Annotated[float, Field(ge=-1e12, le=1e12)]
"""Seconds of the robot's clock; any zero, that of the calendar as well."""

Span = Annotated[float, Field(ge=0, le=1e9)]
"""How long something lasts, in seconds."""

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
"""Metres, radians, or what has no unit."""

Pixels = Annotated[float, Field(ge=-1e9, le=1e9)]

Count = Annotated[int, Field(ge=0, le=2**31 - 1)]

Seq = Annotated[int, Field(le=2**53 - 1)]
"""The number of a report: any reader of JSON can tell it from the next one."""


def _require_json(value: dict[str, Any]) -> dict[str, Any]:
    """Refuse NaN and infinities, which `Any` lets through and JSON does not have."""
    json.dumps(value, allow_nan=False)
    return value


JsonObject = Annotated[dict[str, Any], AfterValidator(_require_json)]


class Message(BaseModel):
    """A wire message: unknown fields are ignored, so that a newer peer may add some."""

    model_config = ConfigDict(extra="ignore", strict=True, frozen=True, allow_inf_nan=False)
