"""`mend schema`: the schemas of files, events and interfaces."""

import json
from collections.abc import Callable, Mapping
from enum import StrEnum
from typing import Annotated, Any

import typer

from server.journal.events import any_event
from tasks.scenario import Scenario
from tasks.scene import Scene


class SchemaName(StrEnum):
    """The schemas that there are."""

    OPENAPI = "openapi"
    ASYNCAPI = "asyncapi"
    EVENTS = "events"
    TASK = "task"
    SCENE = "scene"
    SCENARIO = "scenario"


def schema(
    name: Annotated[
        SchemaName,
        typer.Argument(
            help="openapi: REST; asyncapi: WebSockets; events: the journal; "
            "task, scene, scenario: files."
        ),
    ] = SchemaName.OPENAPI,
) -> None:
    """Print a schema as JSON: OpenAPI, AsyncAPI, or a JSON Schema."""
    typer.echo(json.dumps(SCHEMAS[name](), indent=2))


def _openapi() -> dict[str, Any]:
    from server.api.documents import openapi_document

    return openapi_document()


SCHEMAS: Mapping[SchemaName, Callable[[], dict[str, Any]]] = {
    SchemaName.EVENTS: any_event.json_schema,
    SchemaName.SCENE: Scene.model_json_schema,
    SchemaName.SCENARIO: Scenario.model_json_schema,
}
