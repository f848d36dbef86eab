"""Which of a run's robots are there: connected, lost, waited for, and at last given up."""

import asyncio
import logging
from collections.abc import Callable, Mapping

from mend.robots.link.messages import Hello
from mend.server.journal import events as ev
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_driver import DialogueDriver
from mend.server.runtime.failure import fail_run
from mend.server.runtime.hardware import Hardware
from mend.server.runtime.inbox import Task
from mend.server.runtime.interventions import Interventions
from mend.server.runtime.livelock import MOST_FRUITLESS_COMMANDS
from mend.server.runtime.pose_sink import PoseSink
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.robot_proxy import RobotActivity, RobotProxy
from mend.server.runtime.run_state import StartedExecution

log = logging.getLogger(__name__)

MAX_RESTARTS = 20
"""So often a simulated robot is started again without having begun a step since."""


class RobotPresence:
    """The presence of one run's robots.

    `tell` has something done in the run's turn; `start` sends an execution's start again.
    """

    def __init__(
        self,
        context: RunContext,
        proxies: Mapping[str, RobotProxy],
        hardware: Hardware,
        dialogues: DialogueDriver,
        reports: ReportEvents,
        interventions: Interventions,
        poses: PoseSink,
        *,
        tell: Callable[[Task], None],
        start: Callable[[RobotProxy, StartedExecution], None],
    ) -> None:
        self._context = context
        self._proxies = proxies
        self._hardware = hardware
        self._dialogues = dialogues
        self._reports = reports
        self._interventions = interventions
        self._poses = poses
        self._tell = tell
        self._start = start
        self._timers: dict[str, asyncio.TimerHandle] = {}

    async def begin(self) -> None:
        """Start simulated robots, wait for real ones."""
        for proxy in self._proxies.values():
            if self._hardware.simulated:
                await self._hardware.begin(proxy.robot)
            else:
                self._wait_for(proxy)

    def end(self) -> None:
        """Wait for nobody any more."""
        for timer in self._timers.values():
            timer.cancel()

    async def connected(self, proxy: RobotProxy, hello: Hello) -> None:
        if proxy.gone_for_good:
            await self._send_away(proxy, hello)
            return
        state, robot = self._context.state, proxy.robot
        if timer := self._timers.pop(robot, None):
            timer.cancel()
        rebooted = proxy.hello is None or proxy.hello.boot != hello.boot
        if rebooted:
            # Robots of one world have one clock, which went on once the first of them was there.
            if all(each.doing is RobotActivity.ABSENT for each in self._proxies.values()):
                self._context.clock.align(hello.time)
            self._dialogues.robot_rebooted()
        was_doing = proxy.doing
        proxy.connect(hello)
        self._hardware.came(proxy)
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
        if continues and execution is not None and proxy.team is not None:
            proxy.team.take_up_again(proxy, state.tree.leaf_definition(execution.leaf))
        dialogue = None if execution is None else state.dialogue_of(execution.leaf)
        waits = dialogue is not None and dialogue.raised.interrupts
        if execution is not None and not continues and not waits:
            if dialogue is not None:
                events.append(self._dialogues.abort(dialogue))
            events.append(
                self._reports.reset(execution.leaf, robot, "its robot was lost", failed=False)
            )
        await self._context.commit(events)
        if rebooted:
            self._interventions.tell_again(proxy)
        if (
            continues
            and execution is not None
            and proxy.doing is RobotActivity.IDLE
            and not execution.held
        ):
            await self._start_again(proxy, execution)
        elif continues and not rebooted and was_doing is RobotActivity.RETREATING:
            proxy.doing = RobotActivity.RETREATING

    async def _start_again(self, proxy: RobotProxy, execution: StartedExecution) -> None:
        """The start may never have arrived; a robot that carried it out ignores it."""
        if proxy.livelock.lasts:
            await self.give_up_in_livelock(proxy)
        else:
            self._start(proxy, execution)

    async def _send_away(self, proxy: RobotProxy, hello: Hello) -> None:
        """Have a robot that was given up let go of what it may still hold or do for the run."""
        proxy.connect(hello)
        if hello.executing is not None:
            proxy.retreat()

    async def lost(self, proxy: RobotProxy, reason: str) -> None:
        state, robot = self._context.state, proxy.robot
        proxy.disconnect()
        if proxy.gone_for_good:
            return
        if robot not in state.lost:
            await self._context.commit(
                [ev.RobotLost(**self._context.stamp(), robot=robot, reason=reason)]
            )
        proxy.restarts += 1
        if self._hardware.simulated and proxy.restarts <= MAX_RESTARTS:
            await self._hardware.restart(robot)
        elif self._hardware.simulated:
            await self._stay_lost(proxy, f"its process keeps ending: {reason}")
        else:
            self._wait_for(proxy)

    def _wait_for(self, proxy: RobotProxy) -> None:
        """Give a lost robot some time to come back (wall time: it is not the world that waits)."""
        timeout_s = self._context.settings.robot_lost_timeout_s
        reason = f"it was not there for {timeout_s:g} s"
        self._timers[proxy.robot] = asyncio.get_running_loop().call_later(
            timeout_s, lambda: self._tell(lambda: self._stay_lost(proxy, reason))
        )

    async def _stay_lost(self, proxy: RobotProxy, reason: str) -> None:
        if proxy.doing is RobotActivity.ABSENT:
            await self._give_up(proxy, f"is lost: {reason}")

    async def give_up_in_livelock(self, proxy: RobotProxy) -> None:
        """Have no more to do with a robot that is told one thing after the other for nothing."""
        log.warning("robot %s is given up: nothing comes of what it is told", proxy.robot)
        self._context.refusals.note("fruitless_commands")
        await self.give_up(
            proxy,
            f"is given up: it was told {MOST_FRUITLESS_COMMANDS} things one after the other, and "
            "nothing was done and nobody answered meanwhile",
        )

    async def give_up(self, proxy: RobotProxy, why: str) -> None:
        """Have no more to do with a robot that is there; it is to let go."""
        proxy.retreat()
        await self._give_up(proxy, why)

    async def _give_up(self, proxy: RobotProxy, why: str) -> None:
        proxy.gone_for_good = True
        state = self._context.state
        execution = state.executions.get(proxy.robot)
        events: list[ev.Event] = []
        if proxy.robot not in state.lost:
            events.append(ev.RobotLost(**self._context.stamp(), robot=proxy.robot, reason=why))
        if execution is not None:
            if dialogue := state.dialogue_of(execution.leaf):
                events.append(self._dialogues.abort(dialogue))
            events.append(
                self._reports.reset(execution.leaf, proxy.robot, f"its robot {why}", failed=False)
            )
        await self._context.commit(events)
        if all(each.gone_for_good for each in self._proxies.values()):
            await fail_run(self._context, f"the robot '{proxy.robot}' {why}")
