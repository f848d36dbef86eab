"""The state of a run: a fold over its events, and nothing else."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import singledispatchmethod
from uuid import UUID

from mend.dialogue.script import Script
from mend.robots.link.messages import FinishedResult
from mend.server.journal import events as ev
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_result import Ending, result_of
from mend.server.runtime.steering_fold import fold_steering
from mend.server.runtime.views import RunResult, RunStatus
from mend.tasks.definition import TaskTreeDefinition
from mend.tasks.frames import Frame, frames_of
from mend.tasks.node_table import NodeTable
from mend.tasks.resolution import Resolution
from mend.tasks.scenario import Scenario
from mend.tasks.scenario_file import built_in_scenario
from mend.tasks.scene import Scene
from mend.tasks.steering import Hold, Steering
from mend.tasks.task_tree import TaskTree


@dataclass(slots=True)
class StartedExecution:
    """One start of a leaf's behavior on a robot. `held`: the robot waits to be told to go on."""

    id: UUID
    leaf: int
    robot: str
    boot: str
    step: int = 0
    held: bool = False


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
        script = started.script or {}
        said = self.request.answers
        self.live = said == "live" or (said is None and not script.get("answers"))
        """Whether people answer what its robots ask, and are called."""
        self.scene = Scene.model_validate(started.scene, strict=False)
        at = {name: each.pose for name, each in self.scene.places.items()}
        self.places = {name: (each.x, each.y, each.z or 0.0) for name, each in at.items()}
        table_z = self.scene.table.height
        self.spots = {
            name: (each.x, each.y, table_z if each.z is None else each.z)
            for name, each in at.items()
        }
        """Where what stands at a place has its bottom."""
        self.tree = TaskTree(nodes or TaskTreeDefinition.model_validate(started.tree))
        self.tree.running = True
        self.steering = Steering(self.tree, self.request.autonomy)
        self.status = RunStatus.RUNNING
        self.result: RunResult | None = None
        self.ended: datetime | None = None
        self.executions: dict[str, StartedExecution] = {}
        self.people: dict[int, ev.NodeTaken] = {}
        """The leaves that people do themselves."""
        self.dialogues: dict[UUID, DialogueState] = {}
        self.lost: set[str] = set()
        self.recorded_bytes = 0
        """Of its cameras' pictures, without those of issues and their clips."""
        self.accepted: dict[str, ev.InterventionAccepted] = {}
        self.intervened: set[str] = set()
        """Commands that were carried out, but for those that had been accepted: of these there may
        be any number, and they are asked for once.
        """
        self.exhausted: set[int] = set()
        self.taken_back: dict[int, ev.NodeUndone] = {}
        """Leaves that were done, until a robot sets about them anew or they are done again."""
        self.times_gone: Counter[int] = Counter()
        """How often a leaf was done and its object then gone."""
        self._times_anything_gone = 0
        self.left_out: dict[int, ev.NodeLeftOut] = {}
        """Leaves that count as done though their object is missing, as a helper said."""
        self.to_leave_out: dict[int, ev.NodeLeftOut] = {}
        """Leaves that were left out and taken back since: nobody is asked about them again."""
        self.last_handled: dict[str, int] = {}
        """Which leaf was started last for an object: the one that says where it is to be."""
        self.carriers: dict[str, str] = {}
        """Which robot was given each item, or met each person, last, or handed it over."""
        self.results: dict[FinishedResult, int] | None = None
        """What finished leaves left behind, where nothing has changed that since it was derived."""
        self.helped_retries: Counter[int] = Counter()
        self.issues: dict[int, list[ev.IssueRaised]] = {}
        """What was raised about each leaf, in order."""
        self.suspected: set[int] = set()
        """Leaves about which a false alarm is suspected."""
        self.progress = 0
        """Grows when the task comes on or a person does something: a robot alone cannot make it
        grow without end.
        """
        self._done_once: set[tuple[int, int]] = set()
        """Leaves that were done, each with how often anything had been gone before."""
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
    def world_kept_as(self) -> UUID:
        """What the journal keeps the state of its simulated world under."""
        return self.started.site or self.id

    @property
    def scenario(self) -> Scenario | None:
        """The run's scenario as it was when the run began."""
        if self.started.script is not None:
            return Scenario.model_validate(self.started.script, strict=False)
        return built_in_scenario(self.started.scenario) if self.started.scenario else None

    @property
    def frames(self) -> dict[str, Frame]:
        """The base frame of each robot, in the scene's order.

        Robots of a scene that does not say where they stand have its frame as their own.
        """
        robots, frames = self.started.robots, list(frames_of(self.scene).values())
        if len(frames) != len(robots):
            frames = [Frame()] * len(robots)
        return dict(zip(robots, frames, strict=True))

    @property
    def open_dialogues(self) -> list[DialogueState]:
        return [each for each in self.dialogues.values() if each.closed is None]

    @property
    def held(self) -> list[Hold]:
        """The leaves before which a robot waits to be let go, in tree order."""
        return [] if self.status.ended else self.steering.waits

    def execution_of(self, leaf: int) -> StartedExecution | None:
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
    def _(self, event: ev.AutonomySet | ev.LeafHeld) -> None:
        fold_steering(self.steering, self.tree, event)

    @_apply.register
    def _(self, event: ev.SteeringEvent) -> None:
        fold_steering(self.steering, self.tree, event)
        self.progress += 1

    @_apply.register
    def _(self, event: ev.LeafTriedAgain) -> None:
        leaf = self.tree.index_of(event.node)
        self.tree.try_again(leaf)
        self.steering.waiting.pop(leaf, None)
        self.results = None
        self.exhausted.discard(leaf)
        self.left_out.pop(leaf, None)
        self.to_leave_out.pop(leaf, None)
        self.times_gone.pop(leaf, None)
        self.helped_retries.pop(leaf, None)
        self.progress += 1

    @_apply.register
    def _(self, event: ev.NodeStarted) -> None:
        leaf = self.tree.index_of(event.node)
        self.tree.start(leaf, event.robot)
        self.steering.begun(leaf)
        self.results = None
        if (handled := self.tree.leaf_definition(leaf).object) is not None:
            self.last_handled[handled] = leaf
        self.executions[event.robot] = StartedExecution(
            event.execution, leaf, event.robot, event.boot
        )

    @_apply.register
    def _(self, event: ev.NodeTaken) -> None:
        leaf = self.tree.index_of(event.node)
        self.tree.start(leaf, event.helper)
        self.steering.begun(leaf)
        self.results = None
        if (handled := self.tree.leaf_definition(leaf).object) is not None:
            self.last_handled[handled] = leaf
        self.people[leaf] = event
        self.taken_back.pop(leaf, None)
        self.progress += 1

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
    def _(self, event: ev.DialogueEvent) -> None:
        self.dialogues[event.dialogue].fold(event)

    @_apply.register
    def _(self, event: ev.Answered) -> None:
        self.dialogues[event.dialogue].fold(event)
        self.progress += 1

    @_apply.register
    def _(self, event: ev.ClipRecorded) -> None:
        self.dialogues[event.dialogue].fold(event)

    @_apply.register
    def _(self, event: ev.CamerasRecorded) -> None:
        self.recorded_bytes += event.size_bytes

    @_apply.register
    def _(self, _event: ev.RecordingBegun) -> None:
        """What comes of it is told by others."""

    @_apply.register
    def _(self, event: ev.DialogueOpened) -> None:
        assert self._raised is not None, "a dialogue opens right after its issue was raised"
        self.dialogues[event.dialogue] = DialogueState.begun(event, self._raised, self.scripts)

    @_apply.register
    def _(self, event: ev.Prompt) -> None:
        dialogue = self.dialogues[event.dialogue]
        dialogue.fold(event)
        if event.kind == "ask":
            self.asks += 1
            before = dialogue.put_at if event.version > 1 else {}
            dialogue.put_at = before | {self.asks: event.time}

    @_apply.register
    def _(self, event: ev.SuspectedFalseAlarm) -> None:
        self.suspected.add(self.tree.index_of(event.node))

    @_apply.register
    def _(self, event: ev.HelpAwaited) -> None:
        self.dialogues[event.dialogue].fold(event)
        self.helps += 1

    @_apply.register
    def _(self, event: ev.Resolved) -> None:
        self.dialogues[event.dialogue].fold(event)
        if event.helped and event.resolution in RETRIES:
            self.helped_retries[self.tree.index_of(event.node)] += 1

    @_apply.register
    def _(self, event: ev.InterventionAccepted) -> None:
        self.accepted[event.command] = event
        self.progress += 1

    @_apply.register
    def _(self, event: ev.InterventionDone) -> None:
        if event.command is not None and self.accepted.pop(event.command, None) is None:
            self.intervened.add(event.command)

    @_apply.register
    def _(self, event: ev.NodeDone) -> None:
        leaf = self.tree.index_of(event.node)
        entrusted = self.tree.leaf_definition(leaf).entrusted
        if entrusted is not None and event.robot is not None:
            self.carriers[entrusted] = event.robot
        self._finish(leaf)

    @_apply.register
    def _(self, event: ev.NodeLeftOut) -> None:
        leaf = self.tree.index_of(event.node)
        if event.robot is None:
            self.tree.start(leaf, event.helper)
            self.steering.begun(leaf)
        self._finish(leaf)
        self.left_out[leaf] = event

    def _finish(self, leaf: int) -> None:
        self.tree.finish(leaf)
        self.results = None
        self.taken_back.pop(leaf, None)
        self.to_leave_out.pop(leaf, None)
        self._end_execution(leaf)
        done = leaf, self._times_anything_gone
        self.progress += done not in self._done_once
        self._done_once.add(done)

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
        gone = event.because_of is None and not event.unseen
        self.times_gone[leaf] += gone
        self._times_anything_gone += gone

    @_apply.register
    def _(self, event: ev.NodeReset) -> None:
        leaf = self.tree.index_of(event.node)
        self.tree.put_back(leaf, failed=event.failed_attempt)
        self._end_execution(leaf)
        # Of one leaf there are only so many failed attempts.
        self.progress += event.failed_attempt
        if self.tree.attempts(leaf) >= self.request.max_attempts:
            self.exhausted.add(leaf)

    def _end_execution(self, leaf: int) -> None:
        self.people.pop(leaf, None)
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
        self.progress += 1

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
