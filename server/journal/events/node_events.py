"""Events of a node of a run's tree: what became of it, and what went wrong in it."""

from typing import Literal
from uuid import UUID

from mend.dialogue.outlook import Outlook
from mend.robots.link.messages import Detection
from mend.server.journal.events.event import Author, EventModel, NodeEvent


class Candidate(EventModel):
    """One leaf that could have been started, and why it was or was not.

    `in_place`: another alternative would do as well, but what this one handles is at its place
    already. `asked_for_by`: who asked for it to be begun next.
    """

    node: str
    name: str
    level: float
    potential: float
    attempts: int
    in_place: bool = False
    asked_for_by: str | None = None


class NodeStarted(NodeEvent):
    """A leaf was chosen for a robot; journaled before any command is sent.

    `boot` is the robot's boot to which the command goes: a later boot knows nothing of it.
    """

    type: Literal["node_started"] = "node_started"
    robot: str
    boot: str
    execution: UUID
    attempt: int
    candidates: list[Candidate]


class NodeTaken(NodeEvent):
    """A person does a leaf themselves, until (the run's clock) it is given back.

    `was_at`: where a robot saw its object last (the scene's frame, metres), None if none had.
    `said_done`: they say that they have done it already, for a `reason`; a robot has to see it.
    """

    type: Literal["node_taken"] = "node_taken"
    helper: str
    until: float
    was_at: tuple[float, float, float] | None
    author: Author | None = None
    said_done: bool = False
    reason: str = ""


class StepStarted(NodeEvent):
    """A behavior's step has begun (1 is the first).

    `phase`: what it is for, as the robot says, and `object` what its leaf handles; both None in the
    journals of an older Mend.
    """

    type: Literal["step_started"] = "step_started"
    robot: str
    execution: UUID
    step: int
    step_name: str
    phase: str | None = None
    object: str | None = None


class IssueRaised(NodeEvent):
    """A monitor detected a fault. `picture` names the image at `/api/pictures/{picture}`.

    `last_seen`: where the last look before it saw the object (base frame, metres). `outlook`: which
    attempt this is, of how many, and what follows if it fails. `item`: what the leaf carries for
    people, `held_by`: in the basket of which robot that is, where it is in one, `away_m`: how far
    off that one stands, `message`: what it tells them, and `person`: whom it escorts, if it does.
    """

    type: Literal["issue_raised"] = "issue_raised"
    robot: str
    issue: str
    object: str | None
    place: str | None
    execution: UUID
    step: int
    interrupts: bool
    detection: Detection | None = None
    picture: UUID | None = None
    last_seen: tuple[float, float, float] | None = None
    outlook: Outlook | None = None
    item: str | None = None
    message: str | None = None
    person: str | None = None
    held_by: str | None = None
    away_m: float | None = None


class ClipPicture(EventModel):
    """One picture of a clip, at `/api/pictures/{picture}`; `time` on the run's clock."""

    time: float
    picture: UUID


class ClipRecorded(NodeEvent):
    """What the forearm camera saw before an issue, oldest first; comes after the issue itself."""

    type: Literal["clip_recorded"] = "clip_recorded"
    robot: str
    issue: str
    execution: UUID
    dialogue: UUID
    pictures: list[ClipPicture]


DoneBy = Literal["robot", "human", "both", "found"]
"""Who brought a result about; `found`: it was there already."""


class NodeDone(NodeEvent):
    """A leaf is done: `by` the robot, a human, or both; `found`: its result was there already."""

    type: Literal["node_done"] = "node_done"
    robot: str | None
    by: DoneBy


class NodeReset(NodeEvent):
    """A leaf was put back: not active, not done, eligible again where the tree allows it."""

    type: Literal["node_reset"] = "node_reset"
    robot: str | None
    reason: str
    failed_attempt: bool


class NodeLeftOut(NodeEvent):
    """A helper said to leave a leaf out; for the order of the tree it is done.

    `robot`: which one asked; None where nobody did, and somebody steered the run so for a `reason`.
    """

    type: Literal["node_left_out"] = "node_left_out"
    robot: str | None
    helper: str
    reason: str = ""
    author: Author | None = None


class NodeReturned(NodeEvent):
    """The object of a leaf that was left out is seen at its place: the leaf is simply done."""

    type: Literal["node_returned"] = "node_returned"
    robot: str


class NodeUndone(NodeEvent):
    """A done leaf was taken back: not done, its failed attempts kept.

    `robot` saw that the leaf's object is gone from its place, or, with `because_of`, that another
    one's is, after which a THEN puts this leaf. Those that come after others are told first.
    `unseen`: the object may well be there, but the robot sees nothing.
    """

    type: Literal["node_undone"] = "node_undone"
    robot: str
    reason: str
    because_of: str | None = None
    unseen: bool = False


class NodeAbandoned(NodeEvent):
    """An alternative of an OR is given up for good, because `leaf` could not be done."""

    type: Literal["node_abandoned"] = "node_abandoned"
    leaf: str
    reason: str


class SuspectedFalseAlarm(NodeEvent):
    """The same issue came again with nothing seen to change: the robot may be wrong about it.

    `times`: how often it has come on end. `explanation`: what the monitor said of it last. `told`:
    the operators who are written to.
    """

    type: Literal["suspected_false_alarm"] = "suspected_false_alarm"
    robot: str
    issue: str
    object: str | None
    times: int
    explanation: str = ""
    told: list[str] = []
