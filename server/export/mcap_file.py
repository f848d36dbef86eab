"""A run as MCAP, for Foxglove: events, the transcript, poses and pictures over its clock.

Messages are JSON and their schemas JSON Schema. A message's time is when the run began by the wall
clock and what its own clock has counted since.
"""

import base64
import io
import json
import math
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

from mcap.writer import CompressionType, Writer
from pydantic import BaseModel, ConfigDict

from mend.server.export.foxglove import (
    NS,
    SCHEMAS,
    TIME,
    CompressedImage,
    FoxgloveModel,
    Log,
    Time,
)
from mend.server.export.run_file import ShownPicture
from mend.server.export.shown_frame import ShownBoxes, joints_of, transforms_of
from mend.server.journal import events as ev
from mend.server.poses.frame import DecodedFrame, Frame, decode
from mend.server.poses.layout import Layout
from mend.server.transcript_line import Line, Tone

CHUNK_BYTES = 256 * 1024
"""What is written in one piece, compressed: in a few ms."""

_DEBUG, _INFO, _WARNING, _ERROR = 1, 2, 3, 4
LEVELS: Mapping[Tone, int] = {
    Tone.STEP: _DEBUG,
    Tone.FAULT: _WARNING,
    Tone.SETBACK: _WARNING,
    Tone.FAILED: _ERROR,
}
"""Foxglove's levels of the tones that are not plain news."""


class JournaledEvent(BaseModel):
    """An event as the journal has it: what all have, and what its type has besides."""

    model_config = ConfigDict(extra="allow")

    seq: int
    time: float
    wall_time: datetime
    run: str
    type: str


class Gripper(FoxgloveModel):
    """How far the fingers are apart, m."""

    timestamp: Time
    opening_m: float


GRIPPER = "mend.Gripper"
OWN_SCHEMAS: Mapping[str, Mapping[str, Any]] = {
    "mend.Event": JournaledEvent.model_json_schema() | {"title": "mend.Event"},
    GRIPPER: {
        "title": GRIPPER,
        "type": "object",
        "properties": {"timestamp": TIME, "opening_m": {"type": "number"}},
        "required": ["timestamp", "opening_m"],
    },
}
"""Of messages that Foxglove does not know: none refers to another one, as it follows none."""


class McapFile:
    """An MCAP file; without a `layout` it has no poses.

    `began`: when the run began by the wall clock, and `began_s` when by its own.
    """

    shows = True

    def __init__(self, began: datetime, began_s: float, layout: Layout | None) -> None:
        self._zero_ns = round(began.timestamp() * 1e6) * 1000 - round(began_s * NS)
        self._layout = layout
        self._boxes = None if layout is None else ShownBoxes(layout)
        self._stream = _Stream()
        # It writes its numbers with `tell` alone, and so never goes back.
        self._writer = Writer(self._stream, CHUNK_BYTES, CompressionType.ZSTD)
        self._writer.start(profile="", library="mend")
        self._shown_s = -math.inf
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}

    def add_event(self, event: ev.Event, text: str, lines: Sequence[Line]) -> None:
        at_ns = self._ns(event.time)
        self._add("/events", "mend.Event", at_ns, text.encode(), event.seq)
        for line in lines:
            name, message = line.speaker, line.opening + line.text
            level = LEVELS.get(line.tone, _INFO)
            told = Log(timestamp=Time.of(at_ns), level=level, message=message, name=name)
            self._tell("/log", told, at_ns)

    def add_picture(self, shown: ShownPicture, jpeg: bytes) -> None:
        at_ns = self._ns(shown.time_s)
        image = CompressedImage(
            timestamp=Time.of(at_ns),
            frame_id=f"{shown.robot}/{shown.camera}",
            data=base64.b64encode(jpeg).decode(),
            format="jpeg",
        )
        self._tell(f"/pictures/{shown.robot}/{shown.camera}", image, at_ns)

    def add_frame(self, frame: Frame) -> None:
        if self._layout is None or self._boxes is None:
            return
        shown = decode(frame)
        layout = self._layout
        # Recorded before the robot showed what its last layout tells, or once more by a service
        # that was started again and took the run up where its last event was.
        if not _fits(layout, shown) or shown.time_s < self._shown_s:
            return
        self._shown_s = shown.time_s
        at_ns = self._ns(shown.time_s)
        time = Time.of(at_ns)
        self._tell("/tf", transforms_of(layout, shown, time), at_ns)
        update = self._boxes.update(shown, time)
        if update is not None:
            self._tell("/scene", update, at_ns)
        if layout.joints:
            self._tell("/joints", joints_of(layout.joints, shown.joints, time), at_ns)
        self._tell_gripper(layout.robot, shown.opening_m, at_ns)
        for arm in shown.arms:
            of = layout.arms[arm.number]
            if of.joints:
                joints = joints_of(of.joints, arm.joints, time)
                self._tell(f"/{of.robot}/joints", joints, at_ns)
            self._tell_gripper(of.robot, arm.opening_m, at_ns)

    def _tell_gripper(self, robot: str, opening_m: float, at_ns: int) -> None:
        told = Gripper(timestamp=Time.of(at_ns), opening_m=round(opening_m, 6))
        self._tell(f"/{robot}/gripper", told, at_ns)

    def take(self) -> bytes:
        return self._stream.take()

    def end(self) -> bytes:
        self._writer.finish()
        return self.take()

    def _ns(self, time_s: float) -> int:
        return max(0, self._zero_ns + round(time_s * NS))

    def _tell(self, topic: str, message: FoxgloveModel, at_ns: int) -> None:
        name = GRIPPER if isinstance(message, Gripper) else f"foxglove.{type(message).__name__}"
        self._add(topic, name, at_ns, message.model_dump_json().encode(), 0)

    def _add(self, topic: str, name: str, at_ns: int, data: bytes, seq: int) -> None:
        if topic not in self._channels:
            if name not in self._schemas:
                schema = json.dumps(SCHEMAS.get(name) or OWN_SCHEMAS[name]).encode()
                self._schemas[name] = self._writer.register_schema(name, "jsonschema", schema)
            self._channels[topic] = self._writer.register_channel(
                topic, "json", self._schemas[name]
            )
        # Numbers of messages have 32 bits there.
        self._writer.add_message(
            self._channels[topic], at_ns, data, publish_time=at_ns, sequence=seq & 0xFFFFFFFF
        )


def _fits(layout: Layout, frame: DecodedFrame) -> bool:
    """Whether a frame holds what its run's last layout says."""
    return (
        len(frame.joints) == len(layout.joints)
        and len(frame.objects) == len(layout.objects)
        and len(frame.robots) == len(layout.robots)
        and all(
            arm.number < len(layout.arms) and len(arm.joints) == len(layout.arms[arm.number].joints)
            for arm in frame.arms
        )
    )


class _Stream(io.BytesIO):
    """Takes what is written until somebody fetches it; `tell` counts all that ever was."""

    def __init__(self) -> None:
        super().__init__()
        self._taken = 0

    def tell(self) -> int:
        return self._taken + super().tell()

    def take(self) -> bytes:
        piece = self.getvalue()
        self._taken += len(piece)
        self.seek(0)
        self.truncate(0)
        return piece
