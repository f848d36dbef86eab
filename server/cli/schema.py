"""`mend schema`: the schemas of files, events and interfaces."""

import json
from collections.abc import Callable, Mapping
from enum import StrEnum
from typing import Annotated, Any

import typer

from mend.server.cli.failures import told_plainly


class SchemaName(StrEnum):
    """The schemas that there are."""

    OPENAPI = "openapi"
    ASYNCAPI = "asyncapi"
    CONSOLE = "console"
    EVENTS = "events"
    TASK = "task"
    SCENE = "scene"
    SCENARIO = "scenario"
    DELIVERY = "delivery"


def schema(
    name: Annotated[
        SchemaName,
        typer.Argument(
            metavar="[openapi|asyncapi|console|events|task|scene|scenario|delivery]",
            help="openapi: REST; asyncapi: WebSockets; console: both, as the console uses them; "
            "events: the journal; task, scene, scenario, delivery: files.",
        ),
    ] = SchemaName.OPENAPI,
) -> None:
    """Print a schema as JSON: OpenAPI, AsyncAPI, or a JSON Schema."""
    with told_plainly():
        described = SCHEMAS[name]()
    typer.echo(json.dumps(described, indent=2))


# What is described is imported only here: its own help would wait for the whole API.


def _openapi() -> dict[str, Any]:
    from mend.server.schemas import openapi

    return openapi()


def _asyncapi() -> dict[str, Any]:
    from mend.server.schemas import asyncapi

    return asyncapi()


def _console() -> dict[str, Any]:
    from mend.server.console_schema import console

    return console()


def _events() -> dict[str, Any]:
    from mend.server.schemas import json_schemas

    return json_schemas()["event"]


def _task() -> dict[str, Any]:
    from mend.server.behaviors import behavior_parameters
    from mend.tasks.json_schema import task_schema

    return task_schema(behavior_parameters())


def _scene() -> dict[str, Any]:
    from mend.tasks.json_schema import scene_schema

    return scene_schema()


def _scenario() -> dict[str, Any]:
    from mend.tasks.json_schema import scenario_schema

    return scenario_schema()


def _delivery() -> dict[str, Any]:
    from mend.fleet.scheduling.problem_file import delivery_schema

    return delivery_schema()


SCHEMAS: Mapping[SchemaName, Callable[[], dict[str, Any]]] = {
    SchemaName.OPENAPI: _openapi,
    SchemaName.ASYNCAPI: _asyncapi,
    SchemaName.CONSOLE: _console,
    SchemaName.EVENTS: _events,
    SchemaName.TASK: _task,
    SchemaName.SCENE: _scene,
    SchemaName.SCENARIO: _scenario,
    SchemaName.DELIVERY: _delivery,
}
