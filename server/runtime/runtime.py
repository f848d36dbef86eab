"""The runtime: every run of the service, taken up again after a restart."""

import asyncio
import logging
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import datetime
from functools import partial
from typing import Any, Literal, cast
from uuid import UUID

import numpy as np

from dialogue.script import Script
from server.dialogues.answers import answer_source
from server.dialogues.escalation import EscalationPolicy
from server.errors import ConflictError, InvalidError, LostRaceError, NotFoundError
from server.journal import events as ev
from server.journal.journal import Entry, Journal
from server.runtime.choosing import potentials_for
from server.runtime.clock import RunClock, SimulatedClock, WallClock
from server.runtime.context import RunContext, RunSettings
from server.runtime.dialogue_driver import DialogueDriver
from server.runtime.failure import fail_run, why_it_stopped
from server.runtime.history import History
from server.runtime.new_run import NewRuns
from server.runtime.ports import LIVE, Poses, RealRobots, Robots, ScenarioSource, TreeSource, Worlds
from server.runtime.requests import RunRequest
from server.runtime.robot_side import RobotSide
from server.runtime.run import Run
from server.runtime.run_state import DialogueState, RunState
from server.runtime.run_views import dialogue_view, robot_view, summary, view
from server.runtime.views import DialogueView, RobotView, RunSummary, RunView, Snapshot
from tasks.intervention import Intervention
from tasks.scenario import Person, Scenario
from tasks.scene import Scene

log = logging.getLogger(__name__)


class Runtime:
    """Implements `server.runtime.service.RunService`."""

    def __init__(
        self,
        *,
        journal: Journal,
        robots: Robots,
        worlds: Worlds,
        trees: TreeSource,
        scenarios: ScenarioSource,
        scripts: Mapping[str, Script],
        policy: EscalationPolicy,
        send_mail: Callable[[RunState, ev.Escalated | ev.SuspectedFalseAlarm, DialogueState], None],
        settings: RunSettings,
        monotonic: Callable[[], float],
        utc_now: Callable[[], datetime],
        poses: Poses,
    ) -> None:
        self._journal = journal
        self._robots = robots
        self._worlds = worlds
        self._scripts = scripts
        self._policy = policy
        self._send_mail = send_mail
        self._settings = settings
        self._monotonic = monotonic
        self._utc_now = utc_now
        self._poses = poses
        self._states: dict[UUID, RunState] = {}
        self._runs: dict[UUID, Run] = {}
        self._tasks: dict[UUID, asyncio.Task[None]] = {}
        self._unreadable: set[UUID] = set()
        self._promised: dict[str, UUID] = {}
        self._closing = False
        self._new_runs = NewRuns(trees, scenarios, worlds, utc_now, settings.limits)
        self._history = History(journal, scripts)
        journal.trouble.watch(self._journal_troubled)

    # --- Beginning and ending -----------------------------------------------------------------

    async def recover(self) -> None:
        """Fold the journal, and take up every run that had not ended."""
        for run in await self._journal.runs():
            try:
                state = await self._history.at(run, None)
            except Exception:
                # One run that cannot be read must not keep the others from going on.
                log.exception("run %s cannot be read from the journal", run)
                self._unreadable.add(run)
                continue
            if state is None:
                continue
            self._states[run] = state
            if not state.status.ended:
                await self._take_up_or_fail(state)

    def _journal_troubled(self, reason: str | None) -> None:
        for run in tuple(self._runs.values()):
            run.journal_troubled(reason)

    async def close(self) -> None:
        """Stop without ending any run: they are taken up at the next start."""
        if not self._closing:
            self._closing = True
            self._journal.trouble.unwatch(self._journal_troubled)
        for task in self._tasks.values():
            task.cancel()
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)

    async def wait_for_end(self, run: UUID) -> RunView:
        """Wait until a run has ended."""
        if run in self._tasks:
            await asyncio.wait([self._tasks[run]])
        return self.run(run)

    async def start_run(self, request: RunRequest) -> RunView:
        """Begin a run. Raises `NotFoundError`, `InvalidError` or `ConflictError`."""
        self._refuse_one_too_many()
        started = await self._new_runs.make(request)
        if self._closing:
            raise ConflictError("the service is shutting down")
        # Others may have begun meanwhile.
        self._refuse_one_too_many()
        if request.world == LIVE:
            self._check_robots(request.robots)
        with self._promise(started):
            return await self._begin(started)

    def _refuse_one_too_many(self) -> None:
        most = self._settings.limits.running_runs
        running = len({*self._runs, *self._promised.values()})
        if running >= most:
            raise ConflictError(
                f"{running} runs have not ended yet, and at most {most} may go on at a time: abort "
                "one, or wait for its end",
                limit="running_runs",
            )

    @contextmanager
    def _promise(self, started: ev.RunStarted) -> Iterator[None]:
        """While a run is being journaled no other may be given its robots."""
        promised = dict.fromkeys(started.robots, started.run)
        self._promised.update(promised)
        try:
            yield
        finally:
            for robot in promised:
                del self._promised[robot]

    async def _begin(self, started: ev.RunStarted) -> RunView:
        def fold(numbered: list[ev.Event]) -> None:
            self._states[started.run] = RunState(cast(ev.RunStarted, numbered[0]), self._scripts)

        await self._journal.append(Entry(events=[started]), fold)
        state = self._states[started.run]
        # One that is journaled while the service stops is taken up at the next start.
        if not self._closing:
            await self._take_up_or_fail(state)
        return self.run(state.id)

    def _check_robots(self, robots: list[str]) -> None:
        if not robots:
            raise InvalidError(
                "a run in the world 'live' needs 'robots': the ids of connected ones"
            )
        twice = next((each for each in robots if robots.count(each) > 1), None)
        if twice is not None:
            raise InvalidError(f"'robots' names the robot '{twice}' more than once; once is enough")
        busy = {robot: run for run, each in self._runs.items() for robot in each.sides}
        busy |= self._promised
        for robot in robots:
            if not self._robots.connected(robot):
                raise NotFoundError(f"no robot '{robot}' is connected")
            if robot in busy:
                raise ConflictError(f"the robot '{robot}' is busy with run {busy[robot]}")

    async def _take_up_or_fail(self, state: RunState) -> None:
        """Let a run go on; if that cannot be, it fails and says why."""
        live = state.started.world == LIVE
        clock: RunClock = (
            WallClock(self._monotonic, state.time) if live else SimulatedClock(state.time)
        )
        context = RunContext(state, clock, self._journal, self._settings, self._utc_now)
        try:
            self._take_up(context, live=live)
        except Exception as error:
            log.exception("run %s could not be taken up", state.id)
            await fail_run(context, why_it_stopped(error))

    def _take_up(self, context: RunContext, *, live: bool) -> None:
        state = context.state
        sides = {robot: RobotSide(robot, cast(Any, self._robots)) for robot in state.started.robots}
        scenario = state.scenario
        dialogues = DialogueDriver(
            context,
            answer_source(state.request, scenario),
            self._policy,
            None if live else _person_of(state, scenario),
            partial(self._send_mail, state),
        )
        hardware = RealRobots() if live else self._worlds.open(state, lambda: self._runs[state.id])
        run = Run(context, sides, dialogues, hardware, self._poses.open(state))
        self._assign(run)
        self._runs[state.id] = run
        task = asyncio.create_task(run.main(), name=f"run {state.id}")
        task.add_done_callback(partial(self._ended, state))
        self._tasks[state.id] = task

    def _assign(self, run: Run) -> None:
        """Give a run all its robots, or none. Raises `ConflictError` if another run has one."""
        given: list[str] = []
        try:
            for robot in run.sides:
                self._robots.assign(robot, run)
                given.append(robot)
        except ConflictError:
            for robot in given:
                self._robots.unassign(robot)
            self._poses.close(run.context.state.id)
            raise

    def _ended(self, state: RunState, task: asyncio.Task[None]) -> None:
        for robot in state.started.robots:
            self._robots.unassign(robot)
        self._runs.pop(state.id, None)
        self._poses.close(state.id)
        if not task.cancelled() and (error := task.exception()) is not None:
            log.error("run %s stopped and could not say so", state.id, exc_info=error)

    # --- What there is ------------------------------------------------------------------------

    def _state(self, run: UUID) -> RunState:
        if run not in self._states:
            raise NotFoundError(f"there is no run {run}")
        return self._states[run]

    def _time(self, state: RunState) -> float:
        run = self._runs.get(state.id)
        return run.context.clock.now() if run and not state.status.ended else state.time

    def runs(self) -> list[RunSummary]:
        """All runs, newest first."""
        trouble = self._journal.trouble.reason
        states = reversed(self._states.values())
        return [summary(state, self._time(state), trouble) for state in states]

    def run(self, run: UUID) -> RunView:
        """Everything about one run. Raises `NotFoundError`."""
        return self._view(self._state(run))

    def _view(self, state: RunState) -> RunView:
        leaves = np.asarray(state.tree.leaves, dtype=np.int64)
        potentials = np.zeros(len(leaves))
        run = self._runs.get(state.id)
        for side in run.sides.values() if run else ():
            potentials = np.maximum(potentials, potentials_for(state, side, leaves))
        by_leaf = dict(zip(leaves.tolist(), potentials.tolist(), strict=True))
        return view(state, self._time(state), by_leaf, self._journal.trouble.reason)

    async def snapshot(self, seq: int | None) -> Snapshot:
        """The state after event `seq`, or after the last one without it."""
        head = self._journal.head
        at = head if seq is None else min(seq, head)
        views = []
        for run in await self._journal.runs():
            if run in self._unreadable:
                continue
            state: RunState | None = self._states.get(run)
            if state is None or not await self._history.is_at(state, at):
                state = await self._history.at(run, at)
            if state is not None and not state.status.ended:
                views.append(self._view(state))
        return Snapshot(seq=at, runs=views, dialogues=[d for each in views for d in each.dialogues])

    # --- What people ask for ------------------------------------------------------------------

    def _running(self, run: UUID) -> Run:
        state = self._state(run)
        if state.status.ended:
            raise ConflictError(f"the run has ended ({state.status})")
        if run not in self._runs:
            raise ConflictError(f"nobody works on this run just now, though it is {state.status}")
        return self._runs[run]

    async def pause(self, run: UUID) -> RunView:
        """Stop a run where it is. Raises `ConflictError` unless it is running."""
        running = self._running(run)
        await running.request(running.pause)
        return self.run(run)

    async def resume(self, run: UUID) -> RunView:
        """Let a paused run go on. Raises `ConflictError` unless it is paused."""
        running = self._running(run)
        await running.request(running.resume)
        return self.run(run)

    async def abort(self, run: UUID) -> RunView:
        """End a run. Raises `ConflictError` if it has ended.

        While the journal cannot be written its robots stop at once, and it has ended only later.
        """
        running = self._running(run)
        await running.abort_at_once()
        return self.run(run)

    async def intervene(self, run: UUID, intervention: Intervention) -> None:
        """Have a person do something in a simulated world. Raises `ConflictError`."""
        running, state = self._running(run), self._state(run)
        if state.started.world == LIVE:
            raise ConflictError("a run in the world 'live' has no simulated person")
        _check_intervention(state.scene, intervention)
        await running.request(lambda: running.intervene(intervention))

    async def picture(self, run: UUID, camera: str) -> bytes:
        """A camera's picture now, as JPEG. Raises `NotFoundError` or `ConflictError`."""
        running = self._running(run)
        for robot, side in running.sides.items():
            if side.hello is not None and camera in side.hello.cameras:
                return await self._robots.take_picture(robot, camera)
        raise NotFoundError(f"no robot of this run has a camera '{camera}'")

    # --- Dialogues ----------------------------------------------------------------------------

    def dialogues(self, status: Literal["open", "closed"] | None) -> list[DialogueView]:
        """Every dialogue, oldest first."""
        views = [
            dialogue_view(each)
            for state in self._states.values()
            for each in state.dialogues.values()
        ]
        return [each for each in views if status is None or each.status == status]

    def _dialogue(self, dialogue: UUID) -> tuple[RunState, DialogueState]:
        for state in self._states.values():
            if dialogue in state.dialogues:
                return state, state.dialogues[dialogue]
        raise NotFoundError(f"there is no dialogue {dialogue}")

    def dialogue(self, dialogue: UUID) -> DialogueView:
        """One dialogue. Raises `NotFoundError`."""
        return dialogue_view(self._dialogue(dialogue)[1])

    async def answer(
        self, dialogue: UUID, prompt: UUID, answer: Literal["yes", "no"], helper: str
    ) -> ev.Answered:
        """Answer a prompt: the first answer wins.

        Raises `NotFoundError`, `LostRaceError` or `ConflictError`.
        """
        state, found = self._dialogue(dialogue)
        try:
            run = self._running(state.id)
            side = run.sides[found.opened.robot]
            answered = await run.request(
                lambda: run.dialogues.answer(found, prompt, answer, helper, side)
            )
        except ConflictError:
            # Who was first is told also where that answer has ended the run.
            if prompt in found.answers:
                raise LostRaceError(prompt, found.answers[prompt].helper) from None
            raise
        return cast(ev.Answered, answered)

    async def extend(self, dialogue: UUID, prompt: UUID, helper: str) -> ev.DeadlineExtended:
        """Give the open question more time. Raises `NotFoundError` or `ConflictError`."""
        state, found = self._dialogue(dialogue)
        run = self._running(state.id)
        extended = await run.request(lambda: run.dialogues.extend(found, prompt, helper))
        return cast(ev.DeadlineExtended, extended)

    async def claim(self, dialogue: UUID, helper: str, *, take_over: bool = False) -> DialogueView:
        """Show the others that a helper is on it.

        Raises `ConflictError` while another is, unless it is taken over from them.
        """
        state, found = self._dialogue(dialogue)
        run = self._running(state.id)
        await run.request(lambda: run.claims.claim(found, helper, take_over=take_over))
        return dialogue_view(found)

    async def release(self, dialogue: UUID, helper: str) -> DialogueView:
        """Give up a claim. Raises `ConflictError` without one."""
        state, found = self._dialogue(dialogue)
        run = self._running(state.id)
        await run.request(lambda: run.claims.release(found, helper))
        return dialogue_view(found)

    # --- Robots -------------------------------------------------------------------------------

    def robots(self) -> list[RobotView]:
        """Every robot that is or was connected."""
        owners = {robot: run.context.state for run in self._runs.values() for robot in run.sides}
        return [
            robot_view(
                robot, self._robots.hello(robot), self._robots.connected(robot), owners.get(robot)
            )
            for robot in self._robots.known()
        ]


def _person_of(state: RunState, scenario: Scenario | None) -> Person:
    if state.request.person is not None:
        return state.request.person
    return scenario.person if scenario is not None else Person()


def _check_intervention(scene: Scene, intervention: Intervention) -> None:
    if intervention.object is not None and intervention.object not in scene.objects:
        raise InvalidError(f"the scene '{scene.name}' has no object '{intervention.object}'")
    if intervention.place is not None and intervention.place not in scene.places:
        raise InvalidError(f"the scene '{scene.name}' has no place '{intervention.place}'")
