"""What several messages tell of: places, reach, what was detected, what is shown."""

from typing import Annotated, Literal

from pydantic import Field

from mend.robots.link.messages.values import (
    MOST_GUESSES,
    MOST_MEASURED,
    Coordinate,
    Count,
    Identifier,
    Measure,
    Message,
    Pixels,
    Sentence,
    Span,
    Time,
    Word,
)


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


class BaseLimits(Message):
    """What others reckon with where they pass a robot that drives.

    All of it, with what it carries, is within `radius_m` of its middle; `speed_m_s`: as fast as it
    drives where nothing says less.
    """

    radius_m: Annotated[float, Field(gt=0.0)]
    speed_m_s: Annotated[float, Field(gt=0.0)]


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
    `robot`: that which is in the way, if it is a robot that has failed. `measured`: what the
    monitor goes by, under names that end with their unit (`force_n`, `opening_m`).
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
    measured: Annotated[dict[Word, Measure], Field(max_length=MOST_MEASURED)] = {}


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
