"""Any event, by its `type`."""

from typing import Annotated, Any

from pydantic import Field, TypeAdapter

from mend.server.journal.events.dialogue_events import (
    Answered,
    Claimed,
    DeadlineExtended,
    DialogueClosed,
    DialogueOpened,
    Escalated,
    FirstLook,
    HandedOn,
    HelpAwaited,
    HelpNotSeen,
    HelpNotSeenYet,
    HelpReported,
    HelpVerified,
    LookedAnew,
    PromiseTakenBack,
    Prompt,
    Released,
    Resolved,
)
from mend.server.journal.events.fleet_events import (
    ErrandBegun,
    ErrandEnded,
    FleetTold,
    LegBegun,
    LegEnded,
    PlanChanged,
    RequestChanged,
)
from mend.server.journal.events.node_events import (
    ClipRecorded,
    IssueRaised,
    NodeAbandoned,
    NodeDone,
    NodeLeftOut,
    NodeReset,
    NodeReturned,
    NodeStarted,
    NodeTaken,
    NodeUndone,
    StepStarted,
    SuspectedFalseAlarm,
)
from mend.server.journal.events.robot_events import (
    RobotBack,
    RobotHolding,
    RobotLost,
    RobotResumed,
    WayFound,
)
from mend.server.journal.events.run_events import (
    CamerasRecorded,
    InterventionAccepted,
    InterventionDone,
    RecordingBegun,
    RunAborted,
    RunFailed,
    RunFinished,
    RunPaused,
    RunResumed,
    RunStarted,
)
from mend.server.journal.events.service_events import (
    AccessChanged,
    DocumentDeleted,
    DocumentKept,
    ModelDeleted,
    ModelKept,
    PushEnded,
    PushSubscribed,
    SignedIn,
    SignedOut,
    SignInFailed,
)
from mend.server.journal.events.site_events import (
    SiteClosed,
    SiteGivenBack,
    SiteIntervention,
    SiteOpened,
    SiteRestarted,
)
from mend.server.journal.events.steering_events import (
    AutonomySet,
    BreakpointRemoved,
    BreakpointSet,
    LeafHeld,
    LeafLetGo,
    LeafNotPreferred,
    LeafPreferred,
    LeafTriedAgain,
)

AnyEvent = Annotated[
    RunStarted
    | NodeStarted
    | NodeTaken
    | StepStarted
    | IssueRaised
    | ClipRecorded
    | RecordingBegun
    | CamerasRecorded
    | DialogueOpened
    | Prompt
    | FirstLook
    | LookedAnew
    | Claimed
    | Released
    | Answered
    | DeadlineExtended
    | Escalated
    | HandedOn
    | HelpAwaited
    | HelpVerified
    | HelpNotSeen
    | HelpReported
    | HelpNotSeenYet
    | PromiseTakenBack
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
    | AutonomySet
    | BreakpointRemoved
    | BreakpointSet
    | LeafHeld
    | LeafLetGo
    | LeafNotPreferred
    | LeafPreferred
    | LeafTriedAgain
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
    | ModelKept
    | ModelDeleted
    | SignedIn
    | SignInFailed
    | SignedOut
    | AccessChanged
    | PushSubscribed
    | PushEnded
    | SiteOpened
    | SiteGivenBack
    | SiteIntervention
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
