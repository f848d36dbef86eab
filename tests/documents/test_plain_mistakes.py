import re
from collections.abc import Iterator
from enum import StrEnum
from typing import Annotated, Any, Literal

import pytest
from pydantic import BaseModel, Field, ValidationError

from mend.documents.plain_mistakes import what_it_must_be
from mend.documents.spellings import SPELLINGS
from mend.robots.link.messages import robot_message
from mend.server.access.principals_file import Principals
from mend.server.app import described_app


class Drink(StrEnum):
    TEA = "tea"
    COFFEE = "coffee"


class Everything(BaseModel):
    name: str = Field(default="a", min_length=1, max_length=3, pattern="^a+$")
    many: list[int] = Field(default=[1], min_length=1, max_length=2)
    number: float = Field(default=1.0, ge=0.0)
    yes: bool = True


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"name": ""}, "must not be empty"),
        ({"name": "aaaa"}, "must have at most 3 characters"),
        ({"name": "b"}, "must have another form"),
        ({"name": 7}, "must be text"),
        ({"many": []}, "must have at least 1 entry, but it has 0"),
        ({"many": [1, 2, 3]}, "must have at most 2 entries, but it has 3"),
        ({"many": ["x"]}, "must be a whole number"),
        ({"many": {}}, "must be a list"),
        ({"number": -1.0}, "must be greater than or equal to 0"),
        ({"number": "x"}, "must be a number"),
        ({"yes": "perhaps"}, "must be true or false"),
        ("everything", "must be a mapping"),
    ],
)
def test_what_would_be_right_is_said_plainly(given: object, words: str) -> None:
    with pytest.raises(ValidationError) as error:
        Everything.model_validate(given)
    assert what_it_must_be(error.value.errors()[0]) == words


def patterns_in(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        if isinstance(schema.get("pattern"), str):
            yield schema["pattern"]
        for each in schema.values():
            yield from patterns_in(each)
    elif isinstance(schema, list):
        for each in schema:
            yield from patterns_in(each)


def test_every_pattern_that_people_and_robots_are_held_to_has_words() -> None:
    schemas = [
        described_app().openapi(),
        robot_message.json_schema(),
        Principals.model_json_schema(),
    ]
    found = {pattern for schema in schemas for pattern in patterns_in(schema)}
    assert found
    assert found <= set(SPELLINGS)


def test_no_words_show_a_pattern() -> None:
    assert not any(re.search(r"[\\^$\[\]]", words) for words in SPELLINGS.values())


class Tea(BaseModel):
    kind: Literal[Drink.TEA]


class Coffee(BaseModel):
    kind: Literal[Drink.COFFEE]


class Order(BaseModel):
    drink: Annotated[Tea | Coffee, Field(discriminator="kind")]


def test_what_kinds_there_are_is_said_as_it_is_written() -> None:
    with pytest.raises(ValidationError) as error:
        Order.model_validate({"drink": {"kind": "milk"}})
    told = what_it_must_be(error.value.errors()[0])
    assert told == "has 'milk' as 'kind', not one of 'tea', 'coffee'"
