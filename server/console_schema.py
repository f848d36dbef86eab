"""The wire as the helper console uses it: one JSON Schema, from which its types are made."""

import json
import re
from collections.abc import Mapping
from typing import Any

from pydantic import TypeAdapter

from mend.server.api import helper_messages, speech_messages
from mend.server.journal.events import AnyEvent
from mend.server.push.messages import PushMessage
from mend.server.schemas import DIALECT, TO_HELPERS, Models, asyncapi, members_of, openapi
from mend.server.transcript_line import Line


def console() -> dict[str, Any]:
    """All that goes between the service and the console, as one JSON Schema of definitions."""
    rest = openapi()
    definitions = dict(rest["components"]["schemas"])
    for name, schema in asyncapi()["components"]["schemas"].items():
        prefix, _, model = name.partition(".")
        if prefix in ("helper", "speech"):
            definitions[model] = schema
    definitions["Event"] = _one_of(members_of(AnyEvent))
    definitions["TranscriptLine"] = TypeAdapter(Line).json_schema(mode="serialization")
    definitions |= definitions["TranscriptLine"].pop("$defs")
    definitions["FromHelper"] = _one_of(members_of(helper_messages.ClientMessage))
    definitions["ToHelper"] = _one_of(TO_HELPERS)
    definitions["FromSpeaker"] = _one_of(members_of(speech_messages.SpeechClientMessage))
    definitions["ToSpeaker"] = _one_of(members_of(speech_messages.SpeechServerMessage))
    definitions |= TypeAdapter(PushMessage).json_schema(mode="serialization")["$defs"]
    definitions["PushMessage"] = _one_of(members_of(PushMessage))
    bodies = [
        operation["requestBody"]
        for methods in rest["paths"].values()
        for operation in methods.values()
        if "requestBody" in operation
    ]
    received = _reachable(
        [definitions["FromHelper"], definitions["FromSpeaker"], bodies], definitions
    )
    for name in definitions.keys() - received:
        _require_all_fields(definitions[name])
    described = json.dumps({"$schema": DIALECT, "$defs": definitions})
    rooted = REFERENCE.sub('"#/$defs/', described)
    untitled: dict[str, Any] = json.loads(rooted, object_hook=_without_title)
    return untitled


REFERENCE = re.compile(r'"#/(?:components/schemas|[$]defs)/(?:helper\.|speech\.)?')


def _reachable(roots: Any, definitions: Mapping[str, Any]) -> set[str]:
    """The names of all definitions that `roots` refer to, directly or through others."""
    found: set[str] = set()
    waiting = [json.dumps(roots)]
    while waiting:
        for name in re.findall(REFERENCE.pattern + r'(\w+)"', waiting.pop()):
            if name not in found:
                found.add(name)
                waiting.append(json.dumps(definitions[name]))
    return found


def _require_all_fields(schema: dict[str, Any]) -> None:
    """What the service sends has every field, also those that have a default."""
    if "properties" in schema:
        schema["required"] = list(schema["properties"])


def _one_of(models: Models) -> dict[str, Any]:
    return {"oneOf": [{"$ref": f"#/$defs/{model.__name__}"} for model in models]}


def _without_title(schema: dict[str, Any]) -> dict[str, Any]:
    """A schema without the titles that would give each field a type of its own."""
    if isinstance(schema.get("title"), str):
        schema.pop("title")
    return schema
