"""The wire, described for machines: OpenAPI, AsyncAPI and JSON Schema, as dicts."""

from importlib.metadata import version
from typing import Any, get_args

from pydantic import BaseModel, TypeAdapter
from pydantic.json_schema import models_json_schema

from mend.robots.link import messages as link
from mend.server.api import helper_messages, speech_messages
from mend.server.api.problem import Problem
from mend.server.app import described_app
from mend.server.documents import DocumentCheck
from mend.server.journal.events import AnyEvent
from mend.server.poses.layout import Layout
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView, RobotView, RunView, WorldView
from mend.tasks.intervention import Intervention
from mend.tasks.scenario import Scenario
from mend.tasks.scene import Scene

Models = tuple[type[BaseModel], ...]

DIALECT = "https://json-schema.org/draft/2020-12/schema"

SCHEMAS: dict[str, Any] = {
    "event": AnyEvent,
    "helper_message": helper_messages.ClientMessage,
    "speech_client_message": speech_messages.SpeechClientMessage,
    "speech_server_message": speech_messages.SpeechServerMessage,
    "robot_message": link.RobotMessage,
    "service_message": link.ServiceMessage,
    "run_request": RunRequest,
    "run": RunView,
    "dialogue": DialogueView,
    "robot": RobotView,
    "layout": Layout,
    "document_check": DocumentCheck,
    "world": WorldView,
    "problem": Problem,
    "intervention": Intervention,
    "scene": Scene,
    "scenario": Scenario,
}


def openapi() -> dict[str, Any]:
    """The REST API as OpenAPI 3.1."""
    return described_app().openapi()


def json_schemas() -> dict[str, dict[str, Any]]:
    """A JSON Schema (2020-12) of everything that goes over a wire, by name."""
    return {
        name: {"$schema": DIALECT, **TypeAdapter(shape).json_schema()}
        for name, shape in SCHEMAS.items()
    }


def asyncapi() -> dict[str, Any]:
    """The WebSockets as AsyncAPI 3, from the service's point of view."""
    to_helpers = TO_HELPERS
    from_helpers = members_of(helper_messages.ClientMessage)
    to_microphones = members_of(speech_messages.SpeechServerMessage)
    from_microphones = members_of(speech_messages.SpeechClientMessage)
    to_robots = members_of(link.ServiceMessage)
    from_robots = members_of(link.RobotMessage)
    # A robot's messages and the events share class names, so each socket has its own prefix.
    sockets: dict[str, Models] = {
        "helper": (*to_helpers, *from_helpers),
        "live": (Layout, helper_messages.Error, helper_messages.Auth),
        "speech": (*to_microphones, *from_microphones),
        "robot": (*to_robots, *from_robots),
    }
    schemas: dict[str, Any] = {}
    for prefix, models in sockets.items():
        schemas |= _component_schemas(prefix, models)
    return {
        "asyncapi": "3.0.0",
        "info": {
            "title": "Mend",
            "version": version("mend-robots"),
            "description": "The WebSockets of helpers and robots. All messages are JSON text, "
            "but for the poses of a run that is watched and a microphone's sound.",
        },
        "servers": {"local": {"host": "127.0.0.1:8080", "protocol": "ws"}},
        "channels": {
            "helper": {
                "address": "/ws/helper",
                "description": "A snapshot, then every event after it; answers and claims.",
                "messages": _message_references("helper", sockets["helper"]),
                "bindings": {"ws": {"query": HELPER_QUERY}},
            },
            "live": {
                "address": "/ws/live",
                "description": "Where everything in a run is: layouts, and a binary frame for "
                "every moment.",
                "messages": {
                    **_message_references("live", sockets["live"]),
                    **_reference("Frame", "live"),
                },
                "bindings": {"ws": {"query": LIVE_QUERY}},
            },
            "speech": {
                "address": "/ws/speech",
                "description": "A helper's microphone (binary: PCM16, mono, 16 kHz; empty where "
                "some is missing), and the spoken conversations about questions.",
                "messages": _message_references("speech", sockets["speech"]),
                "bindings": {"ws": {"query": SPEECH_QUERY}},
            },
            "robot": {
                "address": "/ws/robot",
                "description": "Commands to a robot, and what it reports.",
                "messages": _message_references("robot", sockets["robot"]),
            },
        },
        "operations": {
            "sendToHelper": _operation("send", "helper", to_helpers),
            "receiveFromHelper": _operation("receive", "helper", from_helpers),
            "sendToWatcher": _operation(
                "send", "live", (Layout, helper_messages.Error), more=("Frame",)
            ),
            "receiveFromWatcher": _operation("receive", "live", (helper_messages.Auth,)),
            "sendToSpeech": _operation("send", "speech", to_microphones),
            "receiveFromSpeech": _operation("receive", "speech", from_microphones),
            "sendToRobot": _operation("send", "robot", to_robots),
            "receiveFromRobot": _operation("receive", "robot", from_robots),
        },
        "components": {
            "schemas": schemas,
            "messages": {
                f"{prefix}.{model.__name__}": {
                    "name": _type_of(model),
                    "contentType": "application/json",
                    "summary": (model.__doc__ or "").strip().split("\n")[0],
                    "payload": {"$ref": f"#/components/schemas/{prefix}.{model.__name__}"},
                }
                for prefix, models in sockets.items()
                for model in models
            }
            | {"live.Frame": FRAME},
        },
    }


HELPER_NAME = {
    "type": "string",
    "minLength": 1,
    "maxLength": 64,
    "description": "Needed, and heeded, only where the token is not that of a principal.",
}

SPEECH_QUERY = {
    "type": "object",
    "properties": {"helper": HELPER_NAME},
}

HELPER_QUERY = {
    "type": "object",
    "properties": {
        "helper": HELPER_NAME,
        "after": {"type": "integer", "minimum": 0, "description": "The last event seen."},
        "told": {
            "type": "boolean",
            "description": "Whether each event has `lines`: what the transcript tells of it.",
        },
    },
}


LIVE_QUERY = {
    "type": "object",
    "required": ["run"],
    "properties": {
        "run": {"type": "string", "format": "uuid"},
        "helper": HELPER_NAME,
    },
}

FRAME = {
    "name": "frame",
    "contentType": "application/octet-stream",
    "summary": "One moment; little endian, as the layout before it says.",
    "payload": {
        "type": "string",
        "format": "binary",
        "description": "float64 time_s, uint32 number, uint16 joints J, uint16 objects N, "
        "J x float32 joint positions, 7 x float32 base pose, 7 x float32 tool pose, "
        "float32 opening_m, N x (7 x float32 pose, uint32 flags: 1 held, 2 gone, 4 hidden).",
    },
}


def members_of(union: Any) -> Models:
    """The models of a discriminated union."""
    models: Models = get_args(get_args(union)[0])
    return models


TO_HELPERS: Models = (
    helper_messages.SnapshotMessage,
    helper_messages.TroubleMessage,
    helper_messages.Result,
    helper_messages.Error,
    *members_of(AnyEvent),
)


def _type_of(model: type[BaseModel]) -> str:
    """The value of a message's `type`."""
    return str(get_args(model.model_fields["type"].annotation)[0])


def _component_schemas(prefix: str, models: Models) -> dict[str, Any]:
    _, definitions = models_json_schema(
        [(model, "serialization") for model in models],
        ref_template=f"#/components/schemas/{prefix}.{{model}}",
    )
    return {f"{prefix}.{name}": schema for name, schema in definitions["$defs"].items()}


def _message_references(prefix: str, models: Models) -> dict[str, Any]:
    references: dict[str, Any] = {}
    for model in models:
        references |= _reference(model.__name__, prefix)
    return references


def _reference(name: str, prefix: str) -> dict[str, Any]:
    return {name: {"$ref": f"#/components/messages/{prefix}.{name}"}}


def _operation(
    action: str, channel: str, models: Models, more: tuple[str, ...] = ()
) -> dict[str, Any]:
    names = (*(model.__name__ for model in models), *more)
    return {
        "action": action,
        "channel": {"$ref": f"#/channels/{channel}"},
        "messages": [{"$ref": f"#/channels/{channel}/messages/{name}"} for name in names],
    }
