"""A robot for tests of the link: its behaviors are `steps` steps of a second each."""

import base64
from collections import deque
from typing import Any

from mend.robots.agent import Emit, EmitPicture
from mend.robots.link.messages import (
    ActiveExecution,
    CommandBody,
    Finished,
    Held,
    Hello,
    Hold,
    Holding,
    Interrupt,
    Look,
    Looked,
    Picture,
    Position,
    ReachLimits,
    Rejected,
    Shutdown,
    Start,
    StepStarted,
    TakePicture,
)

JPEG = base64.b64encode(b"\xff\xd8\xff picture \xff\xd9").decode()
"""What begins and ends as a picture does, which is enough of one for the link."""


class CountingAgent:
    """Implements `mend.robots.agent.AgentCore`, and a group of this one robot.

    Notes every command that it is handed.
    """

    def __init__(
        self,
        robot: str = "counter",
        *,
        steps: int = 3,
        pace: float | None = None,
        simulated: bool = True,
    ) -> None:
        self.robot = robot
        self.steps = steps
        self.handled: list[tuple[str, CommandBody]] = []
        self.idle_advances = 0
        self.pace = pace
        self.shut_down = False
        self._simulated = simulated
        self._time_s = 0.0
        self._began_s = 0.0
        self._step = 0
        self._execution: str | None = None
        self._looks: deque[str] = deque()

    @property
    def agents(self) -> "list[CountingAgent]":
        return [self]

    def hello(self, boot: str) -> Hello:
        executing = (
            ActiveExecution(execution=self._execution, state="running", step=self._step)
            if self._execution
            else None
        )
        return Hello(
            protocol=1,
            robot=self.robot,
            boot=boot,
            behaviors=["count"],
            cameras=["head"],
            reach=ReachLimits(x=0.0, y=0.0, min_m=0.1, max_m=1.0),
            executing=executing,
            time=self._time_s,
            simulated=self._simulated,
        )

    def attach(self, emit: Emit, emit_picture: EmitPicture) -> None:
        self._emit = emit
        self._emit_picture = emit_picture

    def handle(self, command_id: str, body: CommandBody) -> None:
        self.handled.append((command_id, body))
        match body:
            case Start():
                self._execution, self._step = body.execution, 0
                self._began_s = self._time_s
            case Look():
                self._looks.append(command_id)
            case Interrupt():
                self._report(Holding(execution=self._execution, at="in_place"))
                self._execution = None
            case TakePicture():
                self._emit_picture(Picture(command=command_id, camera=body.camera, jpeg=JPEG))
            case Shutdown():
                self.shut_down = True
            case Hold():
                self._time_s = body.until
                self._report(Held(command=command_id))
            case _:
                self._report(Rejected(command=command_id, reason="it only counts"))

    def advance(self, duration_s: float) -> bool:
        if self._looks:
            self._report(
                Looked(
                    command=self._looks.popleft(), objects={}, gripper=Position(x=0.0, y=0.0, z=0.0)
                )
            )
            return True
        if self._execution is None:
            self.idle_advances += 1
            return False
        self._time_s += duration_s
        while self._execution is not None and self._step < self._time_s - self._began_s:
            self._step += 1
            if self._step > self.steps:
                self._report(Finished(execution=self._execution))
                self._execution = None
            else:
                self._report(StepStarted(execution=self._execution, step=self._step, name="count"))
        return True

    def time_s(self) -> float:
        return self._time_s

    def _report(self, body: Any) -> None:
        self._emit(body, self._time_s, {"step": self._step})
