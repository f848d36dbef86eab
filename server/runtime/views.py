"""What clients see of runs, dialogues and robots."""

from datetime import datetime
from enum import StrEnum
from typing import Any, Literal
from uuid import UUID

from pydantic import BaseModel, ConfigDict

from mend.dialogue.script import Help
from mend.robots.link.messages import Detection
from mend.server.journal.events import (
    AnswerOption,
    ClipPicture,
    MissingPart,
    UnseenPart,
    WayOption,
    Wording,
)
from mend.server.runtime.leaf_words import LeafDeed
from mend.tasks.autonomy import AutonomyLevel


class View(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class RunStatus(StrEnum):
    RUNNING = "running"
    PAUSED = "paused"
    FINISHED = "finished"
    FAILED = "failed"
    ABORTED = "aborted"
    UNREADABLE = "unreadable"
    """What the journal has of it cannot be read, so that nobody can say more; `result` says why."""

    @property
    def ended(self) -> bool:
        return self in (RunStatus.FINISHED, RunStatus.FAILED, RunStatus.ABORTED)


class NodeView(View):
    """One node's state, levels and potentials as they are now."""

    node: str
    name: str
    kind: Literal["then", "and", "or", "behavior"]
    behavior: str | None
    object: str | None
    place: str | None
    activation_level: float
    activation_potential: float
    active: bool
    done: bool
    abandoned: bool
    owner: str | None
    attempts: int


class PromptView(View):
    """The open prompt of a dialogue."""

    prompt: UUID
    version: int
    kind: Literal["say", "ask"]
    text: str
    answers: list[AnswerOption]
    deadline: float | None
    to: str | None
    timeout_effect: str = ""
    within_s: float | None = None
    """How long the question was to wait when it was put; an extension adds as much again."""
    extensions_left: int = 0
    headline: str = ""
    ways: list[WayOption] = []
    wordings: list[Wording] = []


class AwaitedHelp(View):
    """Physical help that `helper` promised; the robot watches until `until` (the run's clock).

    `within_s`: how long it was to watch. `reported_by`: who has said that it is done, while the
    robot looks whether it is. `at_a_word`: whether it would look at once if somebody said so.
    """

    help: Help
    helper: str
    until: float
    within_s: float = 0.0
    reported_by: str | None = None
    at_a_word: bool = True


class UnseenHelpView(View):
    """What a camera showed when promised help was last not seen (`time`: the run's clock)."""

    time: float
    picture: UUID
    detection: Detection | None


class DialogueView(View):
    """One dialogue. `prompt` is the latest; it is open while `status` is and it is an ask.

    `scripted`: the run's script answers, and people are not asked.
    """

    dialogue: UUID
    run: UUID
    status: Literal["open", "closed"]
    reason: str | None
    issue: str
    object: str | None
    robot: str
    node: str
    name: str
    scripted: bool = False
    interrupts: bool = True
    """Whether the robot waits; where it does not, help is needed now or not at all."""
    prompt: PromptView | None
    awaiting: Literal["answer", "help"] | None
    answered_by: str | None
    claimed_by: str | None
    claimed_until: datetime | None
    picture: UUID | None
    clip: list[ClipPicture] = []
    detection: Detection | None = None
    """What the monitor saw in `picture`."""
    help: AwaitedHelp | None = None
    unseen_help: UnseenHelpView | None = None


class QuestionView(View):
    """One open question, as it stands in a queue.

    `tree` is its run's task, `place` where its leaf belongs. `left_s`: how many seconds it is
    waited for still; None while that does not run out. `opened`: when the robot asked first.
    """

    dialogue: UUID
    prompt: UUID
    run: UUID
    tree: str
    robot: str
    name: str
    object: str | None
    place: str | None
    headline: str
    left_s: float | None
    opened: datetime
    attempt: int
    attempts: int
    to: str | None
    claimed_by: str | None


class BatchWayView(View):
    """A way that may be chosen for all of a batch at once."""

    way: str
    label: str


class QuestionBatchView(View):
    """Questions that may be answered alike, the most urgent first; mostly a single one.

    `at_once`: what may be chosen for all of them with one press, as it is safe to.
    """

    issue: str
    headline: str
    at_once: list[BatchWayView]
    questions: list[QuestionView]


class ChosenView(View):
    """What became of a choice for one of several questions; `refused` says why it counts not."""

    dialogue: UUID
    prompt: UUID
    refused: str | None = None


class RunResult(View):
    """How a run ended."""

    reason: str
    node: str | None = None
    missing: list[MissingPart] = []
    unseen: list[UnseenPart] = []


class LeafSaid(View):
    """What was understood, and done, of what somebody said of a leaf."""

    deed: LeafDeed
    node: str
    name: str


class WaitView(View):
    """A leaf before which a robot waits to be let go.

    `breakpoint`: the node before which somebody set one, `by` whom and why; None where the run's
    `level` of autonomy asks for it.
    """

    node: str
    name: str
    breakpoint: str | None
    by: str | None
    reason: str
    level: AutonomyLevel


class RunSummary(View):
    """One line about a run."""

    id: UUID
    tree: str
    world: str
    scenario: str | None
    seed: int
    speed: float | Literal["max"]
    status: RunStatus
    time: float
    started: datetime
    ended: datetime | None = None
    robots: list[str]
    result: RunResult | None
    trouble: str | None = None
    """Why the run goes no further for now: the journal cannot be written."""
    waits: list[WaitView] = []
    """The leaves before which a robot waits to be let go."""
    live: bool = True
    """Whether people answer what its robots ask; where a script does, nobody is called."""


class RunView(RunSummary):
    """Everything about a run now. `seq` is the last event it reflects."""

    seq: int
    nodes: list[NodeView]
    dialogues: list[DialogueView]
    """The open dialogues."""
    options: dict[str, Any]


class RobotView(View):
    """A connected or known robot."""

    robot: str
    connected: bool
    simulated: bool
    behaviors: list[str]
    cameras: list[str]
    reach: dict[str, float] | None
    run: UUID | None
    state: Literal["idle", "working", "holding", "lost"]
    model: str | None = None
    """The name of what it says it looks like."""


class WorldView(View):
    """A world that a run may be in; `reason` says why it cannot run here.

    `options`: what a run may choose about it in `world_options`, a JSON Schema for each name.
    """

    name: str
    available: bool
    reason: str | None
    options: dict[str, Any]


class Snapshot(View):
    """Every run that had not ended and every open dialogue, after the event `seq`.

    What became of a run's nodes is in its `RunView`.
    """

    seq: int
    runs: list[RunSummary]
    dialogues: list[DialogueView]
