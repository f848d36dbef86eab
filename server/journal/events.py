"""Every event of every run, as the journal keeps it and clients receive it.

`seq` is one sequence for the whole journal, `time` seconds of the run's clock, `wall_time` UTC,
`node` the path of child indices from the root (`/0/2/1`; the root is `/`).
"""

from datetime import datetime
from typing import Annotated, Any, Literal
from uuid import UUID

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from mend.dialogue.evidence import Change
from mend.dialogue.outlook import Outlook
from mend.dialogue.script import CloseReason, Expectation, Felt, Help
from mend.robots.link.messages import Detection
from mend.server.access.roles import Role
from mend.tasks.intervention import Intervention
from mend.tasks.resolution import Resolution


class EventModel(BaseModel):
    """Base of events and their parts."""

    # The journal's writer looks for these constants; a null would look like no number at all.
    model_config = ConfigDict(extra="forbid", frozen=True, ser_json_inf_nan="constants")


class Author(EventModel):
    """Who did something: the principal, the role that it had then, and where it came from.

    `address` is None for what was done in the service's own process.
    """

    principal: str
    role: Role
    address: str | None = None


class Event(EventModel):
    """What every event has. `seq` is 0 until the journal has given it its number."""

    seq: int = 0
    time: float
    wall_time: datetime
    run: UUID


class NodeEvent(Event):
    """An event of one node."""

    node: str
    name: str


class Candidate(EventModel):
    """One leaf that could have been started, and why it was or was not."""

    node: str
    name: str
    level: float
    potential: float
    attempts: int


class AnswerOption(EventModel):
    """One way to answer a prompt, and what it will do.

    `final`: it cannot be taken back otherwise, as the robot starts to move or the dialogue closes.
    """

    value: Literal["yes", "no"]
    effect: str
    final: bool = False


class RunStarted(Event):
    """A run began; everything needed to fold it again is here.

    `tree` and `scene` are the checked definitions in their JSON form; `options` the request's
    remaining fields. `site` is where it is, None in a world of its own. `script` is the scenario's
    definition in its JSON form, None without one and in the journals of an older Mend, whose
    scenarios are all built in. `author` is None there, too.
    """

    type: Literal["run_started"] = "run_started"
    tree_name: str
    tree: dict[str, Any]
    scene: dict[str, Any]
    world: str
    robots: list[str]
    seed: int
    speed: float | Literal["max"]
    scenario: str | None
    script: dict[str, Any] | None = None
    options: dict[str, Any]
    author: Author | None = None
    site: UUID | None = None


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
    """

    type: Literal["node_taken"] = "node_taken"
    helper: str
    until: float
    was_at: tuple[float, float, float] | None
    author: Author | None = None


class StepStarted(NodeEvent):
    """A behavior's step has begun (1 is the first).

    `phase`: what it is for, as the robot says; None in the journals of an older Mend.
    """

    type: Literal["step_started"] = "step_started"
    robot: str
    execution: UUID
    step: int
    step_name: str
    phase: str | None = None


class IssueRaised(NodeEvent):
    """A monitor detected a fault. `picture` names the image at `/api/pictures/{picture}`.

    `last_seen`: where the last look before it saw the object (base frame, metres). `outlook`: which
    attempt this is, of how many, and what follows if it fails. `item`: what the leaf carries for
    people, `held_by`: in the basket of which robot that is, where it is in one, `message`: what it
    tells them, and `person`: whom it escorts, if it does.
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


class DialogueEvent(NodeEvent):
    """An event of one dialogue."""

    dialogue: UUID
    robot: str
    issue: str
    object: str | None


class DialogueOpened(DialogueEvent):
    """A dialogue began."""

    type: Literal["dialogue_opened"] = "dialogue_opened"


class Prompt(DialogueEvent):
    """The robot says something, or asks a yes/no question.

    `prompt` stays the same when a question is repeated; `version` counts up. `to` is the helper
    that it is meant for first, None for everyone. `deadline` is in the run's clock, and
    `timeout_effect` says what follows if nobody answers until then.
    """

    type: Literal["prompt"] = "prompt"
    prompt: UUID
    version: int
    kind: Literal["say", "ask"]
    text: str
    answers: list[AnswerOption] = []
    deadline: float | None = None
    timeout_effect: str = ""
    to: str | None = None


class FirstLook(DialogueEvent):
    """What the robot saw first after it had put its question: later looks are compared with it.

    `fulfilled`: what was so already. `position`: where the object was seen (base frame, metres),
    None if it was not. `blind`: the camera showed nothing of the table, so that nothing was seen.
    """

    type: Literal["first_look"] = "first_look"
    fulfilled: list[Expectation]
    position: tuple[float, float, float] | None
    blind: bool = False


class LookedAnew(DialogueEvent):
    """What was right is so no more, or the camera sees again: later looks are compared with this.

    Its fields are those of the `FirstLook`.
    """

    type: Literal["looked_anew"] = "looked_anew"
    fulfilled: list[Expectation]
    position: tuple[float, float, float] | None


class Claimed(DialogueEvent):
    """A helper is on it; others see so until the lease ends (wall time)."""

    type: Literal["claimed"] = "claimed"
    helper: str
    lease_until: datetime
    author: Author | None = None


class Released(DialogueEvent):
    """A claim ended: by the helper, or because its lease ran out."""

    type: Literal["released"] = "released"
    helper: str
    expired: bool = False
    author: Author | None = None


class Answered(DialogueEvent):
    """The first answer to a prompt; it won. A scripted one has no `author`."""

    type: Literal["answered"] = "answered"
    prompt: UUID
    version: int
    answer: Literal["yes", "no"]
    helper: str
    author: Author | None = None


class DeadlineExtended(DialogueEvent):
    """A helper asked for more time: the open question now waits until `deadline` (run's clock)."""

    type: Literal["deadline_extended"] = "deadline_extended"
    prompt: UUID
    version: int
    deadline: float
    extensions_left: int
    helper: str
    author: Author | None = None


class Escalated(DialogueEvent):
    """Nobody answered in time: the question goes to somebody else."""

    type: Literal["escalated"] = "escalated"
    channel: Literal["helper", "mail"]
    to: str


class HelpAwaited(DialogueEvent):
    """A helper promised physical help; the robot watches for it until `until` (run's clock).

    `guess`: where the helper has said that the robot is.
    """

    type: Literal["help_awaited"] = "help_awaited"
    help: Help
    guess: str | None = None
    helper: str
    until: float


class HelpVerified(DialogueEvent):
    """The robot saw what was promised. `change`: what it saw to change since it asked.

    `at_place`: it saw the object at the very place where that is to go.
    """

    type: Literal["help_verified"] = "help_verified"
    help: Help
    change: Change = Change.UNKNOWN
    at_place: bool = False


class HelpNotSeen(DialogueEvent):
    """The robot did not see the promised help in time.

    `felt`: what its basket felt instead. `blind`: why it could see nothing; None if it saw that
    there was none.
    """

    type: Literal["help_not_seen"] = "help_not_seen"
    help: Help
    felt: Felt | None = None
    blind: str | None = None


class Resolved(DialogueEvent):
    """The issue is resolved, and so what becomes of the leaf.

    `helped`: a person was seen to help, or heard to where both work at once.
    """

    type: Literal["resolved"] = "resolved"
    resolution: Resolution
    helped: bool


class DialogueClosed(DialogueEvent):
    """The dialogue is over."""

    type: Literal["dialogue_closed"] = "dialogue_closed"
    reason: CloseReason


class InterventionAccepted(Event):
    """A person is to do something in a simulated world; journaled before the world hears of it.

    An `intervention` with the same `command` follows once it is done.
    """

    type: Literal["intervention_accepted"] = "intervention_accepted"
    act: str
    object: str | None
    intervention: Intervention
    by: str
    command: str
    author: Author | None = None


class InterventionDone(Event):
    """A person did something in a simulated world; `by` says who (scenario, helper, api, ...).

    `command` is that of the `intervention_accepted` that it follows from, if it does.
    """

    type: Literal["intervention"] = "intervention"
    act: str
    object: str | None
    intervention: Intervention
    by: str
    ok: bool = True
    detail: str = ""
    command: str | None = None


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
    """A helper told the robot to leave a leaf out; for the order of the tree it is done."""

    type: Literal["node_left_out"] = "node_left_out"
    robot: str
    helper: str


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


class RunPaused(Event):
    type: Literal["run_paused"] = "run_paused"
    author: Author | None = None


class RunResumed(Event):
    type: Literal["run_resumed"] = "run_resumed"
    author: Author | None = None


class MissingPart(EventModel):
    """A leaf whose object is not at its place at the end, as it was left out.

    `left_out_by`: the helper who said so; None in the journal of an older Mend, which did not ask.
    `nowhere`: the leaf handles no object that could be seen at a place; `object` is then what it
    carries, or its own name.
    """

    node: str
    name: str
    object: str
    place: str
    left_out_by: str | None = None
    nowhere: bool = False


class UnseenPart(EventModel):
    """A done leaf whose object the last look could not see, as something hides its place."""

    node: str
    name: str
    object: str
    place: str


class RunFinished(Event):
    """The task is done. `missing`: what was left out, as a helper said; `unseen`: what is hidden.

    The journal of an older Mend does not tell what was hidden.
    """

    type: Literal["run_finished"] = "run_finished"
    missing: list[MissingPart]
    unseen: list[UnseenPart] = []


class RunFailed(Event):
    """The run cannot go on; `node` is the leaf that could not be done, if it was one."""

    type: Literal["run_failed"] = "run_failed"
    reason: str
    node: str | None = None


class RunAborted(Event):
    type: Literal["run_aborted"] = "run_aborted"
    reason: str = ""
    author: Author | None = None


class RobotEvent(Event):
    robot: str


class RobotLost(RobotEvent):
    """The robot's connection or process is gone."""

    type: Literal["robot_lost"] = "robot_lost"
    reason: str


class RobotBack(RobotEvent):
    """The robot is there (again); `continues`: with the execution that it had."""

    type: Literal["robot_back"] = "robot_back"
    boot: str
    continues: bool


class RobotHolding(RobotEvent):
    """The robot has stopped and holds."""

    type: Literal["robot_holding"] = "robot_holding"
    at: str


class RobotResumed(RobotEvent):
    """The robot moves again, at `step` of its behavior."""

    type: Literal["robot_resumed"] = "robot_resumed"
    step: int


class WayFound(RobotEvent):
    """The robot has found a way to be barred, and goes round, or open, as it has passed it.

    `between`: neighbouring places, the one that it came from first.
    """

    type: Literal["way_found"] = "way_found"
    finding: str
    between: list[str]


NO_RUN = UUID(int=0)
"""The `run` of what belongs to none."""


class ServiceEvent(Event):
    """Something that was done to the service itself: only admins get to read it."""

    time: float = 0.0
    run: UUID = NO_RUN


class DocumentKept(ServiceEvent):
    """A task tree, scene or scenario was uploaded; journaled as it is kept."""

    type: Literal["document_kept"] = "document_kept"
    kind: Literal["tree", "scene", "scenario"]
    name: str
    replaced: bool
    author: Author | None


class DocumentDeleted(ServiceEvent):
    """An uploaded task tree, scene or scenario was deleted; journaled as it is."""

    type: Literal["document_deleted"] = "document_deleted"
    kind: Literal["tree", "scene", "scenario"]
    name: str
    author: Author | None


class AddressCount(EventModel):
    """How often something came from an address."""

    address: str
    times: int


class SignedIn(ServiceEvent):
    """A principal signed in, `times` since the last such event; `elsewhere`: at more addresses."""

    type: Literal["signed_in"] = "signed_in"
    principal: str
    role: Role
    times: int
    addresses: list[AddressCount]
    elsewhere: int = 0


class SignInFailed(ServiceEvent):
    """Wrong tokens and codes were shown, `times` since the event before, by whomever."""

    type: Literal["sign_in_failed"] = "sign_in_failed"
    times: int
    addresses: list[AddressCount]
    elsewhere: int = 0


class SignedOut(ServiceEvent):
    """A session was ended; its cookie, good until `expires`, opens nothing any more."""

    type: Literal["signed_out"] = "signed_out"
    session: str
    expires: int
    author: Author


class AccessChanged(ServiceEvent):
    """Somebody was given access, or it was taken from them.

    `change` is the id that the file of principals gives it. `address` of the author is None for
    what was done on the service's machine.
    """

    type: Literal["access_changed"] = "access_changed"
    what: Literal["added", "rotated", "revoked", "enrolment_opened", "enrolled"]
    principal: str
    role: Role
    author: Author
    change: UUID | None = None


class SiteEvent(ServiceEvent):
    """An event of a site, which runs use or not."""

    site: UUID


class SiteOpened(SiteEvent):
    """A simulated world was started, with these robots, to be there until it is closed."""

    type: Literal["site_opened"] = "site_opened"
    world: str
    scene: str
    robots: list[str]
    seed: int
    speed: float | Literal["max"]
    options: dict[str, Any]
    author: Author | None = None


class SiteGivenBack(SiteEvent):
    """A run has ended, and its robots are the site's again.

    `moved`: what it left at which place.
    """

    type: Literal["site_given_back"] = "site_given_back"
    of_run: UUID
    robots: list[str]
    moved: dict[str, str]


class SiteRestarted(SiteEvent):
    """A site's world had ended, and is started again where the journal has it."""

    type: Literal["site_restarted"] = "site_restarted"
    reason: str


class SiteClosed(SiteEvent):
    """A site's world was stopped for good."""

    type: Literal["site_closed"] = "site_closed"
    author: Author | None = None


class FleetEvent(SiteEvent):
    """An event of the fleet of a site; `at_s` is of the site's clock."""

    at_s: float


class RequestChanged(FleetEvent):
    """A request was made, or has come further: `what` is wanted and how far that is.

    `robot` is to be done with it at `done_s`; None where no robot is to do anything for it.
    `author`: who has asked for this change.
    """

    type: Literal["request_changed"] = "request_changed"
    request: str
    what: dict[str, Any]
    status: str
    reason: str | None
    robot: str | None
    done_s: float | None
    author: Author | None = None


class PlannedTransfer(EventModel):
    """A request's thing is to change robots: what that saves, as planned.

    `sooner_s`: how much sooner it is delivered than by one robot alone; `less_m`: how much less far
    all robots drive. Both are None where one alone could not bring it.
    """

    request: str
    sooner_s: float | None
    less_m: float | None


class PlanChanged(FleetEvent):
    """The plan of a fleet became another one, and why; whom that touches.

    `said`: a sentence by request or robot. `transfers`: what is to change robots that was not
    before, or not from this robot; the journals of an older Mend do not tell.
    """

    type: Literal["plan_changed"] = "plan_changed"
    number: int
    reason: str
    requests: list[str]
    robots: list[str]
    said: dict[str, str]
    transfers: list[PlannedTransfer] = []


class FleetTold(FleetEvent):
    """An operator told a fleet something: what that was, as `took r0 out of service: a squeak`.

    `finder`: the robot, where one found it. `robot`, `in_service`: which one works no more, or
    again; None for anything else, and in the journals of an older Mend.
    """

    type: Literal["fleet_told"] = "fleet_told"
    told: str
    author: Author | None = None
    finder: str | None = None
    robot: str | None = None
    in_service: bool | None = None


class LegEvent(FleetEvent):
    """An event of one leg; `number` counts those of its robot."""

    robot: str
    number: int
    booking: str
    action: str
    place: str


class LegBegun(LegEvent):
    """A robot is sent to a place for a booking; `start` is the place that it was at before."""

    type: Literal["leg_begun"] = "leg_begun"
    start: str


class LegEnded(LegEvent):
    """What became of a leg, why where it was not done, and where its robot is then.

    `driven_m`: how far its robot has driven meanwhile, by its wheels, and `barred_s` how long it
    stood on its way before what barred it; None where that is not known, and in the journals of an
    older Mend.
    """

    type: Literal["leg_ended"] = "leg_ended"
    outcome: str
    reason: str | None
    at: str
    driven_m: float | None = None
    barred_s: float | None = None


class ErrandBegun(FleetEvent):
    """A robot that carries out no leg is sent from `start` to a place: `author` wants it there.

    Without an author it goes out of another robot's way, or `charges` there.
    """

    type: Literal["errand_begun"] = "errand_begun"
    robot: str
    place: str
    start: str
    author: Author | None = None
    charges: bool = False


class ErrandEnded(FleetEvent):
    """Whether it has come there, why where it has not, and the place that it is at then."""

    type: Literal["errand_ended"] = "errand_ended"
    robot: str
    place: str
    came: bool
    reason: str | None
    at: str


AnyEvent = Annotated[
    RunStarted
    | NodeStarted
    | NodeTaken
    | StepStarted
    | IssueRaised
    | ClipRecorded
    | DialogueOpened
    | Prompt
    | FirstLook
    | LookedAnew
    | Claimed
    | Released
    | Answered
    | DeadlineExtended
    | Escalated
    | HelpAwaited
    | HelpVerified
    | HelpNotSeen
    | Resolved
    | DialogueClosed
    | InterventionAccepted
    | InterventionDone
    | NodeDone
    | NodeReset
    | NodeLeftOut
    | NodeReturned
    | NodeUndone
    | NodeAbandoned
    | SuspectedFalseAlarm
    | RunPaused
    | RunResumed
    | RunFinished
    | RunFailed
    | RunAborted
    | RobotLost
    | RobotBack
    | RobotHolding
    | RobotResumed
    | WayFound
    | DocumentKept
    | DocumentDeleted
    | SignedIn
    | SignInFailed
    | SignedOut
    | AccessChanged
    | SiteOpened
    | SiteGivenBack
    | SiteRestarted
    | SiteClosed
    | RequestChanged
    | PlanChanged
    | FleetTold
    | LegBegun
    | LegEnded
    | ErrandBegun
    | ErrandEnded,
    Field(discriminator="type"),
]

any_event: TypeAdapter[Any] = TypeAdapter(AnyEvent)
