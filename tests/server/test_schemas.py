"""Every description is whole: all that it refers to is in it, and it fits what is sent."""

from collections.abc import Iterator
from typing import Any

import jsonschema_rs
import pytest
from sample_events import paused, started

from mend.server.schemas import SCHEMAS, asyncapi, json_schemas, openapi


def references(node: Any) -> Iterator[str]:
    if isinstance(node, dict):
        if isinstance(node.get("$ref"), str):
            yield node["$ref"]
        for value in node.values():
            yield from references(value)
    elif isinstance(node, list):
        for value in node:
            yield from references(value)


def resolve(document: Any, reference: str) -> Any:
    for part in reference.removeprefix("#/").split("/"):
        document = document[part]
    return document


@pytest.mark.parametrize("describe", [openapi, asyncapi], ids=["openapi", "asyncapi"])
def test_every_reference_leads_somewhere(describe: Any) -> None:
    document = describe()
    found = set(references(document))
    assert len(found) > 20
    for reference in found:
        assert resolve(document, reference) is not None


@pytest.fixture(scope="module")
def schemas() -> dict[str, dict[str, Any]]:
    return json_schemas()


def test_everything_that_goes_over_a_wire_has_a_schema(schemas: dict[str, dict[str, Any]]) -> None:
    assert schemas.keys() == SCHEMAS.keys()


@pytest.mark.parametrize("name", SCHEMAS)
def test_json_schema_is_valid_and_whole(schemas: dict[str, dict[str, Any]], name: str) -> None:
    schema = schemas[name]
    jsonschema_rs.meta.validate(schema)
    for reference in references(schema):
        assert resolve(schema, reference) is not None


def test_event_schema_accepts_events_and_nothing_else(schemas: dict[str, dict[str, Any]]) -> None:
    validator = jsonschema_rs.Draft202012Validator(schemas["event"])
    for event in (started(), paused()):
        validator.validate(event.model_dump(mode="json"))
    assert not validator.is_valid({**paused().model_dump(mode="json"), "type": "unheard_of"})
    assert not validator.is_valid({**paused().model_dump(mode="json"), "more": 1})


def test_asyncapi_names_every_message_by_its_type() -> None:
    document = asyncapi()
    names = {key: message["name"] for key, message in document["components"]["messages"].items()}
    assert names["helper.SnapshotMessage"] == "snapshot"
    assert names["helper.Answer"] == "answer"
    assert names["helper.StepStarted"] == "step_started"
    assert names["live.Layout"] == "layout"
    assert names["live.Frame"] == "frame"
    assert names["speech.HeardMessage"] == "heard"
    assert names["speech.Listen"] == "listen"
    assert names["robot.Hello"] == "hello"
    assert set(document["channels"]) == {"helper", "live", "robot", "speech"}
    for operation in document["operations"].values():
        channel = resolve(document, operation["channel"]["$ref"])
        for message in operation["messages"]:
            assert message["$ref"].rsplit("/", 1)[1] in channel["messages"]
