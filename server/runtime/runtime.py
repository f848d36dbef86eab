"""The runtime: every run of the service, taken up again after a restart."""

import asyncio
import logging
from collections.abc import Awaitable, Callable, Mapping
from datetime import datetime
from functools import partial
from typing import cast
from uuid import UUID

from mend.dialogue.script import Script
from mend.errors import ConflictError, NotFoundError, UnreadableError, WrongInputError
from mend.server.camera_picture import CameraPicture
from mend.server.dialogues.answers import answer_source
from mend.server.dialogues.attendance import Attendance
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.dialogues.who_helps import HelpersView, who_helps
from mend.server.errors import BusyError
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry, Journal
from mend.server.journal.run_index import IndexedRun, RunPage
from mend.server.refusals import Refusals
from mend.server.runtime.camera_recorder import CameraSource
from mend.server.runtime.clock import RunClock, SimulatedClock
from mend.server.runtime.context import RunContext, RunSettings
from mend.server.runtime.dialogue_driver import DialogueDriver
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.failure import fail_run, why_it_stopped
from mend.server.runtime.handing_on import HandingOn
from mend.server.runtime.hardware import Hardware
from mend.server.runtime.new_run import NewRun, NewRuns
from mend.server.runtime.ports import LIVE, Poses, Preparation, RealRobots, Robots, Worlds
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.robot_owners import RobotOwners
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.run import Run
from mend.server.runtime.run_dialogues import RunDialogues
from mend.server.runtime.run_lookup import RunLookup
from mend.server.runtime.run_state import RunState
from mend.server.runtime.run_states import RunStates
from mend.server.runtime.run_views import (
    robot_view,
    steering_view,
)
from mend.server.runtime.steering_views import AnySteering, NodeSteeringView, SteeringView
from mend.server.runtime.views import (
    LeafSaid,
    RobotView,
    RunStatus,
    RunSummary,
    RunView,
    Snapshot,
)
from mend.tasks.definition import TaskTreeDefinition
from mend.tasks.intervention import OF_BUILDINGS, Intervention
from mend.tasks.scenario import Person, Scenario
from mend.tasks.scene import Scene

log = logging.getLogger(__name__)


class Runtime:
    """Implements `mend.server.runtime.service.RunService`."""

    def __init__(
        self,
        *,
        journal: Journal,
        robots: Robots,
        worlds: Worlds,
        preparation: Preparation,
        scripts: Mapping[str, Script],
        policy: EscalationPolicy,
        send_mail: Callable[[RunState, ev.Escalated | ev.SuspectedFalseAlarm, DialogueState], None],
        settings: RunSettings,
        monotonic: Callable[[], float],
        utc_now: Callable[[], datetime],
        poses: Poses,
        refusals: Refusals | None = None,
        attendance: Attendance | None = None,
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
        self._refusals = refusals or Refusals()
        self._states = RunStates(journal, scripts)
        self._runs: dict[UUID, Run] = {}
        self._lookup = RunLookup(journal, self._states, self._runs)
        self._handing_on = HandingOn(
            policy, attendance or Attendance(), self._states.all_going_on, self._runs.values
        )
        self._tasks: dict[UUID, asyncio.Task[None]] = {}
        self._owners = RobotOwners(robots)
        self.dialogues = RunDialogues(self._states, self._running, self._now_of)
        self._closing = False
        self._new_runs = NewRuns(preparation, worlds, utc_now, settings.limits)
        journal.trouble.watch(self._journal_troubled)

    def _now_of(self, state: RunState) -> float:
        run = self._runs.get(state.id)
        return state.time if run is None else run.context.clock.now()

    # --- Beginning and ending -----------------------------------------------------------------

    async def recover(self) -> None:
        """Fold the runs that had not ended, and take them up. Ended ones are read when asked for.

        What cannot be read, or was found to be damaged, is left alone and listed as unreadable.
        """
        for indexed in await self._states.left_by_the_last_service():
            await self._take_up_again(indexed)

    async def _take_up_again(self, indexed: IndexedRun) -> None:
        try:
            state = await self._states.read(indexed)
        except UnreadableError as error:
            # One run that cannot be read must not keep the others from going on.
            log.error("%s", error)
            return
        self._states.add(state)
        if not state.status.ended:
            await self._take_up_or_fail(state)
        self._states.let_go(state)

    def _journal_troubled(self, reason: str | None) -> None:
        for run in tuple(self._runs.values()):
            run.journal_troubled(reason)

    async def close(self) -> None:
        """Stop without ending any run: they are taken up at the next start."""
        if not self._closing:
            self._closing = True
            self._journal.trouble.unwatch(self._journal_troubled)
        tasks = tuple(self._tasks.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def wait_for_end(self, run: UUID) -> RunView:
        """Wait until a run has ended."""
        if run in self._tasks:
            await asyncio.wait([self._tasks[run]])
        return await self.run(run)

    async def start_run(self, request: RunRequest, author: ev.Author | None = None) -> RunSummary:
        """Begin a run. Raises `NotFoundError`, `WrongInputError` or `ConflictError`."""
        return await self._start(lambda: self._new_runs.make(request, author))

    async def start_run_of(
        self, run: UUID, request: RunRequest, tree: TaskTreeDefinition
    ) -> RunSummary:
        """Begin a run at a site of a tree that is no document; once only for each id.

        Raises `NotFoundError`, `WrongInputError` or `ConflictError`.
        """
        if await self.has_run(run):
            return await self.run_summary(run)
        return await self._start(lambda: self._new_runs.make_of(run, request, tree))

    async def has_run(self, run: UUID) -> bool:
        """Whether there is such a run, whatever has become of it."""
        return await self._journal.index.find(run) is not None

    async def _start(self, make: Callable[[], Awaitable[NewRun]]) -> RunSummary:
        self._refuse_one_too_many()
        new = await make()
        if self._closing:
            raise BusyError("the service is shutting down")
        # Others may have begun meanwhile.
        self._refuse_one_too_many()
        started = new.started
        if started.world == LIVE or started.site is not None:
            await self._wait_until_given_back(started.robots)
        if started.world == LIVE:
            self._owners.check_live(started.robots)
        else:
            self._owners.check_free(started.robots)
        with self._owners.promised(new.started):
            return await self._begin(new)

    def _refuse_one_too_many(self) -> None:
        most = self._settings.limits.running_runs
        running = len({*self._runs, *self._owners.promised_to})
        if running >= most:
            raise ConflictError(
                f"{running} runs have not ended yet, and at most {most} may go on at a time: abort "
                "one, or wait for its end",
                limit="running_runs",
            )

    async def _begin(self, new: NewRun) -> RunSummary:
        states: list[RunState] = []
        site = new.started.site
        at_s = None if site is None else self._worlds.now_s(site)
        begun = new.started.model_copy(update={"at_s": at_s})

        def fold(numbered: list[ev.Event]) -> None:
            started = cast(ev.RunStarted, numbered[0])
            states.append(RunState(started, self._scripts, new.nodes))
            self._states.add(states[0])

        await self._journal.append(Entry(events=[begun], tree=new.tree), fold)
        (state,) = states
        # One that is journaled while the service stops is taken up at the next start.
        if not self._closing:
            await self._take_up_or_fail(state)
            self._states.let_go(state)
        return self._lookup.summary(state)

    async def _wait_until_given_back(self, robots: list[str]) -> None:
        """A run that everybody knows to have ended may not have parted from its robots yet."""
        parting = [
            self._tasks[run]
            for run, each in self._runs.items()
            if each.context.state.status.ended and not each.proxies.keys().isdisjoint(robots)
        ]
        if parting:
            await asyncio.wait(parting)

    async def _take_up_or_fail(self, state: RunState) -> None:
        """Let a run go on; if that cannot be, it fails and says why."""
        context = self._context(state, SimulatedClock(state.time))
        try:
            hardware = self._hardware_of(state)
            context = self._context(state, hardware.clock(state.time))
            self._take_up(context, hardware)
        except Exception as error:
            log.exception("run %s could not be taken up", state.id)
            await fail_run(context, why_it_stopped(error))

    def _hardware_of(self, state: RunState) -> Hardware:
        if state.started.world == LIVE:
            return RealRobots(self._monotonic)
        return self._worlds.open(state, lambda: self._runs[state.id])

    def _context(self, state: RunState, clock: RunClock) -> RunContext:
        return RunContext(
            state,
            clock,
            self._journal,
            self._settings,
            self._utc_now,
            self._refusals,
            self._handing_on.follow,
        )

    def _take_up(self, context: RunContext, hardware: Hardware) -> None:
        state = context.state
        proxies = {
            robot: RobotProxy(robot, self._robots, frame) for robot, frame in state.frames.items()
        }
        scenario = state.scenario
        dialogues = DialogueDriver(
            context,
            answer_source(state.request, scenario),
            self._policy,
            _person_of(state, scenario) if hardware.simulated else None,
            partial(self._send_mail, state),
            self._handing_on.duty,
        )
        cameras = CameraSource(
            self._robots.take_picture, self._robots.has_time, self._monotonic, asyncio.sleep
        )
        run = Run(context, proxies, dialogues, hardware, self._poses.open(state), cameras)
        try:
            self._owners.give(run)
        except ConflictError:
            self._poses.close(state.id)
            raise
        self._runs[state.id] = run
        hardware.lend()
        task = asyncio.create_task(run.main(), name=f"run {state.id}")
        task.add_done_callback(partial(self._ended, run))
        self._tasks[state.id] = task

    def _ended(self, run: Run, task: asyncio.Task[None]) -> None:
        state = run.context.state
        self._owners.take_back(run)
        self._runs.pop(state.id, None)
        self._tasks.pop(state.id, None)
        self._poses.close(state.id)
        self._states.let_go(state)
        if not task.cancelled() and (error := task.exception()) is not None:
            log.error("run %s stopped and could not say so", state.id, exc_info=error)

    # --- What there is ------------------------------------------------------------------------

    async def runs(self, page: RunPage) -> list[RunSummary]:
        """A page of runs, newest first. Raises `NotFoundError` for a page after an unknown run."""
        return await self._lookup.runs(page)

    def helpers(self) -> HelpersView:
        """Who may be asked at this moment, and who of them is here, away or busy."""
        return who_helps(self._policy, self._handing_on.duty())

    async def count_runs(self) -> Mapping[RunStatus, int]:
        """How many runs there are of each status."""
        return await self._lookup.count_runs()

    async def run(self, run: UUID) -> RunView:
        """Everything about one run. Raises `NotFoundError` or `UnreadableError`."""
        return await self._lookup.run(run)

    async def run_summary(self, run: UUID) -> RunSummary:
        """One run without its nodes. Raises `NotFoundError` or `UnreadableError`."""
        return await self._lookup.run_summary(run)

    def lost_robots(self) -> list[tuple[UUID, str]]:
        """The robots that are gone, with their runs, where no script answers for people."""
        return self._lookup.lost_robots()

    async def run_json(self, run: UUID) -> list[bytes]:
        """What `run` returns, in JSON, in pieces."""
        return await self._lookup.run_json(run)

    async def snapshot(self, seq: int | None) -> Snapshot:
        """The state after event `seq`, or after the last one without it."""
        return await self._lookup.snapshot(seq)

    # --- What people ask for ------------------------------------------------------------------

    async def _running(self, run: UUID) -> Run:
        """Raises `NotFoundError`, `UnreadableError`, or `ConflictError` unless it goes on."""
        line = await self.run_summary(run)
        if line.status.ended:
            raise ConflictError(f"the run has ended ({line.status})")
        if run not in self._runs:
            raise ConflictError(f"nobody works on this run just now, though it is {line.status}")
        return self._runs[run]

    async def pause(self, run: UUID, author: ev.Author | None = None) -> RunSummary:
        """Stop a run where it is. Raises `ConflictError` unless it is running."""
        running = await self._running(run)
        await running.request(partial(running.pause, author))
        return self._lookup.summary(running.context.state)

    async def resume(self, run: UUID, author: ev.Author | None = None) -> RunSummary:
        """Let a paused run go on. Raises `ConflictError` unless it is paused."""
        running = await self._running(run)
        await running.request(partial(running.resume, author))
        return self._lookup.summary(running.context.state)

    async def abort(self, run: UUID, author: ev.Author | None = None) -> RunSummary:
        """End a run. Raises `ConflictError` if it has ended.

        While the journal cannot be written its robots stop at once, and it has ended only later.
        """
        running = await self._running(run)
        await running.abort_at_once(author)
        return self._lookup.summary(running.context.state)

    async def take_leaf(
        self, run: UUID, node: str, helper: str, author: ev.Author | None = None
    ) -> RunSummary:
        """Have a leaf be a person's, who does it themselves. Raises as `People.take`."""
        running = await self._running(run)
        await running.request(lambda: running.people.take(node, helper, author))
        return self._lookup.summary(running.context.state)

    async def give_leaf_back(self, run: UUID, node: str, helper: str) -> RunSummary:
        """Have it be anybody's again. Raises as `People.give_back`."""
        running = await self._running(run)
        await running.request(lambda: running.people.give_back(node, helper))
        return self._lookup.summary(running.context.state)

    async def say_of_leaf(
        self, run: UUID, words: str, helper: str, author: ev.Author | None = None
    ) -> LeafSaid:
        """Take a leaf, or give it back, in plain words. Raises as `People.say`."""
        running = await self._running(run)
        said = await running.request(lambda: running.people.say(words, helper, author))
        assert isinstance(said, LeafSaid), "it is what was asked for"
        return said

    async def steer(
        self, run: UUID, wish: AnySteering, by: str, author: ev.Author | None = None
    ) -> SteeringView:
        """Steer a run. Raises as `RunSteering.steer`."""
        running = await self._running(run)
        await running.request(lambda: running.steering.steer(wish, by, author))
        return steering_view(running.context.state)

    async def steering(self, run: UUID) -> SteeringView:
        """How a run is steered. Raises `NotFoundError` or `UnreadableError`."""
        return steering_view(await self._states.find(run))

    async def steering_of(self, run: UUID, node: str) -> NodeSteeringView:
        """What may be said of a node now. Raises `NotFoundError`, or `ConflictError` at its end."""
        running = await self._running(run)
        return running.steering.offers(node)

    async def record(
        self, run: UUID, seconds: float, by: str, author: ev.Author | None = None
    ) -> ev.RecordingBegun:
        """Have the cameras of a run recorded. Raises as `CameraRecorder.record`."""
        running = await self._running(run)
        begun = await running.request(lambda: running.recorder.record(seconds, by, author))
        assert isinstance(begun, ev.RecordingBegun), "it is what was asked for"
        return begun

    async def intervene(
        self, run: UUID, intervention: Intervention, author: ev.Author | None = None
    ) -> None:
        """Have a person do something in a simulated world. Raises `ConflictError`."""
        running = await self._running(run)
        state = running.context.state
        if state.started.world == LIVE:
            raise ConflictError("a run in the world 'live' has no simulated person")
        _check_intervention(state.scene, intervention)
        await running.request(lambda: running.intervene(intervention, author))

    async def picture(self, run: UUID, camera: str, robot: str | None = None) -> CameraPicture:
        """A camera's picture now. Raises `NotFoundError` or `ConflictError`."""
        running = await self._running(run)
        for name, proxy in running.proxies.items():
            asked = robot in (None, name)
            if asked and proxy.hello is not None and camera in proxy.hello.cameras:
                return await self._robots.take_picture(name, camera)
        whose = "no robot of this run" if robot is None else f"no robot '{robot}' of this run"
        raise NotFoundError(f"{whose} has a camera '{camera}'")

    # --- Robots -------------------------------------------------------------------------------

    def robots(self) -> list[RobotView]:
        """Every robot that is or was connected."""
        owners = {robot: run.context.state for run in self._runs.values() for robot in run.proxies}
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
    if intervention.act in OF_BUILDINGS and not scene.setting:
        raise WrongInputError(
            f"'{intervention.act}' is for buildings, and the scene '{scene.name}' is none"
        )
    # What robots carry in a building no scene names: whether it is there its world says.
    of_scene = intervention.object is None or intervention.object in scene.objects
    if not (of_scene or scene.setting):
        raise WrongInputError(f"the scene '{scene.name}' has no object '{intervention.object}'")
    if intervention.place is not None and intervention.place not in scene.places:
        raise WrongInputError(f"the scene '{scene.name}' has no place '{intervention.place}'")
