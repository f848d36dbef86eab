"""What goes over the wire as a whole, either way."""

from typing import Annotated, Literal

from pydantic import Field, TypeAdapter

from mend.robots.link.messages.commands import CommandBody
from mend.robots.link.messages.parts import (
    IDENTITY,
    ActiveExecution,
    BaseLimits,
    Detection,
    Driven,
    PoseLayout,
    PoseValues,
    ReachLimits,
    RoomLimits,
    ShownPose,
)
from mend.robots.link.messages.reports import ReportBody
from mend.robots.link.messages.values import (
    MOST,
    Coordinate,
    Count,
    Identifier,
    JsonObject,
    Message,
    Seq,
    Time,
    Word,
)

PROTOCOL_VERSION = 1


class Hello(Message):
    """First message of a robot on every connection.

    `boot` is new at every start of the robot's program. `suitability`: per behavior, in (0, 1].
    `executing`: what it is doing, if anything. `reach`: None of a robot that takes hold of nothing.
    `shows`: what its `poses` hold; None if it sends none. `room`: without it no other robot of its
    run works while its arm does not rest. `keeps_clear`: it moves about and keeps clear of others
    by what it senses itself, so that no space is kept for it. `driven`: None without a base.
    `avoids_ways`: it takes `avoid`. `notes_taken`: it takes `note_taken`. `base`: it drives, takes
    `make_way`, and its `poses` say whether it is `barred`.
    """

    type: Literal["hello"] = "hello"
    protocol: Count
    robot: Identifier
    boot: Identifier
    behaviors: Annotated[list[Word], Field(max_length=MOST)]
    cameras: Annotated[list[Word], Field(max_length=MOST)]
    reach: ReachLimits | None = None
    suitability: dict[Word, Annotated[float, Field(ge=0, le=1)]] = {}
    executing: ActiveExecution | None = None
    time: Time
    simulated: bool = False
    shows: PoseLayout | None = None
    room: RoomLimits | None = None
    keeps_clear: bool = False
    driven: Driven | None = None
    avoids_ways: bool = False
    notes_taken: bool = False
    base: BaseLimits | None = None


class Report(Message):
    """A durable report; `seq` counts from 1 within a boot, without gaps.

    `boot` None is the boot of the hello; a report that an earlier start of the robot's program
    left undelivered names its own. `world`: a simulated world's state after it, from which it can
    be rebuilt. `driven`: so far.
    """

    type: Literal["report"] = "report"
    boot: Identifier | None = None
    seq: Annotated[Seq, Field(ge=1)]
    time: Time
    body: ReportBody
    world: JsonObject | None = None
    driven: Driven | None = None


class Heartbeat(Message):
    """Sent at least every `heartbeat_s` of the welcome, in wall time; not durable."""

    type: Literal["heartbeat"] = "heartbeat"
    time: Time


class Taken(Message):
    """The robot has the command and need not be sent it again in this boot; not durable."""

    type: Literal["taken"] = "taken"
    command: Identifier


class Picture(Message):
    """A camera's picture, base64 JPEG; not durable. `command` asked for it.

    `detection`: while the robot looks for something, where in the picture that is to be.
    """

    type: Literal["picture"] = "picture"
    command: Word
    camera: Word
    jpeg: str
    detection: Detection | None = None


class Poses(Message):
    """Where everything is that the hello's `shows` names; for display only, not durable.

    `base`: the robot's base frame, as it stands now, in that in which the robot began, but z from
    the ground of the scene; all other poses are in the base frame. `covariance`: how sure it is of
    that, as the variances and the covariance xx, xy, yy of its place along the axes of its map
    (m2); None where it does not say. `battery`: what its battery holds, as a share of what it can;
    None where it does not run out. `barred`: whether it drives and what it sees leaves it no way
    on; None while it could not make way for anybody. `tool`: the tool point (x the approach
    direction, y the opening direction of the fingers).
    """

    type: Literal["poses"] = "poses"
    time: Time
    joints: list[Coordinate] = []
    base: PoseValues = IDENTITY
    covariance: Annotated[list[Coordinate], Field(min_length=3, max_length=3)] | None = None
    battery: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    barred: bool | None = None
    tool: PoseValues
    opening_m: Coordinate
    objects: list[ShownPose] = []


AnyRobotMessage = Hello | Report | Heartbeat | Taken | Picture | Poses

RobotMessage = Annotated[AnyRobotMessage, Field(discriminator="type")]


class Welcome(Message):
    """The service's answer to a hello. `received`: the last seq it has of this boot."""

    type: Literal["welcome"] = "welcome"
    protocol: int
    received: Seq
    heartbeat_s: float


class Ack(Message):
    """All reports of a boot up to `seq` are committed; `boot` None is that of the hello."""

    type: Literal["ack"] = "ack"
    boot: Identifier | None = None
    seq: Seq


class Command(Message):
    """A command; the robot carries out an `id` once, however often it comes."""

    type: Literal["command"] = "command"
    id: Identifier
    body: CommandBody


class ShowPoses(Message):
    """Send `poses` at most so often per second of the robot's clock; 0 is not at all.

    Only for a robot whose hello says what it `shows`; holds for this connection.
    """

    type: Literal["show_poses"] = "show_poses"
    rate_hz: Annotated[float, Field(ge=0, le=100)]


class LinkError(Message):
    """The last message was not understood, or the connection is refused; in one sentence."""

    type: Literal["error"] = "error"
    detail: str


AnyServiceMessage = Welcome | Ack | Command | ShowPoses | LinkError

ServiceMessage = Annotated[AnyServiceMessage, Field(discriminator="type")]

robot_message: TypeAdapter[AnyRobotMessage] = TypeAdapter(RobotMessage)

service_message: TypeAdapter[AnyServiceMessage] = TypeAdapter(ServiceMessage)
