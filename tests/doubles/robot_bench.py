"""A robot over a scripted body, with what it reports kept for a test."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from scripted_body import STARTS, ScriptedBody, catalogue, trained_model

from mend.robots.arm.subsystem import ArmSubsystem
from mend.robots.execution.behavior import Behavior
from mend.robots.execution.monitor import AnyMonitor
from mend.robots.link.messages import CommandBody, Look, Picture, ReportBody, Start
from mend.robots.robot import Robot
from mend.tasks.plugins import load_plugins

MODEL = trained_model()
LONGEST_S = 120.0

R = TypeVar("R")


class RobotBench:
    """Commands in, reports out; `at` scripts the world by task progress.

    `behaviors` and `monitors` are in addition to those that are installed.
    """

    def __init__(
        self,
        period_s: float = 1 / 30,
        body: ScriptedBody | None = None,
        behaviors: Mapping[str, type[Behavior]] | None = None,
        monitors: Mapping[str, type[AnyMonitor]] | None = None,
    ) -> None:
        self.body = body or ScriptedBody(STARTS, period_s)
        self.robot = Robot(
            "r1",
            self.body,
            [
                ArmSubsystem(
                    self.body,
                    MODEL,
                    catalogue(),
                    {**load_plugins("mend.behaviors"), **(behaviors or {})},
                    {**(monitors or {}), **load_plugins("mend.monitors")},
                )
            ],
        )
        self.reports: list[tuple[float, ReportBody]] = []
        self.pictures: list[Picture] = []
        self.robot.attach(
            lambda body, time_s, _: self.reports.append((time_s, body)), self.pictures.append
        )
        self._commands = 0

    def send(self, body: CommandBody) -> str:
        self._commands += 1
        self.robot.handle(f"c{self._commands}", body)
        return f"c{self._commands}"

    def start(self, name: str, place: str = "left", **parameters: Any) -> None:
        execution = f"e{self._commands + 1}"
        self.send(
            Start(
                execution=execution,
                node="/0",
                behavior="pick_and_place",
                parameters={"object": name, "place": place, **parameters},
            )
        )

    def look(self, **what: Any) -> None:
        self.send(Look(**what))

    def run(self) -> None:
        """Until nothing is under way any more."""
        while self.robot.advance(1.0):
            assert self.robot.time_s() < LONGEST_S, "it never ends"

    def run_until(self, kind: type[R]) -> R:
        """Until a report of this kind comes (one of those still to come)."""
        before = len(self.of(kind))
        while len(self.of(kind)) == before:
            going_on = self.robot.advance(self.body.control_period_s)
            assert going_on or len(self.of(kind)) > before, f"no {kind.__name__} came"
            assert self.robot.time_s() < LONGEST_S, f"no {kind.__name__} came"
        return self.of(kind)[-1]

    def run_to(self, step: int, fraction: float = 0.0) -> None:
        """Until the behavior is this far."""
        while True:
            progress = self.robot.task_progress
            if progress is not None and (progress.step, progress.fraction) >= (step, fraction):
                return
            assert self.robot.advance(self.body.control_period_s), f"step {step} never came"

    def at(self, step: int, fraction: float, do: Callable[[], None]) -> None:
        """Do something once when the behavior is this far."""
        done = []

        def act() -> None:
            progress = self.robot.task_progress
            if not done and progress and (progress.step, progress.fraction) >= (step, fraction):
                done.append(True)
                do()

        self.body.at_cycle = act

    def of(self, kind: type[R]) -> list[R]:
        return [body for _, body in self.reports if isinstance(body, kind)]

    def kinds(self) -> list[str]:
        return [body.type for _, body in self.reports]
