"""The protocol between the service and a robot: every message, as docs/robot_protocol.md says.

JSON text frames over one WebSocket. The robot sends `hello`, `report`, `heartbeat`, `taken`,
`picture` and `poses`; the service sends `welcome`, `ack`, `command`, `show_poses` and `error`.
Reports are durable: the robot keeps each in its outbox under (robot, boot, seq) until the service
has acknowledged it, which it does after it has committed it. Commands are idempotent: a robot
carries out a command `id` once,
and the service sends it again after a reconnect until it is `taken`.
All lengths are metres, angles radians, times seconds of the robot's clock, poses in its base frame.
"""

import json
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter

from mend.documents.spellings import SEEN_CHARACTERS_OR_NONE
from mend.robots.link.shown_name import SHOWN
from mend.tasks.intervention import Intervention

PROTOCOL_VERSION = 1

Identifier = Annotated[
    str,
    Field(min_length=1, max_length=128, pattern=SEEN_CHARACTERS_OR_NONE),
    SHOWN,
]
"""It is written to logs and terminals as it is."""

Word = Annotated[str, Field(max_length=128)]
"""A name or an id."""

Sentence = Annotated[str, Field(max_length=4000)]
"""What people are told."""

MOST = 10_000
"""So many objects, results or names are the most that one message tells of."""

MOST_GUESSES = 3
"""About so many places people are asked at most by a robot that is lost."""

Time = Annotated[float, Field(ge=-1e12, le=1e12)]
"""Seconds of the robot's clock; any zero, that of the calendar as well."""

Span = Annotated[float, Field(ge=0, le=1e9)]
"""How long something lasts, in seconds."""

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
"""Metres, radians, or what has no unit."""

Pixels = Annotated[float, Field(ge=-1e9, le=1e9)]

Count = Annotated[int, Field(ge=0, le=2**31 - 1)]

Seq = Annotated[int, Field(le=2**53 - 1)]
"""The number of a report: any reader of JSON can tell it from the next one."""


def _require_json(value: dict[str, Any]) -> dict[str, Any]:
    """Refuse NaN and infinities, which `Any` lets through and JSON does not have."""
    json.dumps(value, allow_nan=False)
    return value


JsonObject = Annotated[dict[str, Any], AfterValidator(_require_json)]


class Message(BaseModel):
    """A wire message: unknown fields are ignored, so that a newer peer may add some."""

    model_config = ConfigDict(extra="ignore", strict=True, frozen=True, allow_inf_nan=False)


class Position(Message):
    """A point in the robot's base frame."""

    x: Coordinate
    y: Coordinate
    z: Coordinate


class Sighting(Message):
    """Where the head camera saw an object; `yaw` of its long axis; `time` of the picture."""

    x: Coordinate
    y: Coordinate
    z: Coordinate
    yaw: Coordinate
    time: Time


class ReachLimits(Message):
    """The graspable range in the plane: distances in metres from (x, y)."""

    x: Coordinate
    y: Coordinate
    min_m: Coordinate
    max_m: Coordinate


class SwingLimits(Message):
    """An arm that turns about `pivot`; `tool` is where its tool point rests, in metres."""

    pivot: tuple[Coordinate, Coordinate]
    tool: tuple[Coordinate, Coordinate]


class RoomLimits(Message):
    """The room that an arm takes in the plane, in metres.

    All of it is within `around_m` of the convex hull of `resting` (the corners of what it covers at
    rest) and of where its tool is to go; `hand_over`: where it takes what people hold out. With
    `swing` the hull is also that of the arcs about its pivot between any two places of the tool.
    `torso`: the corners of what of the robot is always there beside its arm.
    """

    resting: Annotated[list[tuple[Coordinate, Coordinate]], Field(min_length=1, max_length=16)]
    hand_over: tuple[Coordinate, Coordinate]
    around_m: Annotated[Coordinate, Field(ge=0)]
    swing: SwingLimits | None = None
    torso: Annotated[list[tuple[Coordinate, Coordinate]], Field(max_length=16)] = []


class Detection(Message):
    """What a monitor saw: blob centre and expected centre in pixels (u, v), blob area in px.

    `size_px` is the width and height of the camera's picture that the pixels count in; the picture
    that is sent along may be an enlarged one. `felt`: by force, not by a camera, so that no camera
    can tell that it is over. `part` is what is in the way, if that is a known one. `probability` is
    that of the issue, from a monitor that weighs several cues; one that goes by what is plainly
    seen, or not seen, gives none. `explanation` is a clause that people are told: what the robot
    sensed. `guesses`: where a robot may be that is lost, likeliest first (`at F1-101`).
    `between`: the neighbouring places between which a way is barred, the one it came from first.
    `robot`: that which is in the way, if it is a robot that has failed.
    """

    camera: Word
    size_px: tuple[Count, Count] | None = None
    center: tuple[Pixels, Pixels] | None = None
    expected: tuple[Pixels, Pixels] | None = None
    tolerance_px: Pixels | None = None
    area_px: Count = 0
    felt: bool = False
    part: Word | None = None
    probability: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    explanation: Sentence = ""
    guesses: Annotated[list[Word], Field(max_length=MOST_GUESSES)] = []
    between: Annotated[list[Word], Field(max_length=2)] = []
    robot: Word | None = None


LASER = "laser"
"""What a `Detection` has for a camera where a laser saw what it is about."""

BASKET = "basket"
"""And where the load cell of a basket felt it."""

GAUGE = "gauge"
"""And where the gauge of a battery told it."""

TRACKER = "tracker"
"""And where what follows a person by eye, or by a badge, saw them or did not."""

LISTENING = "listening"
"""And where it is that nobody has said anything."""

PoseValues = tuple[
    Coordinate, Coordinate, Coordinate, Coordinate, Coordinate, Coordinate, Coordinate
]
"""x, y, z (m), qx, qy, qz, qw."""

IDENTITY: PoseValues = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class ShownObject(Message):
    """Something whose pose a robot's `poses` tell; a box, with a smaller one on top (`knob`).

    `kind` `obstacle`: what somebody holds in the arm's way. `color`: linear RGB in [0, 1]; None
    is that of the task's scene.
    """

    name: Identifier
    kind: Literal["object", "obstacle"] = "object"
    size: tuple[Coordinate, Coordinate, Coordinate]
    knob: tuple[Coordinate, Coordinate, Coordinate] | None = None
    color: tuple[Coordinate, Coordinate, Coordinate] | None = None


class PoseLayout(Message):
    """What a robot's `poses` hold, in their order; `model` names its model files.

    `drives`: its base frame moves.
    """

    drives: bool = False
    model: Identifier | None = None
    joints: Annotated[list[Identifier], Field(max_length=256)] = []
    objects: Annotated[list[ShownObject], Field(max_length=1024)] = []


class ShownPose(Message):
    """Where something is: the pose of its bottom centre.

    `gone`: nobody can see it any more. `hidden`: not to be seen now; the pose is the last known.
    """

    pose: PoseValues
    held: bool = False
    gone: bool = False
    hidden: bool = False


class Driven(Message):
    """What a base has driven since its program began: how far, by its wheels (metres).

    `barred_s`: how long it stood meanwhile before what barred its way, on its way.
    """

    way_m: Annotated[float, Field(ge=0, le=1e9)]
    barred_s: Span


class ActiveExecution(Message):
    """What a robot was doing when it said hello."""

    execution: Word
    state: Literal["running", "holding", "retreating"]
    step: Count


# --- Reports: robot to service, durable -------------------------------------------------------


class StepStarted(Message):
    """A behavior's step has begun; steps count from 1.

    `phase`: what the step is for, as `travel`, `ride`, `load`, `unload` or `tell`.
    """

    type: Literal["step_started"] = "step_started"
    execution: Word
    step: Count
    name: Word
    phase: Word | None = None


class IssueDetected(Message):
    """A monitor detected a fault. `interrupts`: the robot stops the behavior by itself."""

    type: Literal["issue"] = "issue"
    execution: Word
    issue: Word
    step: Count
    interrupts: bool
    detection: Detection | None = None
    jpeg: str | None = None
    """The picture in which the fault was seen, base64 JPEG."""


class ClipPicture(Message):
    """One picture of a clip, a base64 JPEG; `before_s`: how long before the fault was detected."""

    before_s: Span
    jpeg: str


class ClipTaken(Message):
    """What the forearm camera saw before an issue, oldest first; sent after the issue itself."""

    type: Literal["clip"] = "clip"
    execution: Word
    issue: Word
    pictures: Annotated[list[ClipPicture], Field(max_length=64)]


class Holding(Message):
    """The robot has stopped and holds: after an interrupt, or of itself after a fault."""

    type: Literal["holding"] = "holding"
    execution: Word | None = None
    at: Literal["neutral", "in_place", "hand_over"]


class Resumed(Message):
    """The behavior goes on, at `step`."""

    type: Literal["resumed"] = "resumed"
    execution: Word
    step: Count


class Finished(Message):
    """The behavior is through all its steps. `found_in_place`: there was nothing left to do."""

    type: Literal["finished"] = "finished"
    execution: Word
    found_in_place: bool = False


class FinishedResult(Message):
    """What a finished leaf left behind: `object` rests at `place`."""

    object: Word
    place: Word


FeltLoad = Literal["nothing", "too_little", "too_much", "lighter", "heavier", "another"]
"""What a basket feels that is not what was asked for: less or more than it, or something else."""


class Looked(Message):
    """What a look saw, in answer to a `look` command.

    `objects`: every object seen, by name. `gripper`: where the tool point is; a robot without one
    says where it is itself. `fulfilled`: whether
    what was expected came to be within the time given; None when nothing was expected.
    `there` and `gone`: of the command's `finished` results those that are seen to be so, and those
    whose place is seen without the object; what something hides is in neither. `held`: the object
    that is between the fingers. `blind`: why the head camera showed nothing of the table, or of
    where the object that was just put down is to be, so that the look tells nothing of what is on
    the table; None if it did. `felt`: what a basket felt where that was not what was expected;
    `another` also where something else than the object was held out to the fingers.
    `led_round`: `way_clear` is fulfilled because another way leads round, not because what was in
    the way is gone.
    """

    type: Literal["looked"] = "looked"
    command: Word
    objects: Annotated[dict[Word, Sighting], Field(max_length=MOST)]
    gripper: Position
    fulfilled: bool | None = None
    there: Annotated[list[FinishedResult], Field(max_length=MOST)] = []
    gone: Annotated[list[FinishedResult], Field(max_length=MOST)] = []
    held: Word | None = None
    blind: Sentence | None = None
    felt: FeltLoad | None = None
    led_round: bool = False


class WayFound(Message):
    """What a robot has found of a way that it drives, without asking anybody.

    `between`: neighbouring places of its map, the one it came from first. It goes round where that
    is `blocked`, a `door_closed` or an `elevator_dead`, or waits before it asks, as `avoid` says;
    it is `open` once the robot has passed it.
    """

    type: Literal["way_found"] = "way_found"
    finding: Word
    between: Annotated[list[Word], Field(min_length=2, max_length=2)]


class Held(Message):
    """The clock has reached what a `hold` command asked for."""

    type: Literal["held"] = "held"
    command: Word


class Intervened(Message):
    """A person did something in a simulated world. `ok` False: it could not be done (`detail`).

    `command` is the id of the `intervene` that asked for it, None if a script did.
    """

    type: Literal["intervened"] = "intervened"
    intervention: Intervention
    by: Word
    ok: bool = True
    detail: Sentence = ""
    command: Word | None = None


class Rejected(Message):
    """The robot cannot carry out a command."""

    type: Literal["rejected"] = "rejected"
    command: Word
    reason: Sentence


ReportBody = Annotated[
    StepStarted
    | IssueDetected
    | ClipTaken
    | Holding
    | Resumed
    | Finished
    | Looked
    | WayFound
    | Held
    | Intervened
    | Rejected,
    Field(discriminator="type"),
]


# --- Commands: service to robot, idempotent ---------------------------------------------------


class Location(Message):
    """A pose on a surface; `z` None means on the table."""

    x: Coordinate
    y: Coordinate
    z: Coordinate | None = None
    yaw: Coordinate = 0.0


WasDone = Literal["gone", "there"]
"""What is known of the object of a leaf that was done before."""


class Start(Message):
    """Start a behavior with its parameters under a new execution id.

    `size` are the full extents of the object and `target` where its bottom centre is to rest, as
    the task's scene has them; None where it has none. `was_done`: the leaf was done before, and
    its object was then seen `gone` from its place, or is still `there` as far as anybody knows;
    None for a leaf that never was, or that a robot has set about since. `finished`: the results
    that there are; one that is seen gone while the robot is about to cover its place ends in
    `holding`, and the service has it look. `object_at`: where others who work there expect the
    object to be taken from (base frame, metres), None where nobody else works; one that is seen
    elsewhere ends in `holding` as well.
    """

    type: Literal["start"] = "start"
    execution: str
    node: str
    behavior: str
    parameters: JsonObject
    size: tuple[float, float, float] | None = None
    target: Location | None = None
    was_done: WasDone | None = None
    finished: list[FinishedResult] = []
    object_at: tuple[float, float] | None = None


class Interrupt(Message):
    """Stop within one control cycle. `retreat`: then let go, move to neutral, end the execution."""

    type: Literal["interrupt"] = "interrupt"
    retreat: bool


class Resume(Message):
    """Go on with the held execution where the robot's own state allows it.

    `object_at` as in `start`.
    """

    type: Literal["resume"] = "resume"
    execution: str
    object_at: tuple[float, float] | None = None


Expected = Literal[
    "at_place",
    "in_reach",
    "in_gripper",
    "way_clear",
    "view_clear",
    "located",
    "loaded",
    "unloaded",
    "charged",
    "accompanied",
]


class Look(Message):
    """Look with the cameras.

    Without `expect`: one look at everything. With it: keep looking until it is so or `within_s`
    have passed. `at_place`: `object` rests at `place`; `in_reach`: `object` rests within the
    graspable range; `in_gripper`: take `object` from a person (move to the hand-over pose, open,
    close once it is seen between the fingers); `way_clear`: nothing is in the arm's way;
    `view_clear`: the head camera shows the table; `located`: it knows where it is; `loaded` and
    `unloaded`: its basket weighs what the step that waits needs, or what it weighed before;
    `charged`: current comes into its battery; `accompanied`: it sees near it whom it escorts. A
    person has told `guess`, one of a detection's `guesses`: then what it sees has to agree with it.
    `rate`: simulated worlds let their clock run so fast while they look again and again; None is
    the run's own speed. `finished`: the results to judge by what the last pictures show.
    """

    type: Literal["look"] = "look"
    object: str | None = None
    place: str | None = None
    expect: Expected | None = None
    guess: Word | None = None
    within_s: float = 0.0
    rate: float | None = None
    finished: list[FinishedResult] = []


class SlowDown(Message):
    """Scale all motion from now on; 1 is normal."""

    type: Literal["slow_down"] = "slow_down"
    factor: Annotated[float, Field(gt=0, le=1)]


class ClosedWay(Message):
    """Nobody gets through `between` these neighbouring places `until` then, as far as is known."""

    between: Annotated[list[Word], Field(min_length=2, max_length=2)]
    until: Time


class FailedRobot(Message):
    """A robot that works no more stands there, and may be pushed aside (base frame, metres)."""

    robot: Word
    x: Coordinate
    y: Coordinate
    z: Coordinate


class Avoid(Message):
    """Keep off these ways where others lead; all that were told before are open again.

    It changes nothing else that the robot does, at whatever time it comes. `asks_after_s`: before
    it asks people to free a way, it reports `way_found`, once in each execution, and waits so long,
    as another robot may do instead what it is about. `failed`: what it sees where one of these
    stands is that robot.
    """

    type: Literal["avoid"] = "avoid"
    ways: Annotated[list[ClosedWay], Field(max_length=MOST)] = []
    asks_after_s: Span = 0.0
    failed: Annotated[list[FailedRobot], Field(max_length=MOST)] = []


class NoteTaken(Message):
    """People have taken these `items` out of the robot's basket, for other robots.

    It has them no more and misses them in no basket. What it does not have changes nothing.
    """

    type: Literal["note_taken"] = "note_taken"
    items: Annotated[list[Word], Field(max_length=MOST)]


class Hold(Message):
    """Simulated worlds: let the clock run, the arm holding still, until `until` or a command.

    `rate` is simulated seconds per second; None as fast as possible.
    """

    type: Literal["hold"] = "hold"
    until: float
    rate: float | None = None


class Intervene(Message):
    """Simulated worlds: a person does this, now or when the clock reaches `at`.

    Nobody does what is still to come for an object once a look saw what it expected of it.
    """

    type: Literal["intervene"] = "intervene"
    intervention: Intervention
    by: str
    at: float | None = None


class TakePicture(Message):
    """Send a `picture` of a camera."""

    type: Literal["take_picture"] = "take_picture"
    camera: str


class Shutdown(Message):
    """Simulated robots: end the process."""

    type: Literal["shutdown"] = "shutdown"


CommandBody = Annotated[
    Start
    | Interrupt
    | Resume
    | Look
    | SlowDown
    | Avoid
    | NoteTaken
    | Hold
    | Intervene
    | TakePicture
    | Shutdown,
    Field(discriminator="type"),
]


# --- Envelopes --------------------------------------------------------------------------------


class Hello(Message):
    """First message of a robot on every connection.

    `boot` is new at every start of the robot's program. `suitability`: per behavior, in (0, 1].
    `executing`: what it is doing, if anything. `reach`: None of a robot that takes hold of nothing.
    `shows`: what its `poses` hold; None if it sends none. `room`: without it no other robot of its
    run works while its arm does not rest. `keeps_clear`: it moves about and keeps clear of others
    by what it senses itself, so that no space is kept for it. `driven`: None without a base.
    `avoids_ways`: it takes `avoid`. `notes_taken`: it takes `note_taken`.
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
    """A camera's picture, base64 JPEG; not durable. `command` asked for it."""

    type: Literal["picture"] = "picture"
    command: Word
    camera: Word
    jpeg: str


class Poses(Message):
    """Where everything is that the hello's `shows` names; for display only, not durable.

    `base`: the robot's base frame, as it stands now, in that in which the robot began, but z from
    the ground of the scene; all other poses are in the base frame. `covariance`: how sure it is of
    that, as the variances and the covariance xx, xy, yy of its place along the axes of its map
    (m2); None where it does not say. `battery`: what its battery holds, as a share of what it can;
    None where it does not run out. `tool`: the tool point (x the approach direction, y the
    opening direction of the fingers).
    """

    type: Literal["poses"] = "poses"
    time: Time
    joints: list[Coordinate] = []
    base: PoseValues = IDENTITY
    covariance: Annotated[list[Coordinate], Field(min_length=3, max_length=3)] | None = None
    battery: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
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
