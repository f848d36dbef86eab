"""Commands of the service to a robot, which are idempotent."""

from typing import Annotated, Literal

from pydantic import Field

from mend.robots.link.messages.reports import FinishedResult
from mend.robots.link.messages.values import MOST, Coordinate, JsonObject, Message, Span, Time, Word
from mend.tasks.intervention import Intervention


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


class WayPoint(Message):
    """A point of a floor (base frame, metres)."""

    x: Coordinate
    y: Coordinate


class MakeWay(Message):
    """Make way for the robot `other`, with which it has met where they cannot pass each other.

    It drives along `way` (the last point is where it waits), on the floor at height `z`, and goes
    on `until` then. Without a way it is the other one that makes way: until then it asks nobody to
    clear its own.
    """

    type: Literal["make_way"] = "make_way"
    other: Word
    way: Annotated[list[WayPoint], Field(max_length=MOST)] = []
    z: Coordinate = 0.0
    until: Time


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
    | MakeWay
    | NoteTaken
    | Hold
    | Intervene
    | TakePicture
    | Shutdown,
    Field(discriminator="type"),
]
