"""A run: one actor that takes reports, answers and requests in turn, and acts on the state.

Everything goes through its inbox, one item at a time: what follows from an item is committed to
the journal first, folded into the state, and only then acted upon. After each item `_settle` does
whatever the state demands, so that a run that is taken up after a crash goes on by itself.
"""

import asyncio
import logging
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import Protocol
from uuid import uuid4

from robots.link.messages import (
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
)
from server.errors import ConflictError, ServiceError
from server.journal import events as ev
from server.journal.journal import DuplicateReceiptError, Receipt
from server.runtime.choosing import choose
from server.runtime.claims import Claims
from server.runtime.context import RunContext
from server.runtime.dialogue_driver import DialogueDriver
from server.runtime.failure import fail_run, why_it_stopped
from server.runtime.last_look import missing_parts
from server.runtime.report_events import ReportEvents
from server.runtime.robot_side import Doing, Purpose, RobotSide
from server.runtime.run_state import DialogueState, Execution
from server.runtime.views import RunStatus

log = logging.getLogger(__name__)

Task = Callable[[], Awaitable[object]]

REFUSALS = (ServiceError, DuplicateReceiptError)
"""What a request or a report may be answered with; anything else is a fault of ours."""


class Hardware(Protocol):
    """What stands behind a run's robots: simulated worlds that can be started again, or nothing."""

    @property
    def simulated(self) -> bool: ...

    async def restart(self, robot: str) -> None:
        """Start a simulated robot (again), with its world as the journal has it."""
        ...

    async def release(self) -> None:
        """The run has ended: stop simulated robots, let go of real ones."""
        ...


class PoseSink(Protocol):
    """Takes what robots show, for people who watch."""

    def robot_connected(self, hello: Hello) -> None: ...

    def take(self, robot: str, time_s: float, poses: Poses) -> None:
        """`time_s` is of the run's clock."""
        ...


@dataclass(slots=True)
class _Item:
    """`asked_for`: somebody waits for what comes of it, and is told if it is refused."""

    task: Task
    asked_for: bool
    done: asyncio.Future[object] = field(default_factory=asyncio.Future)


class Run:
    """One running run; implements `server.robots.registry.RobotSink`."""

    def __init__(
        self,
        context: RunContext,
        sides: dict[str, RobotSide],
        dialogues: DialogueDriver,
        hardware: Hardware,
        poses: PoseSink,
    ) -> None:
        self._context = context
        self._sides = sides
        self._dialogues = dialogues
        self._hardware = hardware
        self._poses = poses
        self._reports = ReportEvents(context, dialogues)
        self._claims = Claims(context)
        self._inbox: asyncio.Queue[_Item] = asyncio.Queue()
        self._timers: dict[str, asyncio.TimerHandle] = {}
        self.ended = asyncio.Event()

    @property
    def context(self) -> RunContext:
        return self._context

    @property
    def sides(self) -> dict[str, RobotSide]:
        return self._sides

    @property
    def dialogues(self) -> DialogueDriver:
        return self._dialogues

    @property
    def claims(self) -> Claims:
        return self._claims

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
        for side in self._sides.values():
            if self._hardware.simulated:
                await self._hardware.restart(side.robot)
            else:
                self._wait_for(side)
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

    async def request(self, task: Task) -> object:
        """Have something done in turn, and wait for what comes of it.

        Raises what the task raises, and `ConflictError` if the run has ended.
        """
        if self.ended.is_set():
            raise ConflictError(f"the run has ended ({self._context.state.status})")
        item = _Item(task, asked_for=True)
        self._inbox.put_nowait(item)
        return await item.done

    async def _next_item(self) -> _Item | None:
        waits = [self._claims.expire_in_s()]
        due = None if self._hardware.simulated else self._dialogues.next_due()
        if due is not None and self._context.state.status is RunStatus.RUNNING:
            waits.append(max(0.0, due - self._context.clock.now()))
        timeout_s = min((each for each in waits if each is not None), default=None)
        try:
            return await asyncio.wait_for(self._inbox.get(), timeout_s)
        except TimeoutError:
            return None

    async def _carry_out(self, item: _Item) -> None:
        try:
            result = await item.task()
            # Before anybody hears of it: a simulated robot that knows its report was taken lets
            # time pass, and what follows from the report is to reach it before that.
            await self._go_on()
        except asyncio.CancelledError:
            # Whoever waits for it must not wait for ever when the service shuts down.
            if not item.done.done():
                item.done.set_exception(ConflictError("the service is shutting down"))
            raise
        except Exception as error:
            if not item.done.cancelled():
                item.done.set_exception(error)
            if not (item.asked_for and isinstance(error, REFUSALS)):
                raise
        else:
            if not item.done.cancelled():
                item.done.set_result(result)

    async def _stop_everything(self) -> None:
        self.ended.set()
        for timer in self._timers.values():
            timer.cancel()
        while not self._inbox.empty():
            item = self._inbox.get_nowait()
            if not item.done.done():
                item.done.set_exception(
                    ConflictError(f"the run has ended ({self._context.state.status})")
                )
        if self._context.state.status.ended:
            for side in self._sides.values():
                if side.doing is not Doing.ABSENT:
                    side.retreat()
        await self._hardware.release()

    # --- The robots' reports (RobotSink) ------------------------------------------------------

    async def robot_connected(self, robot: str, hello: Hello) -> None:
        """A robot is there, for the first time or again."""
        self._put(lambda: self._connected(self._sides[robot], hello))

    async def robot_reported(self, robot: str, report: Report, receipt: Receipt) -> None:
        """Take a report; returns when it and what follows from it are committed."""
        try:
            await self.request(lambda: self._reported(self._sides[robot], report, receipt))
        except ConflictError:
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
        self._put(lambda: self._lost(self._sides[robot], reason))

    def _put(self, task: Task) -> None:
        item = _Item(task, asked_for=False)
        item.done.add_done_callback(_log_failure)
        self._inbox.put_nowait(item)

    async def _connected(self, side: RobotSide, hello: Hello) -> None:
        state, robot = self._context.state, side.robot
        if timer := self._timers.pop(robot, None):
            timer.cancel()
        rebooted = side.hello is None or side.hello.boot != hello.boot
        if rebooted:
            self._context.clock.align(hello.time)
            self._dialogues.robot_rebooted()
        was_doing = side.doing
        side.connect(hello)
        self._poses.robot_connected(hello)
        execution = state.executions.get(robot)
        continues = execution is not None and execution.boot == hello.boot
        events: list[ev.Event] = []
        if robot in state.lost:
            events.append(
                ev.RobotBack(
                    **self._context.stamp(), robot=robot, boot=hello.boot, continues=continues
                )
            )
        if execution is not None and not continues and state.dialogue_of(execution.leaf) is None:
            events.append(
                self._reports.reset(execution.leaf, robot, "its robot was lost", failed=False)
            )
        await self._context.commit(events)
        if continues and execution is not None and side.doing is Doing.IDLE and not execution.held:
            # The start may never have arrived; a robot that carried it out ignores it.
            self._start(side, execution)
        elif continues and not rebooted and was_doing is Doing.RETREATING:
            side.doing = Doing.RETREATING

    async def _lost(self, side: RobotSide, reason: str) -> None:
        state, robot = self._context.state, side.robot
        side.disconnect()
        if robot not in state.lost:
            await self._context.commit(
                [ev.RobotLost(**self._context.stamp(), robot=robot, reason=reason)]
            )
        side.restarts += 1
        if self._hardware.simulated and side.restarts <= self._context.settings.max_restarts:
            await self._hardware.restart(robot)
        elif self._hardware.simulated:
            await self._given_up(side, f"its process keeps ending: {reason}")
        else:
            self._wait_for(side)

    def _wait_for(self, side: RobotSide) -> None:
        """Give a lost robot some time to come back (wall time: it is not the world that waits)."""
        timeout_s = self._context.settings.robot_lost_timeout_s
        reason = f"it was not there for {timeout_s:g} s"
        self._timers[side.robot] = asyncio.get_running_loop().call_later(
            timeout_s, lambda: self._put(lambda: self._given_up(side, reason))
        )

    async def _given_up(self, side: RobotSide, reason: str) -> None:
        if side.doing is not Doing.ABSENT:
            return
        side.gone_for_good = True
        state = self._context.state
        execution = state.executions.get(side.robot)
        events: list[ev.Event] = []
        if execution is not None:
            if dialogue := state.dialogue_of(execution.leaf):
                events.append(self._dialogues.abort(dialogue))
            events.append(
                self._reports.reset(
                    execution.leaf, side.robot, f"its robot is lost: {reason}", failed=False
                )
            )
        await self._context.commit(events)
        if all(each.gone_for_good for each in self._sides.values()):
            await fail_run(self._context, f"the robot '{side.robot}' is lost: {reason}")

    async def _reported(self, side: RobotSide, report: Report, receipt: Receipt) -> None:
        if side.hello is not None and receipt.boot != side.hello.boot:
            # An earlier boot's: what it did was put back when the robot came with its new one.
            await self._context.commit([], receipt=receipt)
            return
        self._context.clock.observe(report.time)
        body = report.body
        if isinstance(body, StepStarted):
            side.restarts = 0
        events, pictures = self._reports.read(side, body)
        await self._context.commit(events, receipt=receipt, world=report.world, pictures=pictures)
        await self._after_report(side, body)

    async def _after_report(self, side: RobotSide, body: object) -> None:
        """What a report says about what the robot is busy with, once it is committed."""
        match body:
            case IssueDetected(interrupts=True):
                side.doing = Doing.RETREATING
            case Holding():
                side.hold_execution(body)
            case Finished():
                side.doing = Doing.IDLE
            case Resumed():
                side.doing = Doing.WORKING
            case Held(command=command) if command == side.command:
                side.doing = Doing.IDLE
            case Rejected(command=command) if command == side.command:
                side.doing = Doing.IDLE
            case Looked():
                purpose = side.take_look(body, self._context.clock.now())
                if purpose is not None:
                    await self._looked(side, purpose, bool(body.fulfilled))
            case Intervened():
                side.looked_at = None

    async def _looked(self, side: RobotSide, purpose: Purpose, fulfilled: bool) -> None:
        if purpose is Purpose.LAST:
            await self._finish(side)
            return
        dialogue = self._dialogue_of(side)
        if dialogue is not None:
            await self._dialogues.looked(dialogue, side, purpose, fulfilled)

    # --- Doing what the state demands ---------------------------------------------------------

    def _dialogue_of(self, side: RobotSide) -> DialogueState | None:
        dialogues = self._context.state.open_dialogues
        return next((each for each in dialogues if each.opened.robot == side.robot), None)

    async def _settle(self) -> None:
        while await self._settle_once():
            pass

    async def _settle_once(self) -> bool:
        """Do one thing that the state demands; True if that changed the state."""
        state = self._context.state
        if state.status is not RunStatus.RUNNING:
            return False
        for dialogue in state.open_dialogues:
            if await self._dialogues.drive(dialogue, self._sides[dialogue.opened.robot]):
                return True
        if await self._give_up_what_cannot_be_done():
            return True
        for side in self._sides.values():
            available = side.free or side.interruptible
            if available and self._dialogue_of(side) is None and await self._occupy(side):
                return True
        return False

    async def _occupy(self, side: RobotSide) -> bool:
        """Give an idle robot something to do; True if that changed the state."""
        state = self._context.state
        execution = state.executions.get(side.robot)
        if execution is not None:
            if execution.held:
                side.resume(execution)
            return False
        if side.holds_execution:
            side.retreat()
            return False
        if state.tree.done(0):
            if not state.executions:
                side.look(Purpose.LAST)
            return False
        return await self._start_something(side)

    async def _start_something(self, side: RobotSide) -> bool:
        state = self._context.state
        choice = choose(state, side)
        if choice is None:
            return False
        fresh = side.looked_at is not None and self._context.clock.now() - side.looked_at <= 1.0
        if not fresh:
            side.look(Purpose.CHOOSE)
            return False
        assert side.hello is not None, "a free robot has said hello"
        execution = Execution(uuid4(), choice.leaf, side.robot, side.hello.boot)
        await self._context.commit(
            [
                ev.NodeStarted(
                    **self._context.stamp(),
                    **self._reports.node(choice.leaf),
                    robot=side.robot,
                    boot=side.hello.boot,
                    execution=execution.id,
                    attempt=state.tree.attempts(choice.leaf) + 1,
                    candidates=choice.candidates,
                )
            ]
        )
        self._start(side, execution)
        return True

    def _start(self, side: RobotSide, execution: Execution) -> None:
        state = self._context.state
        tree, scene = state.tree, state.scene
        part = scene.objects.get(tree.leaf_definition(execution.leaf).object or "")
        place = scene.places.get(tree.leaf_definition(execution.leaf).place or "")
        side.start(
            execution,
            node=tree.path_of(execution.leaf),
            behavior=tree.leaf_definition(execution.leaf).behavior,
            parameters=dict(tree.leaf_definition(execution.leaf).parameters),
            size=part.size if part else None,
            target=Location(**place.pose.model_dump()) if place else None,
        )

    async def _give_up_what_cannot_be_done(self) -> bool:
        state = self._context.state
        tree = state.tree
        hopeless = sorted(each for each in state.exhausted if tree.eligible(each))
        reason = f"it failed {state.request.max_attempts} times"
        if not hopeless and all(
            side.hello is not None or side.gone_for_good for side in self._sides.values()
        ):
            hopeless = [
                leaf
                for leaf in (int(each) for each in tree.eligible_leaves())
                if not any(
                    side.suitability(tree.leaf_definition(leaf).behavior) > 0
                    for side in self._sides.values()
                )
            ][:1]
            reason = "no robot can do it"
        if not hopeless:
            return False
        await self._give_up(hopeless[0], reason)
        return True

    async def _give_up(self, leaf: int, reason: str) -> None:
        """Abandon the nearest alternative that holds a leaf, or fail the run."""
        state = self._context.state
        given_up = state.tree.give_up(leaf)
        if given_up is None:
            name = state.tree.name_of(leaf)
            reason = f"'{name}' could not be done: {reason}"
            await fail_run(self._context, reason, state.tree.path_of(leaf))
            return
        events: list[ev.Event] = []
        cut_short: list[RobotSide] = []
        for active in given_up.put_back:
            owner = state.tree.owner(active) or ""
            if dialogue := state.dialogue_of(active):
                events.append(self._dialogues.abort(dialogue))
            events.append(
                self._reports.reset(active, owner, "its alternative was abandoned", failed=False)
            )
            cut_short.append(self._sides[owner])
        events.append(
            ev.NodeAbandoned(
                **self._context.stamp(),
                **self._reports.node(given_up.alternative),
                leaf=state.tree.path_of(leaf),
                reason=reason,
            )
        )
        await self._context.commit(events)
        for side in cut_short:
            if side.doing is not Doing.ABSENT:
                side.retreat()

    # --- The end ------------------------------------------------------------------------------

    async def _finish(self, side: RobotSide) -> None:
        missing = missing_parts(self._context.state, side.seen)
        await self._context.commit([ev.RunFinished(**self._context.stamp(), missing=missing)])

    # --- What people ask for ------------------------------------------------------------------

    async def pause(self) -> None:
        """Stop everything where it is. Raises `ConflictError` unless running."""
        self._require(RunStatus.RUNNING, "pause")
        await self._context.commit([ev.RunPaused(**self._context.stamp())])
        self._context.clock.pause()
        for side in self._sides.values():
            if side.doing is Doing.WORKING or side.interruptible or side.doing is Doing.LOOKING:
                side.stop()

    async def resume(self) -> None:
        """Go on. Raises `ConflictError` unless paused."""
        self._require(RunStatus.PAUSED, "resume")
        self._context.clock.resume()
        await self._context.commit([ev.RunResumed(**self._context.stamp())])

    async def abort(self, reason: str = "") -> None:
        """End the run. Raises `ConflictError` if it has ended."""
        state = self._context.state
        if state.status.ended:
            raise ConflictError(f"the run has ended ({state.status})")
        closings = [self._dialogues.abort(each) for each in state.open_dialogues]
        aborted = ev.RunAborted(**self._context.stamp(), reason=reason)
        await self._context.commit([*closings, aborted])

    async def fail(self, reason: str) -> None:
        """End the run because it cannot go on."""
        if not self._context.state.status.ended:
            await fail_run(self._context, reason)

    def _require(self, status: RunStatus, what: str) -> None:
        now = self._context.state.status
        if now is not status:
            raise ConflictError(f"a run can be {what}d only while it is {status}; it is {now}")


def _log_failure(done: asyncio.Future[object]) -> None:
    error = None if done.cancelled() else done.exception()
    if error is not None and not isinstance(error, ConflictError):
        log.error("a run could not take a robot's news", exc_info=error)
