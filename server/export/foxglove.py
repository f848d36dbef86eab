"""The messages that Foxglove shows, as far as they are used here, with their JSON Schemas.

Fields and names are those of https://docs.foxglove.dev/docs/sdk/schemas. `SCHEMAS` has its schemas
as of version 2.1.0 (of Foxglove, under the MIT license) but for their descriptions. Its readers
follow no references in a schema, so that none may be made of the models here.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import BaseModel, ConfigDict, Field

NS = 1_000_000_000

SCHEMAS: Mapping[str, Mapping[str, Any]] = json.loads(
    Path(__file__).with_name("foxglove_schemas.json").read_text("utf-8")
)
"""Of every message that is not part of another one, by name."""

TIME: Mapping[str, Any] = SCHEMAS["foxglove.Log"]["properties"]["timestamp"]
"""The schema by which a field is known as a time."""

NoneOfThem = Annotated[list[Any], Field(max_length=0)]


class FoxgloveModel(BaseModel):
    """Base of messages and their parts."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Time(FoxgloveModel):
    """Seconds of 1970, and nanoseconds."""

    sec: Annotated[int, Field(ge=0)]
    nsec: Annotated[int, Field(ge=0, lt=NS)]

    @classmethod
    def of(cls, ns: int) -> Self:
        return cls(sec=ns // NS, nsec=ns % NS)


class Vector3(FoxgloveModel):
    x: float
    y: float
    z: float


class Quaternion(FoxgloveModel):
    x: float
    y: float
    z: float
    w: float


class Pose(FoxgloveModel):
    position: Vector3
    orientation: Quaternion


class FrameTransform(FoxgloveModel):
    """Where a frame is in its parent."""

    timestamp: Time
    parent_frame_id: str
    child_frame_id: str
    translation: Vector3
    rotation: Quaternion


class FrameTransforms(FoxgloveModel):
    transforms: list[FrameTransform]


class Color(FoxgloveModel):
    r: float
    g: float
    b: float
    a: float = 1.0


class CubePrimitive(FoxgloveModel):
    pose: Pose
    size: Vector3
    color: Color


class SceneEntity(FoxgloveModel):
    """Something that stays where its frame is until it is deleted; all of it are boxes.

    A `lifetime` of 0 has no end. Readers count on every kind of shape.
    """

    timestamp: Time
    frame_id: str
    id: str
    lifetime: Time = Time(sec=0, nsec=0)
    frame_locked: bool = True
    metadata: NoneOfThem = []
    arrows: NoneOfThem = []
    cubes: list[CubePrimitive]
    spheres: NoneOfThem = []
    cylinders: NoneOfThem = []
    lines: NoneOfThem = []
    triangles: NoneOfThem = []
    texts: NoneOfThem = []
    models: NoneOfThem = []


class SceneEntityDeletion(FoxgloveModel):
    """`type` 0: the one entity with this id."""

    timestamp: Time
    type: int = 0
    id: str


class SceneUpdate(FoxgloveModel):
    deletions: list[SceneEntityDeletion]
    entities: list[SceneEntity]


class CompressedImage(FoxgloveModel):
    """A picture; its `data` are in base64."""

    timestamp: Time
    frame_id: str
    data: str
    format: str


class JointState(FoxgloveModel):
    name: str
    position: float


class JointStates(FoxgloveModel):
    timestamp: Time
    joints: list[JointState]


class Log(FoxgloveModel):
    """A line; `level` is 1 (debug), 2 (info), 3 (warning) or 4 (error)."""

    timestamp: Time
    level: int
    message: str
    name: str
    file: str = ""
    line: int = 0
