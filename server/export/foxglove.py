"""The messages that Foxglove shows, as far as they are used here, with their JSON Schemas.

Fields and names are those of https://docs.foxglove.dev/docs/sdk/schemas.
"""

from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field

NS = 1_000_000_000

Base64 = Annotated[str, Field(json_schema_extra={"contentEncoding": "base64"})]


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
    """Something that stays where its frame is until it is deleted."""

    timestamp: Time
    frame_id: str
    id: str
    lifetime: Time = Time(sec=0, nsec=0)
    frame_locked: bool = True
    cubes: list[CubePrimitive]


class SceneEntityDeletion(FoxgloveModel):
    """`type` 0: the one entity with this id."""

    timestamp: Time
    type: int = 0
    id: str


class SceneUpdate(FoxgloveModel):
    deletions: list[SceneEntityDeletion]
    entities: list[SceneEntity]


class CompressedImage(FoxgloveModel):
    timestamp: Time
    frame_id: str
    data: Base64
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
