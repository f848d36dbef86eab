"""A run: one actor that takes reports, answers and requests in turn, and acts on the state.

Everything goes through its inbox, one item at a time: what follows from an item is committed to
the journal first, folded into the state, and only then acted upon. After each item `_settle` does
whatever the state demands, so that a run that is taken up after a crash goes on by itself.
"""

import asyncio
import logging
import math
from functools import partial
from typing import Any

from mend.errors import ConflictError, RefusalError
from mend.robots.link.messages import (
    Finished,
    Held,
    Hello,
    Holding,
    Intervened,
    IssueDetected,
    Looked,
    Poses,
    Rejected,
    Report,
    Resumed,
    StepStarted,
)
from mend.server.errors import BusyError
from mend.server.journal import events as ev
from mend.server.journal.journal import DuplicateReceiptError, JournalWriteError, Receipt
from mend.server.runtime.camera_recorder import CameraRecorder, CameraSource
from mend.server.runtime.claims import Claims
from mend.server.runtime.context import RunContext
from mend.server.runtime.cutting_short import CuttingShort
from mend.server.runtime.dialogue_driver import DialogueDriver
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.done_already import DoneAlready
from mend.server.runtime.failure import fail_run, why_it_stopped
from mend.server.runtime.giving_up import GivingUp
from mend.server.runtime.hardware import Hardware
from mend.server.runtime.inbox import Inbox, Item, Task, log_failure
from mend.server.runtime.interventions import Interventions
from mend.server.runtime.people import People
from mend.server.runtime.pose_sink import PoseSink
from mend.server.runtime.presence import RobotPresence
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.results import Results, results_of
from mend.server.runtime.robot_patience import RobotPatience
from mend.server.runtime.robot_proxy import JUDGING, Purpose, RobotActivity, RobotProxy
from mend.server.runtime.steering import RunSteering
from mend.server.runtime.task_allocation import TaskAllocation
from mend.server.runtime.team import Team
from mend.server.runtime.views import RunStatus
from mend.tasks.definition import BehaviorNode
from mend.tasks.intervention import Intervention

log = logging.getLogger(__name__)

REFUSALS = (RefusalError, DuplicateReceiptError, JournalWriteError)
"""What a request or a report may be answered with; anything else is a fault of ours."""


class Run:
    """One running run; implements `mend.server.robots.registry.RobotSink`."""

    def __init__(
        self,
        context: RunContext,
        proxies: dict[str, RobotProxy],
        dialogues: DialogueDriver,
        hardware: Hardware,
        poses: PoseSink,
        cameras: CameraSource,
    ) -> None:
        self._context = context
        self._proxies = proxies
        self._team = Team(context.state.scene, hardware.neighbours, self._taken)
        self._team.join(proxies, executing=context.state.executions)
        self._dialogues = dialogues
        self._hardware = hardware
        self._poses = poses
        self._reports = ReportEvents(context, dialogues)
        self._people = People(context, proxies, self._reports, self._team)
        self._steering = RunSteering(context, self._reports, self._people)
        self._claims = Claims(context)
        self._interventions = Interventions(context)
        self._inbox = Inbox()
        cutting_short = CuttingShort(context, proxies, dialogues, self._reports)
        self._results = Results(context, self._reports, cutting_short)
        self._done_already = DoneAlready(context.state, cutting_short)
        self._allocation = TaskAllocation(
            context,
            proxies,
            self._team,
            self._people,
            self._reports,
            self._results,
            self._steering,
        )
        self._presence = RobotPresence(
            context,
            proxies,
            hardware,
            dialogues,
            self._reports,
            self._interventions,
            poses,
            tell=self._inbox.tell,
            start=self._allocation.start,
        )
        self._patience = RobotPatience(context, hardware, self._presence)
        self._recorder = CameraRecorder(context, proxies, cameras, self._inbox.tell)
        self._giving_up = GivingUp(context, proxies, self._reports, cutting_short)
        self.ended = asyncio.Event()
        self._aborting = False
        self._settled_s = -math.inf

    @property
    def context(self) -> RunContext:
        return self._context

    @property
    def proxies(self) -> dict[str, RobotProxy]:
        return self._proxies

    @property
    def dialogues(self) -> DialogueDriver:
        return self._dialogues

    @property
    def people(self) -> People:
        return self._people

    @property
    def steering(self) -> RunSteering:
        return self._steering

    @property
    def recorder(self) -> CameraRecorder:
        return self._recorder

    @property
    def claims(self) -> Claims:
        return self._claims

    # --- Others at the same site (Neighbour) --------------------------------------------------

    def handled(self) -> set[str]:
        """The parts and places that its robots are about."""
        state = self._context.state
        leaves = [state.tree.leaf_definition(each.leaf) for each in state.executions.values()]
        leaves += self._taken()
        return {name for each in leaves for name in (each.object, each.place) if name is not None}

    def _taken(self) -> list[BehaviorNode]:
        """The leaves that people do themselves."""
        state = self._context.state
        return [state.tree.leaf_definition(leaf) for leaf in state.people]

    def look_again(self) -> None:
        """Others have changed something that this run may have waited for."""
        self._inbox.tell(_nothing)

    # --- The actor ----------------------------------------------------------------------------

    async def main(self) -> None:
        """Take items from the inbox until the run has ended; a fault of ours fails it."""
        try:
            await self._work_off()
        except Exception as error:
            log.exception("run %s has to stop", self._context.state.id)
            await self.fail(why_it_stopped(error))
        finally:
            await self._stop_everything()

    async def _work_off(self) -> None:
        state = self._context.state
        await self._presence.begin()
        self._recorder.begin()
        await self._settle()
        while not state.status.ended:
            item = await self._next_item()
            if item is not None:
                await self._carry_out(item)
            else:
                await self._go_on()

    async def _go_on(self) -> None:
        if not self._context.state.status.ended:
            await self._claims.expire()
            await self._settle()

    async def request(self, task: Task, *, patient: bool = False) -> object:
        """Have something done in turn, and wait for what comes of it.

        Raises what the task raises, `ConflictError` if the run has ended, and unless `patient`
        `JournalWriteError` while the journal cannot be written.
        """
        self._require_going()
        if self._context.trouble is not None and not patient:
            raise JournalWriteError(self._context.trouble)
        return await self._inbox.ask(task, patient=patient)

    def _require_going(self) -> None:
        if self.ended.is_set():
            raise ConflictError(f"the run has ended ({self._context.state.status})")

    async def _next_item(self) -> Item | None:
        waits = [self._claims.expire_in_s()]
        # What was due before has begun, or begins once an item says that it can.
        due = None if self._hardware.simulated else self._dialogues.next_due(self._settled_s)
        if self._context.state.status is RunStatus.RUNNING:
            dues = [due, None if self._hardware.simulated else self._people.next_due()]
            dues += [self._patience.silent_too_long_at(each) for each in self._proxies.values()]
            now = self._context.clock.now()
            waits += [max(0.0, each - now) for each in dues if each is not None]
        timeout_s = min((each for each in waits if each is not None), default=None)
        return await self._inbox.next(timeout_s)

    async def _carry_out(self, item: Item) -> None:
        try:
            self._context.patient = item.patient
            try:
                result = await item.task()
            finally:
                self._context.patient = True
            # Before anybody hears of it: a simulated robot that knows its report was taken lets
            # time pass, and what follows from the report is to reach it before that.
            await self._go_on()
            await self._context.noted()
            if item.task is not _nothing:
                self._hardware.tell_neighbours()
        except asyncio.CancelledError:
            # Whoever waits for it must not wait for ever when the service shuts down.
            item.fail(BusyError("the service is shutting down"))
            raise
        except Exception as error:
            item.fail(error)
            if not (item.asked_for and isinstance(error, REFUSALS)):
                raise
        else:
            item.succeed(result)

    async def _stop_everything(self) -> None:
        self.ended.set()
        self._presence.end()
        self._recorder.end()
        self._inbox.refuse_all(ConflictError(f"the run has ended ({self._context.state.status})"))
        if self._context.state.status.ended:
            for proxy in self._proxies.values():
                if proxy.doing is not RobotActivity.ABSENT:
                    proxy.retreat()
        await self._hardware.release()

    # --- The robots' reports (RobotSink) ------------------------------------------------------

    async def robot_connected(self, robot: str, hello: Hello) -> None:
        """A robot is there, for the first time or again."""
        self._inbox.tell(lambda: self._presence.connected(self._proxies[robot], hello))

    async def robot_reported(self, robot: str, report: Report, receipt: Receipt) -> None:
        """Take a report; returns when it and what follows from it are committed."""
        try:
            take = partial(self._reported, self._proxies[robot], report, receipt)
            await self.request(take, patient=True)
        except (BusyError, ConflictError):
            # A service that shuts down takes nothing more: the robot sends it again afterwards.
            if not self._context.state.status.ended:
                raise
            await self._context.commit([], receipt=receipt)

    def robot_posed(self, robot: str, poses: Poses) -> None:
        """Pass on where everything is; for display only, it changes nothing."""
        self._poses.take(robot, self._context.clock.from_robot(poses.time), poses)

    async def robot_lost(self, robot: str, reason: str) -> None:
        """A robot's connection is gone."""
        self.tell_lost(robot, reason)

    def tell_lost(self, robot: str, reason: str) -> None:
        """A robot's connection or process is gone."""
        self._inbox.tell(lambda: self._presence.lost(self._proxies[robot], reason))

    async def _reported(self, proxy: RobotProxy, report: Report, receipt: Receipt) -> None:
        if proxy.hello is None:
            # It has not come yet: what it still says of what it did before is nothing of this run.
            await self._context.commit([], receipt=receipt, world=report.world)
            return
        if receipt.boot != proxy.hello.boot:
            # An earlier boot's: what it did was put back when the robot came with its new one.
            await self._context.commit([], receipt=receipt)
            return
        self._context.clock.observe(report.time)
        proxy.silent_since = None
        proxy.driven = report.driven or proxy.driven
        body = report.body
        if isinstance(body, StepStarted):
            proxy.restarts = 0
        events, pictures = self._reports.read(proxy, body)
        if events or report.world is not None:
            await self._context.commit(
                events, receipt=receipt, world=report.world, pictures=pictures
            )
        else:
            self._context.note(receipt)
        await self._after_report(proxy, body)

    async def _after_report(self, proxy: RobotProxy, body: object) -> None:
        """What a report says about what the robot is busy with, once it is committed."""
        match body:
            case IssueDetected(interrupts=interrupts):
                self._recorder.fault(proxy.robot)
                if interrupts:
                    proxy.doing = RobotActivity.RETREATING
            case Holding():
                proxy.hold_execution(body)
            case Finished():
                proxy.finish()
            case Resumed():
                proxy.doing = RobotActivity.WORKING
            case Held(command=command) if command == proxy.command:
                proxy.doing = RobotActivity.IDLE
            case Rejected(for_good=True, reason=reason) if not proxy.gone_for_good:
                await self._presence.give_up(proxy, f"is of no more use: {reason}")
            case Rejected(command=command) if command == proxy.command:
                proxy.doing = RobotActivity.IDLE
            case Looked():
                purpose = proxy.take_look(body, self._context.clock.now())
                if purpose in JUDGING:
                    await self._results.judged(proxy, body)
                    await self._people.judged(proxy, body)
                if purpose is not None:
                    await self._done_already.judged(proxy)
                    await self._looked(proxy, purpose, bool(body.fulfilled))
            case Intervened():
                proxy.looked_at = None

    async def _looked(self, proxy: RobotProxy, purpose: Purpose, fulfilled: bool) -> None:
        if purpose is Purpose.LAST:
            self._allocation.looked_last(proxy.robot)
            return
        dialogue = self._dialogue_of(proxy)
        if dialogue is not None:
            await self._dialogues.looked(dialogue, proxy, purpose, fulfilled)

    # --- Doing what the state demands ---------------------------------------------------------

    def _dialogue_of(self, proxy: RobotProxy) -> DialogueState | None:
        dialogues = self._context.state.open_dialogues
        return next((each for each in dialogues if each.opened.robot == proxy.robot), None)

    async def _settle(self) -> None:
        changed = True
        while changed:
            settled_s = self._context.clock.now()
            changed = await self._settle_once()
        self._settled_s = settled_s

    @property
    def _halted(self) -> bool:
        """Whether nothing new is to begin, though the state says that the run goes on."""
        return self._aborting or self._context.trouble is not None

    async def _settle_once(self) -> bool:
        """Do one thing that the state demands; True if that changed the state."""
        state = self._context.state
        if state.status is not RunStatus.RUNNING or self._halted:
            return False
        if await self._people.expire():
            return True
        results = [*results_of(state), *self._people.results()]
        for proxy in self._proxies.values():
            proxy.finished = results
            asks = self._dialogue_of(proxy) is not None
            if await self._patience.gave_up_in_livelock(proxy, asks=asks):
                return True
            if await self._patience.gave_up_as_silent(proxy):
                return True
        for dialogue in state.open_dialogues:
            if await self._dialogues.drive(dialogue, self._proxies[dialogue.opened.robot]):
                return True
        if await self._giving_up.give_up_what_cannot_be_done():
            return True
        for proxy in self._proxies.values():
            available = (proxy.free or proxy.interruptible) and not proxy.gone_for_good
            if not available or self._dialogue_of(proxy) is not None:
                continue
            if await self._allocation.occupy(proxy):
                return True
        return False

    # --- What people ask for ------------------------------------------------------------------

    async def pause(self, author: ev.Author | None = None) -> None:
        """Stop everything where it is. Raises `ConflictError` unless running."""
        self._require(RunStatus.RUNNING, "pause")
        await self._context.commit([ev.RunPaused(**self._context.stamp(), author=author)])
        self._context.clock.pause()
        self._stop_robots()

    def _stop_robots(self) -> None:
        for proxy in self._proxies.values():
            if (
                proxy.doing is RobotActivity.WORKING
                or proxy.interruptible
                or proxy.doing is RobotActivity.LOOKING
            ):
                proxy.stop()

    async def resume(self, author: ev.Author | None = None) -> None:
        """Go on. Raises `ConflictError` unless paused."""
        self._require(RunStatus.PAUSED, "resume")
        self._context.clock.resume()
        self._allocation.look_anew()
        await self._context.commit([ev.RunResumed(**self._context.stamp(), author=author)])

    async def abort(self, reason: str = "", author: ev.Author | None = None) -> None:
        """End the run. Raises `ConflictError` if it has ended."""
        state = self._context.state
        if state.status.ended:
            raise ConflictError(f"the run has ended ({state.status})")
        # Its robots have gone on since they last reported.
        self._context.clock.catch_up()
        closings = [self._dialogues.abort(each) for each in state.open_dialogues]
        aborted = ev.RunAborted(**self._context.stamp(), reason=reason, author=author)
        await self._context.commit([*closings, aborted])

    async def abort_at_once(self, author: ev.Author | None = None) -> None:
        """End the run; while the journal cannot be written its robots stop, and it ends later.

        Raises `ConflictError` if it has ended.
        """
        self._require_going()
        aborted = self._inbox.ask(partial(self.abort, author=author), patient=True)
        troubled = asyncio.create_task(self._context.in_trouble())
        either: list[asyncio.Future[Any]] = [aborted, troubled]
        await asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED)
        troubled.cancel()
        if aborted.done():
            aborted.result()
            return
        aborted.add_done_callback(log_failure)
        self._aborting = True
        for proxy in self._proxies.values():
            if proxy.doing is not RobotActivity.ABSENT:
                proxy.retreat()

    def journal_troubled(self, reason: str | None) -> None:
        """The journal cannot be written any more (`reason`), or can be again.

        What follows from a robot's reports cannot be committed then, so it is to hold.
        """
        if reason is None:
            for proxy in self._proxies.values():
                # What it said meanwhile still waits to be taken.
                proxy.silent_since = None
            self._inbox.tell(_nothing)
            return
        self._inbox.refuse_impatient(JournalWriteError(reason))
        if not self._context.state.status.ended:
            self._stop_robots()

    async def fail(self, reason: str) -> None:
        """End the run because it cannot go on."""
        if not self._context.state.status.ended:
            await fail_run(self._context, reason)

    async def intervene(self, deed: Intervention, author: ev.Author | None = None) -> None:
        """Have a person do something in the simulated world."""
        proxy = next(iter(self._proxies.values()))
        await self._interventions.accept(deed, "api", proxy, author)

    def _require(self, status: RunStatus, what: str) -> None:
        now = self._context.state.status
        if now is not status:
            raise ConflictError(f"a run can be {what}d only while it is {status}; it is {now}")


async def _nothing() -> None:
    """What is done only so that the state is settled after it."""
