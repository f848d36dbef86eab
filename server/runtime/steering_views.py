"""What people say to steer a run, and what clients see of it."""

from typing import Annotated, Literal
from uuid import UUID

from pydantic import BaseModel, ConfigDict, Field

from mend.documents.spellings import NODE, SEEN_CHARACTERS_OR_NONE
from mend.server.runtime.views import View, WaitView
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.steering_rules import SteeringAct

Reason = Annotated[
    str,
    Field(
        max_length=200,
        pattern=SEEN_CHARACTERS_OR_NONE,
        description="Why; the journal keeps it.",
        examples=["the glue is still wet"],
    ),
]


class SteerNode(BaseModel):
    """Say something of a node, by its path."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    act: Annotated[
        Literal[
            "go_on",
            "set_breakpoint",
            "remove_breakpoint",
            "do_next",
            "not_next",
            "try_again",
            "leave_out",
            "done_by_hand",
        ],
        Field(description="What is to be."),
    ]
    node: Annotated[str, Field(pattern=NODE, max_length=400)]
    reason: Reason = ""


class SetAutonomy(BaseModel):
    """Say how much the robots may do without being asked."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    act: Literal["set_autonomy"]
    level: Annotated[AutonomyLevel, Field(strict=False)]
    reason: Reason = ""


AnySteering = SteerNode | SetAutonomy


class BreakpointView(View):
    """A breakpoint, `by` whom it was set and why."""

    node: str
    name: str
    by: str
    reason: str


class PreferredView(View):
    """The leaf that is to be begun next, and who asked for it."""

    node: str
    name: str
    by: str
    reason: str


class OfferedAct(View):
    """Something that would be taken now, and what comes of it."""

    act: SteeringAct
    effect: str


class RefusedAct(View):
    """Something that would not be taken now, and why."""

    act: SteeringAct
    why: str


class NodeSteeringView(View):
    """What may be said of one node now. `seq`: after which event that is so."""

    run: UUID
    node: str
    name: str
    seq: int
    offered: list[OfferedAct]
    refused: list[RefusedAct]


class SteeringView(View):
    """How a run is steered now. `waits`: the leaves before which a robot waits to be let go."""

    run: UUID
    seq: int
    autonomy: AutonomyLevel
    breakpoints: list[BreakpointView]
    preferred: PreferredView | None
    waits: list[WaitView]
