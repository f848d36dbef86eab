"""A robot link without robots: every command is carried out at once, faults come as scripted."""

import asyncio
import base64
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from mend.robots.link.messages import (
    ClipPicture,
    ClipTaken,
    CommandBody,
    Detection,
    Finished,
    FinishedResult,
    Held,
    Hello,
    Hold,
    Holding,
    Interrupt,
    Intervene,
    Intervened,
    IssueDetected,
    Look,
    Looked,
    Position,
    ReachLimits,
    Report,
    ReportBody,
    Resume,
    Resumed,
    RoomLimits,
    Sighting,
    Start,
    StepStarted,
)
from mend.server.camera_picture import CameraPicture
from mend.server.journal.journal import Receipt
from mend.server.runtime.dialogue_looks import HELP_TAKES_S, TAKING_S, WATCH_PERIOD_S
from mend.tasks.intervention import Act

FIRST_JPEG, SECOND_JPEG = b"\xff\xd8\xff first \xff\xd9", b"\xff\xd8\xff second \xff\xd9"

PARTS = {f"part_{number}": 0.01 * number for number in range(100)}
"""What may be on the table, with its y."""

RELEASES = 7
"""The step in which it lets go."""


class Sink(Protocol):
    async def robot_connected(self, robot: str, hello: Hello) -> None: ...
    async def robot_reported(self, robot: str, report: Report, receipt: Receipt) -> None: ...
    async def robot_lost(self, robot: str, reason: str) -> None: ...


@dataclass
class PretendRobot:
    """One robot: `faults` maps an object to the issues that its next starts run into, in turn.

    A stubborn one runs into them also when it goes on after a hold.
    `patient`: it lets no time pass while a question is open, as live helpers take their time.
    `films`: two pictures follow every issue, and one comes with what it does not see. What it
    misses, drops or looks for in vain is gone until somebody brings it, and something is in its way
    from when it is blocked until somebody clears it. `felt`: its issues were felt; no camera sees
    anything in its way then.
    `thefts`: whenever one object has been placed, another one (or itself) that was placed is
    stolen, so often; with `in_reach` it is only elsewhere on the table then. `hidden_at_place`:
    what no look can judge. `returns`: once such an object is placed, all that was stolen is back at
    its place. `slow`: it is still at its first start until it is interrupted. `wrong`: what it
    believes to have missed or dropped stands within its reach all the time, and it says of that
    whether it was `brought` there. `held` is between its
    fingers all the time. Once `blinded_by` is placed its head camera is covered, until somebody
    clears its view. `table`: what is on it, with its y.
    """

    name: str
    faults: dict[str, list[tuple[str, int]]] = field(default_factory=dict)
    behaviors: tuple[str, ...] = ("pick_and_place",)
    room: RoomLimits | None = None
    boot: int = 1
    time: float = 0.0
    seq: int = 0
    interrupting: tuple[str, ...] = (
        "missed",
        "dropped",
        "unreachable",
        "missing",
        "blocked",
        "undone",
        "blind",
    )
    commands: list[CommandBody] = field(default_factory=list)
    right: set[str] = field(default_factory=set)
    hidden: set[str] = field(default_factory=set)
    lost: set[str] = field(default_factory=set)
    placed: set[str] = field(default_factory=set)
    obstructed: bool = False
    felt: bool = False
    wrong: bool = False
    brought: bool | None = False
    deaf: bool = False
    stubborn: bool = False
    patient: bool = False
    films: bool = False
    thefts: dict[str, list[str]] = field(default_factory=dict)
    stolen: set[str] = field(default_factory=set)
    finished: set[str] = field(default_factory=set)
    hidden_at_place: set[str] = field(default_factory=set)
    returns: set[str] = field(default_factory=set)
    in_reach: bool = False
    slow: bool = False
    held: str | None = None
    blinded_by: str | None = None
    blind: bool = False
    table: Mapping[str, float] = field(default_factory=lambda: PARTS)

    def hello(self) -> Hello:
        return Hello(
            protocol=1,
            robot=self.name,
            boot=str(self.boot),
            behaviors=list(self.behaviors),
            cameras=["head"],
            reach=ReachLimits(x=0, y=0, min_m=0, max_m=1),
            time=self.time,
            simulated=True,
            room=self.room,
        )


class PretendRobots:
    """Implements `mend.server.runtime.runtime.Robots` for pretend robots."""

    def __init__(self) -> None:
        self.robots: dict[str, PretendRobot] = {}
        self.make: Callable[[str], PretendRobot] = PretendRobot
        self._sinks: dict[str, Sink] = {}
        self._queues: dict[str, deque[tuple[str, CommandBody]]] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._wake: dict[str, asyncio.Event] = {}
        self._starts: dict[str, Start] = {}

    def assign(self, robot: str, sink: Sink) -> None:
        self.robots.setdefault(robot, self.make(robot))
        self._sinks[robot] = sink
        self._queues[robot] = deque()
        self._wake[robot] = asyncio.Event()
        task = asyncio.get_running_loop().create_task(self._live(robot))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def unassign(self, robot: str) -> None:
        self._sinks.pop(robot, None)
        if robot in self._wake:
            self._wake[robot].set()

    def send(
        self,
        robot: str,
        command_id: str,
        body: CommandBody,
        *,
        renews: bool = True,  # noqa: ARG002
    ) -> None:
        if robot in self._sinks:
            self.robots[robot].commands.append(body)
            self._queues[robot].append((command_id, body))
            self._wake[robot].set()

    async def take_picture(self, robot: str, camera: str, timeout_s: float = 2.0) -> CameraPicture:  # noqa: ARG002
        return CameraPicture(b"\xff\xd8picture")

    def has_time(self, robot: str) -> bool:
        return robot in self.robots

    def hello(self, robot: str) -> Hello | None:
        return self.robots[robot].hello() if robot in self.robots else None

    def connected(self, robot: str) -> bool:
        return robot in self.robots

    def known(self) -> list[str]:
        return list(self.robots)

    async def _live(self, name: str) -> None:
        robot = self.robots[name]
        await self._sinks[name].robot_connected(name, robot.hello())
        while name in self._sinks:
            await self._wake[name].wait()
            self._wake[name].clear()
            while self._queues[name] and name in self._sinks:
                await self._carry_out(robot, *self._queues[name].popleft())

    async def report(self, robot: PretendRobot, body: ReportBody) -> None:
        robot.seq += 1
        report = Report(seq=robot.seq, time=robot.time, body=body, world={"time": robot.time})
        receipt = Receipt(robot.name, str(robot.boot), robot.seq)
        if (sink := self._sinks.get(robot.name)) is not None:
            await sink.robot_reported(robot.name, report, receipt)

    async def _carry_out(self, robot: PretendRobot, command: str, body: CommandBody) -> None:
        if robot.deaf:
            return
        match body:
            case Start():
                self._starts[robot.name] = body
                if not robot.slow:
                    await self._work(robot, body)
            case Look():
                await self._look(robot, command, body)
            case Hold(until=until) if robot.patient and not _for_help(until - robot.time):
                return
            case Hold(until=until):
                robot.time = max(robot.time, until)
                await self.report(robot, Held(command=command))
            case Interrupt(retreat=retreat):
                robot.slow = False
                at = "neutral" if retreat else "in_place"
                await self.report(robot, Holding.model_validate({"execution": None, "at": at}))
            case Resume(execution=execution):
                await self.report(robot, Resumed(execution=execution, step=5))
                await self._work(robot, self._starts[robot.name], resumed=True)
            case Intervene(intervention=deed, by=by):
                if deed.act in (Act.PLACE, Act.PUT_BACK, Act.HAND_OVER):
                    robot.right.add(deed.object or "")
                    robot.lost.discard(deed.object or "")
                if deed.act is Act.PLACE:
                    robot.placed.add(deed.object or "")
                    robot.stolen.discard(deed.object or "")
                if deed.act is Act.RELEASE:
                    robot.obstructed = False
                if deed.act is Act.UNCOVER:
                    robot.blind = False
                await self.report(robot, Intervened(intervention=deed, by=by, command=command))

    async def _work(self, robot: PretendRobot, start: Start, *, resumed: bool = False) -> None:
        part = str(start.parameters.get("object"))
        faults = robot.faults.get(part, [])
        if robot.blind:
            await self._issue(robot, start, "blind", 0)
            holding = {"execution": start.execution, "at": "neutral"}
            await self.report(robot, Holding.model_validate(holding))
            return
        if start.was_done is not None and not resumed and part not in robot.stolen:
            await self.report(robot, Finished(execution=start.execution, found_in_place=True))
            return
        if part in robot.stolen and part in robot.lost:
            await self._issue(robot, start, "undone" if start.was_done else "missing", 0)
            holding = {"execution": start.execution, "at": "neutral"}
            await self.report(robot, Holding.model_validate(holding))
            return
        for step in range(5 if resumed else 0, 9):
            due = [each for each in faults if each[1] == step and (robot.stubborn or not resumed)]
            if due and due[0][0] in robot.interrupting:
                faults.remove(due[0])
                for known in (robot.right, robot.placed, robot.finished):
                    known.discard(part)
                if due[0][0] in ("missed", "dropped", "missing") and not robot.wrong:
                    robot.lost.add(part)
                robot.obstructed = due[0][0] == "blocked" and not robot.felt
                await self._issue(robot, start, due[0][0], step)
                at = "in_place" if due[0][0] in ("unreachable", "missing", "blocked") else "neutral"
                holding = {"execution": start.execution, "at": at}
                await self.report(robot, Holding.model_validate(holding))
                return
            if step == 0:
                continue
            robot.time += 1.0
            await self.report(
                robot,
                StepStarted(
                    execution=start.execution,
                    step=step,
                    name=f"step {step}",
                    phase="release" if step == RELEASES else None,
                ),
            )
            if due:
                faults.remove(due[0])
                await self._issue(robot, start, due[0][0], step)
        robot.stolen.discard(part)
        robot.finished.add(part)
        if part in robot.returns:
            robot.lost -= robot.stolen
            robot.stolen.clear()
        thefts = robot.thefts.get(part, [])
        if thefts:
            self._steal(robot, thefts.pop(0))
        if part == robot.blinded_by:
            robot.blind, robot.blinded_by = True, None
        await self.report(robot, Finished(execution=start.execution))

    async def _issue(self, robot: PretendRobot, start: Start, kind: str, step: int) -> None:
        await self.report(
            robot,
            IssueDetected(
                execution=start.execution,
                issue=kind,
                step=step,
                interrupts=kind in robot.interrupting,
                detection=Detection(camera="head", felt=robot.felt) if robot.felt else None,
            ),
        )
        if robot.films:
            pictures = [
                ClipPicture(before_s=before_s, jpeg=base64.b64encode(jpeg).decode())
                for before_s, jpeg in ((1.5, FIRST_JPEG), (0.5, SECOND_JPEG))
            ]
            clip = ClipTaken(execution=start.execution, issue=kind, pictures=pictures)
            await self.report(robot, clip)

    def _verdict(self, robot: PretendRobot, result: FinishedResult) -> str:
        if robot.blind or result.object in robot.hidden_at_place:
            return "hidden"
        # A patient one would wait for ever for help that was given before it first looked.
        helped = set() if robot.patient else robot.placed
        there = result.object in robot.finished | helped
        return "there" if there and result.object not in robot.stolen else "gone"

    def _steal(self, robot: PretendRobot, part: str) -> None:
        robot.stolen.add(part)
        if not robot.in_reach:
            robot.lost.add(part)
        robot.right.discard(part)
        robot.placed.discard(part)

    async def _look(self, robot: PretendRobot, command: str, look: Look) -> None:
        fulfilled = None
        if look.expect is not None:
            clear = look.expect == "view_clear" and not robot.blind
            clear |= look.expect == "way_clear" and not robot.obstructed
            there = robot.wrong and look.expect == "in_reach" and look.object not in robot.lost
            held = look.expect == "in_gripper" and look.object == robot.held
            fulfilled = (look.object or "") in robot.right or clear or there or held
            if not fulfilled and robot.patient and look.within_s > TAKING_S:
                return
            if not fulfilled:
                # What is queued may be the deed that is being watched for.
                robot.time += look.within_s
        unseen = robot.table.keys() if robot.blind else robot.hidden | robot.lost
        seen = {
            name: Sighting(
                x=0.5 if name in robot.placed else 0.4, y=y, z=0.7, yaw=0, time=robot.time
            )
            for name, y in robot.table.items()
            if name not in unseen
        }
        await self.report(
            robot,
            Looked(
                command=command,
                objects=seen,
                gripper=Position(x=0.4, y=0.0, z=1.0),
                fulfilled=fulfilled,
                there=[each for each in look.finished if self._verdict(robot, each) == "there"],
                gone=[each for each in look.finished if self._verdict(robot, each) == "gone"],
                held=robot.held,
                blind="the camera is covered" if robot.blind else None,
                brought=robot.brought if robot.wrong else None,
                jpeg=base64.b64encode(SECOND_JPEG).decode()
                if robot.films and not fulfilled
                else None,
            ),
        )


def _for_help(holds_s: float) -> bool:
    """Whether time is to pass for help that was promised, and not while a question is open."""
    return WATCH_PERIOD_S < holds_s <= HELP_TAKES_S
