"""Everything that a client may ask of a service, as it describes itself."""

from dataclasses import dataclass
from typing import Any, get_args
from uuid import UUID

from mend.robots.link import messages as link
from mend.server.api import helper_messages, speech_messages
from mend.server.app import described_app

NOBODY = UUID("00000000-0000-4000-8000-000000000000")


@dataclass(frozen=True)
class Request:
    """One operation of the OpenAPI, with an address that names nothing that there is."""

    operation: str
    method: str
    path: str
    template: str


def requests() -> list[Request]:
    """Every operation that the service describes."""
    paths: dict[str, Any] = described_app().openapi()["paths"]
    return [
        Request(operation["operationId"], method.upper(), _filled(path), path)
        for path, methods in paths.items()
        for method, operation in methods.items()
    ]


def _filled(path: str) -> str:
    known = {
        "name": "nothing",
        "camera": "head",
        "model": "none",
        "file": "a.stl",
        "answer": "yes",
        "robot": "nobody",
        "device": "0" * 32,
    }
    for parameter in ("run", "site", "dialogue", "prompt", "picture"):
        path = path.replace(f"{{{parameter}}}", str(NOBODY))
    for parameter, value in known.items():
        path = path.replace(f"{{{parameter}}}", value)
    assert "{" not in path, path
    return path


def message_types(union: object) -> set[str]:
    """The `type` of every message of a discriminated union."""
    models = get_args(get_args(union)[0])
    return {get_args(each.model_fields["type"].annotation)[0] for each in models}


SOCKETS: dict[str, set[str]] = {
    "/ws/helper": message_types(helper_messages.ClientMessage),
    "/ws/live": {"auth"},
    "/ws/speech": message_types(speech_messages.SpeechClientMessage),
    "/ws/robot": message_types(link.RobotMessage),
}
"""What a client may send on each WebSocket."""
