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
from uuid import uuid4

from mend.errors import ConflictError, RefusalError
from mend.robots.link.messages import (
    Finished,
    Held,
    Hello,
    Holding,
    Intervened,
    IssueDetected,
    Location,
    Looked,
    Poses,
    Rejected,
    Report,
    Resumed,
    StepStarted,
    WasDone,
)
from mend.server.errors import BusyError
from mend.server.journal import events as ev
from mend.server.journal.journal import DuplicateReceiptError, JournalWriteError, Receipt
from mend.server.runtime.choosing import choose
from mend.server.runtime.claims import Claims
from mend.server.runtime.context import RunContext
from mend.server.runtime.cutting_short import CuttingShort
from mend.server.runtime.dialogue_driver import DialogueDriver
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.failure import fail_run, why_it_stopped
from mend.server.runtime.giving_up import GivingUp
from mend.server.runtime.hardware import Hardware
from mend.server.runtime.inbox import Inbox, Item, Task, log_failure
from mend.server.runtime.interventions import Interventions
from mend.server.runtime.people import People
from mend.server.runtime.pose_sink import PoseSink
from mend.server.runtime.presence import RobotPresence
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.results import Results, missing_parts, results_of, unseen_parts
from mend.server.runtime.robot_proxy import JUDGING, Purpose, RobotActivity, RobotProxy
from mend.server.runtime.run_state import StartedExecution
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
        self._claims = Claims(context)
        self._interventions = Interventions(context)
        self._inbox = Inbox()
        self._presence = RobotPresence(
            context,
            proxies,
            hardware,
            dialogues,
            self._reports,
            self._interventions,
            poses,
            tell=self._inbox.tell,
            start=self._start,
        )
        cutting_short = CuttingShort(context, proxies, dialogues, self._reports)
        self._results = Results(context, self._reports, cutting_short)
        self._giving_up = GivingUp(context, proxies, self._reports, cutting_short)
        self.ended = asyncio.Event()
        self._aborting = False
        self._settled_s = -math.inf
        self._looked_last: set[str] = set()
        """The robots that have looked since the task was done."""

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
            dues = [*dues, *(self._silent_too_long_at(each) for each in self._proxies.values())]
            now = self._context.clock.now()
            waits += [max(0.0, each - now) for each in dues if each is not None]
        timeout_s = min((each for each in waits if each is not None), default=None)
        return await self._inbox.next(timeout_s)

    def _silent_too_long_at(self, proxy: RobotProxy) -> float | None:
        """When a robot has said nothing for too long of what it was told (the run's clock).

        A simulated one is watched by its process, and its world's clock stands still without it.
        """
        if self._hardware.simulated or not proxy.owes_a_report:
            return None
        if proxy.silent_since is None:
            proxy.silent_since = self._context.clock.now()
        return proxy.silent_since + self._context.settings.robot_silent_timeout_s

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
            case IssueDetected(interrupts=True):
                proxy.doing = RobotActivity.RETREATING
            case Holding():
                proxy.hold_execution(body)
            case Finished():
                proxy.finish()
            case Resumed():
                proxy.doing = RobotActivity.WORKING
            case Held(command=command) if command == proxy.command:
                proxy.doing = RobotActivity.IDLE
            case Rejected(command=command) if command == proxy.command:
                proxy.doing = RobotActivity.IDLE
            case Looked():
                purpose = proxy.take_look(body, self._context.clock.now())
                if purpose in JUDGING:
                    await self._results.judged(proxy, body)
                    await self._people.judged(proxy, body)
                if purpose is not None:
                    await self._looked(proxy, purpose, bool(body.fulfilled))
            case Intervened():
                proxy.looked_at = None

    async def _looked(self, proxy: RobotProxy, purpose: Purpose, fulfilled: bool) -> None:
        if purpose is Purpose.LAST:
            self._looked_last.add(proxy.robot)
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
            if await self._gave_up_in_livelock(proxy) or await self._gave_up_as_silent(proxy):
                return True
        for dialogue in state.open_dialogues:
            if await self._dialogues.drive(dialogue, self._proxies[dialogue.opened.robot]):
                return True
        if await self._giving_up.give_up_what_cannot_be_done():
            return True
        for proxy in self._proxies.values():
            available = (proxy.free or proxy.interruptible) and not proxy.gone_for_good
            if available and self._dialogue_of(proxy) is None and await self._occupy(proxy):
                return True
        return False

    async def _gave_up_in_livelock(self, proxy: RobotProxy) -> bool:
        """Give an idle robot up if nothing ever comes of what it is told; whether it did."""
        asks = self._dialogue_of(proxy) is not None
        proxy.livelock.see(
            self._context.state.progress, self._context.clock.now() if asks else None
        )
        idle = (proxy.free or proxy.interruptible) and not proxy.gone_for_good
        if not idle or not proxy.livelock.lasts:
            return False
        await self._presence.give_up_in_livelock(proxy)
        return True

    async def _gave_up_as_silent(self, proxy: RobotProxy) -> bool:
        """Give a robot up that says nothing of what it was told; whether it did.

        Of one that was given up before nobody waits any longer to hear that its arm rests.
        """
        due = self._silent_too_long_at(proxy)
        if due is None or self._context.clock.now() < due:
            return False
        if proxy.gone_for_good:
            proxy.doing = RobotActivity.IDLE
            return True
        timeout_s = self._context.settings.robot_silent_timeout_s
        await self._presence.give_up(
            proxy, f"is given up: for {timeout_s:g} s it has said nothing of what it was told"
        )
        return True

    async def _occupy(self, proxy: RobotProxy) -> bool:
        """Give an idle robot something to do; True if that changed the state."""
        state = self._context.state
        execution = state.executions.get(proxy.robot)
        if execution is not None:
            if execution.held and self._may_resume(proxy, execution):
                leaf = state.tree.leaf_definition(execution.leaf)
                proxy.resume(execution, self._team.expected_at(proxy, leaf))
            elif execution.held and not proxy.looked_just_now(self._context.clock.now()):
                proxy.look(Purpose.RESUME)
            return False
        if proxy.holds_execution:
            proxy.retreat()
            return False
        if state.tree.done(0):
            return not state.executions and await self._look_last(proxy)
        self._looked_last.clear()
        return await self._start_something(proxy)

    def _may_resume(self, proxy: RobotProxy, execution: StartedExecution) -> bool:
        """Whether it has just looked, and has the space or can have it."""
        if not proxy.looked_just_now(self._context.clock.now()):
            return False
        leaf = self._context.state.tree.leaf_definition(execution.leaf)
        if not self._team.may_begin(proxy, leaf):
            return False
        self._team.take(proxy, leaf)
        return True

    async def _start_something(self, proxy: RobotProxy) -> bool:
        state = self._context.state
        choice = choose(state, proxy)
        if choice is None:
            if proxy.area is not None:
                # Nothing that it could do is free: it is not to be in the way of others meanwhile.
                proxy.retreat()
            else:
                self._people.watch(proxy)
            return False
        if not proxy.looked_just_now(self._context.clock.now()):
            proxy.look(Purpose.CHOOSE)
            return False
        assert proxy.hello is not None, "a free robot has said hello"
        execution = StartedExecution(uuid4(), choice.leaf, proxy.robot, proxy.hello.boot)
        started = ev.NodeStarted(
            **self._context.stamp(),
            **self._reports.node(choice.leaf),
            robot=proxy.robot,
            boot=proxy.hello.boot,
            execution=execution.id,
            attempt=state.tree.attempts(choice.leaf) + 1,
            candidates=choice.candidates,
        )
        said = state.to_leave_out.get(choice.leaf)
        if said is not None:
            stamp = {**self._context.stamp(), "seq": 0, "robot": proxy.robot}
            await self._context.commit([started, said.model_copy(update=stamp)])
            return True
        await self._context.commit([started])
        self._start(proxy, execution)
        return True

    def _start(self, proxy: RobotProxy, execution: StartedExecution) -> None:
        state = self._context.state
        taken_back = state.taken_back.get(execution.leaf)
        was_done: WasDone | None = None
        if taken_back is not None:
            gone = taken_back.because_of is None and not taken_back.unseen
            was_done = "gone" if gone else "there"
        tree, scene = state.tree, state.scene
        self._team.take(proxy, tree.leaf_definition(execution.leaf))
        part = scene.objects.get(tree.leaf_definition(execution.leaf).object or "")
        place = scene.places.get(tree.leaf_definition(execution.leaf).place or "")
        proxy.start(
            execution,
            node=tree.path_of(execution.leaf),
            behavior=tree.leaf_definition(execution.leaf).behavior,
            parameters=dict(tree.leaf_definition(execution.leaf).parameters),
            size=part.size if part else None,
            target=Location(**place.pose.model_dump()) if place else None,
            was_done=was_done,
            finished=[
                each for each, leaf in results_of(state).items() if leaf not in state.left_out
            ],
            object_at=self._team.expected_at(proxy, tree.leaf_definition(execution.leaf)),
        )

    # --- The end ------------------------------------------------------------------------------

    async def _look_last(self, proxy: RobotProxy) -> bool:
        """Have every robot look that can, each at what it sees; True if that changed the state."""
        if proxy.robot not in self._looked_last:
            proxy.look(Purpose.LAST)
            return False
        looking = (each.doing is RobotActivity.LOOKING for each in self._proxies.values())
        if any(looking):
            return False
        await self._finish(proxy)
        return True

    async def _finish(self, proxy: RobotProxy) -> None:
        """End the run, unless of those who looked nobody has seen the table."""
        state = self._context.state
        looked = [each for each in self._proxies.values() if each.robot in self._looked_last]
        if proxy.blind is not None and all(each.blind is not None for each in looked):
            await self._results.doubt_last(proxy, proxy.blind)
        if not state.tree.done(0):
            return
        there = {each for other in self._proxies.values() for each in other.there}
        missing, unseen = missing_parts(state), unseen_parts(state, there)
        finished = ev.RunFinished(**self._context.stamp(), missing=missing, unseen=unseen)
        await self._context.commit([finished])

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
        # Who knows what was done meanwhile.
        self._looked_last.clear()
        await self._context.commit([ev.RunResumed(**self._context.stamp(), author=author)])

    async def abort(self, reason: str = "", author: ev.Author | None = None) -> None:
        """End the run. Raises `ConflictError` if it has ended."""
        state = self._context.state
        if state.status.ended:
            raise ConflictError(f"the run has ended ({state.status})")
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
