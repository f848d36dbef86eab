"""The state of a run: a fold over its events, and nothing else."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import singledispatchmethod
from uuid import UUID

from dialogue.conversation import Conversation
from dialogue.evidence import Change, PutRight
from dialogue.outlook import Outlook
from dialogue.script import CloseReason, Expectation, Script, Turn
from robots.link.messages import Detection, FinishedResult
from server.journal import events as ev
from server.runtime.requests import RunRequest
from server.runtime.run_result import Ending, result_of
from server.runtime.views import RunResult, RunStatus
from tasks.definition import TaskTreeDefinition
from tasks.issue import Issue, Sensed
from tasks.node_table import NodeTable
from tasks.resolution import Resolution
from tasks.scenario import Scenario
from tasks.scenario_file import built_in_scenario
from tasks.scene import Scene
from tasks.task_tree import TaskTree

MOST_EXTENSIONS = 10
"""So often the deadline of one question may be moved."""


@dataclass(slots=True)
class Execution:
    """One start of a leaf's behavior on a robot. `held`: the robot waits to be told to go on."""

    id: UUID
    leaf: int
    robot: str
    boot: str
    step: int = 0
    held: bool = False


@dataclass(slots=True)
class Claim:
    """A helper says that they are on it; wall time."""

    helper: str
    until: datetime


@dataclass(slots=True)
class DialogueState:
    """One dialogue: its conversation, its latest prompt and what it waits for."""

    opened: ev.DialogueOpened
    raised: ev.IssueRaised
    conversation: Conversation
    calls: list[str] = field(default_factory=list)
    prompt: ev.Prompt | None = None
    asked: ev.Prompt | None = None
    prompts: dict[UUID, ev.Prompt] = field(default_factory=dict)
    answers: dict[UUID, ev.Answered] = field(default_factory=dict)
    awaiting: ev.HelpAwaited | None = None
    claim: Claim | None = None
    claims: int = 0
    """How often it was claimed so far, renewals included."""
    resolved: ev.Resolved | None = None
    closed: CloseReason | None = None
    helps: int = 0
    put_at: dict[int, float] = field(default_factory=dict)
    """When (run's clock) the latest question was put, and each time again, by the ask's number."""
    asked_for_s: float | None = None
    """How long the open question waited for an answer when it was put."""
    first_look: ev.FirstLook | None = None
    looked_anew: ev.LookedAnew | None = None
    """The latest look that later ones are compared with besides the first."""
    extensions: dict[UUID, int] = field(default_factory=dict)
    """How often each question's deadline may still be moved, where it was before."""
    clip: list[ev.ClipPicture] = field(default_factory=list)

    @property
    def id(self) -> UUID:
        return self.opened.dialogue

    @property
    def extensions_left(self) -> int:
        """How often the latest question's deadline may still be moved."""
        if self.asked is None:
            return 0
        return self.extensions.get(self.asked.prompt, MOST_EXTENSIONS)

    @property
    def open_ask(self) -> ev.Prompt | None:
        """The question that waits for an answer."""
        if self.closed or self.awaiting or self.asked is None:
            return None
        return None if self.asked.prompt in self.answers else self.asked

    @property
    def helper(self) -> str:
        """Who answered last; empty if nobody has."""
        last = next(reversed(self.answers.values()), None)
        return "" if last is None else last.helper

    def turns_after(self, calls: Sequence[str], script: Script, outlook: Outlook) -> list[Turn]:
        """What the conversation would say to the last of more calls, without making them."""
        return rehearse(script, self.raised, [*self.calls, *calls], outlook)

    def advance(self, call: str) -> None:
        """Make a call to the conversation."""
        converse(self.conversation, call)
        self.calls.append(call)


def converse(conversation: Conversation, call: str) -> list[Turn]:
    """Make a call by its name: `open`, `yes`, `no`, `not_seen`, `silence`, `abort`.

    Two have arguments: `seen:moved` (a change) and `put_right:at_place:moved` (what is seen, too).
    """
    verb, *arguments = call.split(":")
    match verb, arguments:
        case "yes" | "no", []:
            return conversation.answer("yes" if verb == "yes" else "no")
        case "seen", [change]:
            return conversation.help_seen(Change(change))
        case "put_right", [seen, change]:
            return conversation.put_right(PutRight(Expectation(seen), Change(change)))
    calls = {
        "open": conversation.open,
        "not_seen": conversation.help_not_seen,
        "silence": conversation.silence,
        "abort": conversation.abort,
    }
    return calls[verb]()


def rehearse(
    script: Script, raised: ev.IssueRaised, calls: Sequence[str], outlook: Outlook
) -> list[Turn]:
    """What a conversation says to the last of `calls`, made one after the other."""
    conversation = Conversation(script, issue_of(raised), raised.outlook or Outlook(), outlook)
    turns: list[Turn] = []
    for call in calls:
        turns = converse(conversation, call)
    return turns


def issue_of(raised: ev.IssueRaised) -> Issue:
    """The issue as dialogue scripts know it."""
    return Issue(
        kind=raised.issue,
        robot=raised.robot,
        node=raised.node,
        name=raised.name,
        object=raised.object,
        place=raised.place,
        step=raised.step,
        interrupts=raised.interrupts,
        reason="" if raised.detection is None else raised.detection.explanation,
        sensed=_sensed(raised.detection),
    )


def _sensed(detection: Detection | None) -> Sensed:
    if detection is None:
        return Sensed.SEEN
    if detection.felt:
        return Sensed.FELT
    return Sensed.NOWHERE if detection.center is None else Sensed.SEEN


RETRIES = (Resolution.ROBOT_RETRY, Resolution.ROBOT_FINISH)
"""After these the robot tries again, from the beginning or from where it was."""


class RunState:
    """Everything about a run that its events say.

    `nodes` are those of the tree, where it was read already and left empty in `started`.
    """

    def __init__(
        self,
        started: ev.RunStarted,
        scripts: Mapping[str, Script],
        nodes: NodeTable | None = None,
    ) -> None:
        self.started = started
        self.request = RunRequest.model_validate(started.options)
        self.scene = Scene.model_validate(started.scene, strict=False)
        self.tree = TaskTree(nodes or TaskTreeDefinition.model_validate(started.tree))
        self.tree.running = True
        self.status = RunStatus.RUNNING
        self.result: RunResult | None = None
        self.ended: datetime | None = None
        self.executions: dict[str, Execution] = {}
        self.dialogues: dict[UUID, DialogueState] = {}
        self.lost: set[str] = set()
        self.accepted: dict[str, ev.InterventionAccepted] = {}
        self.intervened: set[str] = set()
        self.exhausted: set[int] = set()
        self.taken_back: dict[int, ev.NodeUndone] = {}
        """Leaves that were done, until a robot sets about them anew or they are done again."""
        self.times_gone: Counter[int] = Counter()
        """How often a leaf was done and its object then gone."""
        self.left_out: dict[int, ev.NodeLeftOut] = {}
        """Leaves that count as done though their object is missing, as a helper said."""
        self.to_leave_out: dict[int, ev.NodeLeftOut] = {}
        """Leaves that were left out and taken back since: nobody is asked about them again."""
        self.last_handled: dict[str, int] = {}
        """Which leaf was started last for an object: the one that says where it is to be."""
        self.results: dict[FinishedResult, int] | None = None
        """What finished leaves left behind, where nothing has changed that since it was derived."""
        self.helped_retries: Counter[int] = Counter()
        self.issues: dict[int, list[ev.IssueRaised]] = {}
        """What was raised about each leaf, in order."""
        self.suspected: set[int] = set()
        """Leaves about which a false alarm is suspected."""
        self.asks = 0
        self.helps = 0
        self.seq = started.seq
        self.time = started.time
        self.scripts = scripts
        self._raised: ev.IssueRaised | None = None

    def begun_anew(self) -> "RunState":
        """The state right after the run's first event."""
        return RunState(self.started, self.scripts, self.tree.nodes)

    @property
    def id(self) -> UUID:
        return self.started.run

    @property
    def scenario(self) -> Scenario | None:
        """The run's scenario as it was when the run began."""
        if self.started.script is not None:
            return Scenario.model_validate(self.started.script, strict=False)
        return built_in_scenario(self.started.scenario) if self.started.scenario else None

    @property
    def open_dialogues(self) -> list[DialogueState]:
        return [each for each in self.dialogues.values() if each.closed is None]

    def execution_of(self, leaf: int) -> Execution | None:
        """The execution of an active leaf."""
        return next((each for each in self.executions.values() if each.leaf == leaf), None)

    def dialogue_of(self, leaf: int) -> DialogueState | None:
        """The open dialogue about a leaf."""
        path = self.tree.path_of(leaf)
        return next((each for each in self.open_dialogues if each.opened.node == path), None)

    def fold(self, event: ev.Event) -> None:
        """Apply one event; events come in order of `seq`."""
        self._apply(event)
        self.seq = max(self.seq, event.seq)
        self.time = max(self.time, event.time)

    @singledispatchmethod
    def _apply(self, event: ev.Event) -> None:
        """Events that leave no trace in the state."""

    @_apply.register
    def _(self, event: ev.NodeStarted) -> None:
        leaf = self.tree.index_of(event.node)
        self.tree.start(leaf, event.robot)
        self.results = None
        if (handled := self.tree.leaf_definition(leaf).object) is not None:
            self.last_handled[handled] = leaf
        self.executions[event.robot] = Execution(event.execution, leaf, event.robot, event.boot)

    @_apply.register
    def _(self, event: ev.StepStarted) -> None:
        execution = self.executions.get(event.robot)
        if execution is not None and execution.id == event.execution:
            execution.step = event.step
            self.taken_back.pop(execution.leaf, None)

    @_apply.register
    def _(self, event: ev.RobotHolding) -> None:
        if event.robot in self.executions:
            self.executions[event.robot].held = True

    @_apply.register
    def _(self, event: ev.RobotResumed) -> None:
        if event.robot in self.executions:
            self.executions[event.robot].held = False

    @_apply.register
    def _(self, event: ev.IssueRaised) -> None:
        self._raised = event
        self.issues.setdefault(self.tree.index_of(event.node), []).append(event)
        if event.interrupts:
            self.executions[event.robot].held = True

    @_apply.register
    def _(self, event: ev.DialogueOpened) -> None:
        assert self._raised is not None, "a dialogue opens right after its issue was raised"
        script = self.scripts[event.issue]
        issue, outlook = issue_of(self._raised), self._raised.outlook or Outlook()
        dialogue = DialogueState(event, self._raised, Conversation(script, issue, outlook))
        dialogue.advance("open")
        self.dialogues[event.dialogue] = dialogue

    @_apply.register
    def _(self, event: ev.Prompt) -> None:
        dialogue = self.dialogues[event.dialogue]
        dialogue.prompt = dialogue.prompts[event.prompt] = event
        if event.kind == "ask":
            self.asks += 1
            dialogue.asked = event
            before = dialogue.put_at if event.version > 1 else {}
            dialogue.put_at = before | {self.asks: event.time}
            dialogue.asked_for_s = None if event.deadline is None else event.deadline - event.time
            dialogue.awaiting = None

    @_apply.register
    def _(self, event: ev.DeadlineExtended) -> None:
        dialogue = self.dialogues[event.dialogue]
        assert dialogue.asked is not None, "only a question has a deadline"
        moved = dialogue.asked.model_copy(update={"deadline": event.deadline})
        dialogue.prompt = dialogue.asked = dialogue.prompts[event.prompt] = moved
        dialogue.extensions[event.prompt] = event.extensions_left

    @_apply.register
    def _(self, event: ev.ClipRecorded) -> None:
        self.dialogues[event.dialogue].clip = event.pictures

    @_apply.register
    def _(self, event: ev.Claimed) -> None:
        dialogue = self.dialogues[event.dialogue]
        dialogue.claim = Claim(event.helper, event.lease_until)
        dialogue.claims += 1

    @_apply.register
    def _(self, event: ev.Released) -> None:
        self.dialogues[event.dialogue].claim = None

    @_apply.register
    def _(self, event: ev.Answered) -> None:
        dialogue = self.dialogues[event.dialogue]
        dialogue.answers[event.prompt] = event
        dialogue.claim = None
        dialogue.advance(event.answer)

    @_apply.register
    def _(self, event: ev.FirstLook) -> None:
        self.dialogues[event.dialogue].first_look = event

    @_apply.register
    def _(self, event: ev.LookedAnew) -> None:
        self.dialogues[event.dialogue].looked_anew = event

    @_apply.register
    def _(self, event: ev.SuspectedFalseAlarm) -> None:
        self.suspected.add(self.tree.index_of(event.node))

    @_apply.register
    def _(self, event: ev.HelpAwaited) -> None:
        dialogue = self.dialogues[event.dialogue]
        dialogue.awaiting = event
        dialogue.helps += 1
        self.helps += 1

    @_apply.register
    def _(self, event: ev.HelpVerified) -> None:
        dialogue = self.dialogues[event.dialogue]
        dialogue.awaiting = None
        dialogue.advance(f"seen:{event.change}")

    @_apply.register
    def _(self, event: ev.HelpNotSeen) -> None:
        dialogue = self.dialogues[event.dialogue]
        dialogue.awaiting = None
        dialogue.advance("not_seen")

    @_apply.register
    def _(self, event: ev.Resolved) -> None:
        self.dialogues[event.dialogue].resolved = event
        if event.helped and event.resolution in RETRIES:
            self.helped_retries[self.tree.index_of(event.node)] += 1

    @_apply.register
    def _(self, event: ev.DialogueClosed) -> None:
        dialogue = self.dialogues[event.dialogue]
        dialogue.closed = event.reason
        dialogue.awaiting = None
        dialogue.claim = None

    @_apply.register
    def _(self, event: ev.InterventionAccepted) -> None:
        self.accepted[event.command] = event

    @_apply.register
    def _(self, event: ev.InterventionDone) -> None:
        if event.command is not None:
            self.accepted.pop(event.command, None)
            self.intervened.add(event.command)

    @_apply.register
    def _(self, event: ev.NodeDone) -> None:
        self._finish(self.tree.index_of(event.node))

    @_apply.register
    def _(self, event: ev.NodeLeftOut) -> None:
        leaf = self.tree.index_of(event.node)
        self._finish(leaf)
        self.left_out[leaf] = event

    def _finish(self, leaf: int) -> None:
        self.tree.finish(leaf)
        self.results = None
        self.taken_back.pop(leaf, None)
        self.to_leave_out.pop(leaf, None)
        self._end_execution(leaf)

    @_apply.register
    def _(self, event: ev.NodeReturned) -> None:
        self.left_out.pop(self.tree.index_of(event.node), None)

    @_apply.register
    def _(self, event: ev.NodeUndone) -> None:
        leaf = self.tree.index_of(event.node)
        self.tree.take_back(leaf)
        self.results = None
        if leaf in self.left_out:
            self.to_leave_out[leaf] = self.left_out.pop(leaf)
        self.taken_back[leaf] = event
        self.times_gone[leaf] += event.because_of is None and not event.unseen

    @_apply.register
    def _(self, event: ev.NodeReset) -> None:
        leaf = self.tree.index_of(event.node)
        self.tree.put_back(leaf, failed=event.failed_attempt)
        self._end_execution(leaf)
        if self.tree.attempts(leaf) >= self.request.max_attempts:
            self.exhausted.add(leaf)

    def _end_execution(self, leaf: int) -> None:
        self.executions = {
            robot: each for robot, each in self.executions.items() if each.leaf != leaf
        }

    @_apply.register
    def _(self, event: ev.NodeAbandoned) -> None:
        self.tree.abandon(self.tree.index_of(event.node))

    @_apply.register
    def _(self, _event: ev.RunPaused) -> None:
        self.status = RunStatus.PAUSED
        self.tree.running = False

    @_apply.register
    def _(self, _event: ev.RunResumed) -> None:
        self.status = RunStatus.RUNNING
        self.tree.running = True

    @_apply.register
    def _(self, event: ev.RunFinished) -> None:
        self._end(RunStatus.FINISHED, event)

    @_apply.register
    def _(self, event: ev.RunFailed) -> None:
        self._end(RunStatus.FAILED, event)

    @_apply.register
    def _(self, event: ev.RunAborted) -> None:
        self._end(RunStatus.ABORTED, event)

    def _end(self, status: RunStatus, event: Ending) -> None:
        self.status, self.result, self.ended = status, result_of(event), event.wall_time
        self.tree.running = False

    @_apply.register
    def _(self, event: ev.RobotLost) -> None:
        self.lost.add(event.robot)

    @_apply.register
    def _(self, event: ev.RobotBack) -> None:
        self.lost.discard(event.robot)
