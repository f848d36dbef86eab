"""What Foxglove expects of an MCAP file: what it would not show, or show wrongly, a sentence each.

As its published schemas (2.1.0), its reader of JSON Schemas and the specification of MCAP say.
"""

import base64
import io
import json
import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import cv2
import jsonschema_rs
import numpy as np
from mcap.reader import make_reader
from mcap.records import Channel, Message, Schema

from mend.server.export.foxglove import SCHEMAS

NUMBERS_AND_THE_LIKE = {"boolean", "string", "number", "integer"}

Told = dict[str, list[dict[str, Any]]]


def mistakes_in(file: bytes, *, decodes: bool = True) -> list[str]:
    """All mistakes of a file; whether its pictures are any is asked where it `decodes` them."""
    reader = make_reader(io.BytesIO(file), validate_crcs=True)
    read = [
        (schema, channel, message)
        for schema, channel, message in reader.iter_messages()
        if schema is not None
    ]
    told: Told = {}
    for _, channel, message in read:
        told.setdefault(channel.topic, []).append(_json(message))
    return [
        *_of_schemas({schema.name: schema for schema, _, _ in read}),
        *_of_messages(read),
        *_of_order(file),
        *_of_summary(file),
        *(_of_pictures(told) if decodes else ()),
        *_of_frames(told),
        *_of_scene(told),
    ]


def _json(message: Message) -> dict[str, Any]:
    said: dict[str, Any] = json.loads(message.data, parse_constant=_refuse)
    return said


def _refuse(word: str) -> None:
    raise AssertionError(f"JSON has no {word}")


def _of_schemas(schemas: Mapping[str, Schema]) -> Iterator[str]:
    for name, schema in schemas.items():
        said = json.loads(schema.data)
        if schema.encoding != "jsonschema":
            yield f"{name} is in {schema.encoding}"
        if name.startswith("foxglove.") and said != SCHEMAS.get(name):
            yield f"{name} is not Foxglove's"
        yield from _unreadable(name, said)


def _unreadable(at: str, schema: Mapping[str, Any]) -> Iterator[str]:
    """Of an object's schema; a reader that meets any of this shows nothing of the channel."""
    if schema.get("type") != "object" or "properties" not in schema:
        yield f"{at} is no object with properties"
        return
    for name, of_field in schema["properties"].items():
        if "oneOf" in of_field:
            if not all(isinstance(each.get("const"), int) for each in of_field["oneOf"]):
                yield f"{at}.{name} is one of more than numbers"
            continue
        one = of_field.get("items", {}) if of_field.get("type") == "array" else of_field
        if one.get("type") == "object":
            yield from _unreadable(f"{at}.{name}", one)
        elif one.get("type") not in NUMBERS_AND_THE_LIKE:
            yield f"{at}.{name} is of no type: {sorted(one)}"


def _of_messages(read: list[tuple[Schema, Channel, Message]]) -> Iterator[str]:
    checks: dict[str, Callable[[Any], bool]] = {}
    for schema, channel, message in read:
        if channel.message_encoding != "json":
            yield f"{channel.topic} is in {channel.message_encoding}"
        if schema.name not in checks:
            checks[schema.name] = jsonschema_rs.validator_for(json.loads(schema.data)).is_valid
        if not checks[schema.name](_json(message)):
            yield f"{channel.topic}: {message.data[:200]!r} is no {schema.name}"


def _of_order(file: bytes) -> Iterator[str]:
    last: dict[str, int] = {}
    reader = make_reader(io.BytesIO(file))
    for _, channel, message in reader.iter_messages(log_time_order=False):
        if message.log_time < last.get(channel.topic, 0):
            yield f"{channel.topic} goes back by {last[channel.topic] - message.log_time} ns"
        last[channel.topic] = max(message.log_time, last.get(channel.topic, 0))


def _of_summary(file: bytes) -> Iterator[str]:
    reader = make_reader(io.BytesIO(file))
    summary = reader.get_summary()
    if summary is None or summary.statistics is None:
        yield "there is no summary, or no statistics in it"
        return
    found = list(reader.iter_messages(log_time_order=False))
    counted = summary.statistics
    times = [message.log_time for _, _, message in found]
    if counted.message_count != len(found):
        yield f"{counted.message_count} messages are counted, and {len(found)} there"
    if counted.channel_message_counts != Counter(channel.id for _, channel, _ in found):
        yield "the messages of a channel are counted wrongly"
    if (counted.message_start_time, counted.message_end_time) != (min(times), max(times)):
        yield "it begins or ends at another time than it says"
    if counted.chunk_count != len(summary.chunk_indexes) or not summary.chunk_indexes:
        yield "it has chunks without an index"
    for each in summary.chunk_indexes:
        if not each.message_index_offsets:
            yield "a chunk has no index of its messages"


def _of_pictures(told: Told) -> Iterator[str]:
    for topic, messages in told.items():
        for each in messages if topic.startswith("/pictures/") else ():
            picture = np.frombuffer(base64.b64decode(each["data"], validate=True), np.uint8)
            if each["format"] != "jpeg" or cv2.imdecode(picture, cv2.IMREAD_COLOR) is None:
                yield f"{topic} has a picture that is none"


def _of_frames(told: Told) -> Iterator[str]:
    """Frames are one tree, each under one parent for ever."""
    parents: dict[str, str] = {}
    for moment in told.get("/tf", ()):
        children = [each["child_frame_id"] for each in moment["transforms"]]
        if len(set(children)) != len(children):
            yield f"a frame is told twice in one message: {children}"
        for each in moment["transforms"]:
            child, parent = each["child_frame_id"], each["parent_frame_id"]
            if not child or not parent:
                yield "a frame has no name"
            if parents.setdefault(child, parent) != parent:
                yield f"{child} is under {parents[child]} and {parent}"
            turned = math.hypot(*each["rotation"].values())
            if not math.isclose(turned, 1.0, abs_tol=1e-3):
                yield f"{child} is turned by no unit quaternion ({turned:.3f})"
    roots = set(parents.values()) - parents.keys()
    if parents and len(roots) != 1:
        yield f"frames have the roots {sorted(roots)}"
    for child in parents:
        seen = {child}
        while (child := parents.get(child, "")) and child not in seen:
            seen.add(child)
        if child:
            yield f"frames are in a loop at {child}"
    named = {each["frame_id"] for update in told.get("/scene", ()) for each in update["entities"]}
    yield from (f"{each} is the frame of something and nowhere" for each in named - parents.keys())


def _of_scene(told: Told) -> Iterator[str]:
    there: set[str] = set()
    for update in told.get("/scene", ()):
        come = [each["id"] for each in update["entities"]]
        gone = {each["id"] for each in update["deletions"]}
        if len(set(come)) != len(come):
            yield f"two things of the scene have one id: {come}"
        if not gone <= there:
            yield f"what was not there is gone: {sorted(gone - there)}"
        there = (there - gone) | set(come)
        for each in update["entities"]:
            if each["lifetime"] != {"sec": 0, "nsec": 0}:
                yield f"{each['id']} vanishes by itself"
            if any(min(cube["size"].values()) <= 0 for cube in each["cubes"]):
                yield f"{each['id']} has a box without a size"
