"""Reports of a robot to the service, which are durable."""

from typing import Annotated, Literal

from pydantic import Field

from mend.robots.link.messages.parts import Detection, Position, Sighting
from mend.robots.link.messages.values import MOST, Count, Message, Sentence, Span, Word
from mend.tasks.intervention import Intervention


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
    `jpeg` and `detection`: what the camera showed where what was expected was not so, and where in
    that the object is seen, and is to be. `led_round`: `way_clear` is fulfilled because another way
    leads round, not because what was in the way is gone. `brought`: whether what the fingers had
    lost was seen, as the arm drew back, not to be where this look sees it; None if that was not
    seen, or nothing was lost.
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
    brought: bool | None = None
    jpeg: str | None = None
    detection: Detection | None = None


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
    """The robot cannot carry out a command; `for_good`: nor any other, from now on."""

    type: Literal["rejected"] = "rejected"
    command: Word
    reason: Sentence
    for_good: bool = False


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
