"""A robot that drives, in the courtyard of the examples, with what it reports kept for a test."""

from collections.abc import Mapping
from typing import Any, TypeVar

from courtyard.cart import PERIOD_S, Cart
from courtyard.world import Courtyard

from mend.robots.base.companion import Companion
from mend.robots.base.subsystem import BaseSubsystem
from mend.robots.base.ways import Ways
from mend.robots.catalogue import Catalogue
from mend.robots.execution.behavior import Behavior
from mend.robots.execution.monitor import AnyMonitor
from mend.robots.link.messages import CommandBody, Location, ReportBody, Start
from mend.robots.robot import Robot
from mend.tasks.frames import Frame
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Table

PLACES = {
    "near": Location(x=2.0, y=0.0, z=0.0, yaw=0.0),
    "far": Location(x=6.0, y=0.0, z=0.0, yaw=0.0),
    "corner": Location(x=2.0, y=3.0, z=0.0, yaw=1.5708),
}
LONGEST_S = 300.0

R = TypeVar("R")


class CartBench:
    """One cart that stands 4 m left of and 3 m behind the lamp post; commands in, reports out."""

    def __init__(
        self,
        behaviors: Mapping[str, type[Behavior]] | None = None,
        monitors: Mapping[str, type[AnyMonitor]] | None = None,
        ways: Ways | None = None,
        companion: Companion | None = None,
    ) -> None:
        """`behaviors` and `monitors` are in addition to those that are installed."""
        self.world = Courtyard([Frame(-4.0, -3.0)])
        (self.cart,) = self.world.carts
        base = BaseSubsystem(
            self.cart,
            Catalogue({}, PLACES, Table()),
            {**load_plugins("mend.behaviors"), **(behaviors or {})},
            {**load_plugins("mend.monitors"), **(monitors or {})},
            ways,
            companion=companion,
        )
        self.robot = Robot("cart", self.cart, [base])
        self.reports: list[ReportBody] = []
        self.robot.attach(lambda body, *_: self.reports.append(body), lambda _: None)

    @property
    def body(self) -> Cart:
        return self.cart

    def send(self, body: CommandBody) -> None:
        self.robot.handle(f"c{len(self.reports)}", body)

    def start(self, behavior: str = "go_to", **parameters: Any) -> None:
        self.send(Start(execution="e1", node="/0", behavior=behavior, parameters=parameters))

    def run(self) -> None:
        """Until nothing is under way any more."""
        while self.robot.advance(1.0):
            assert self.robot.time_s() < LONGEST_S, "it never ends"

    def run_for(self, duration_s: float) -> None:
        """So long, or until nothing is under way any more."""
        end_s = self.robot.time_s() + duration_s
        while self.robot.time_s() < end_s - PERIOD_S / 2 and self.robot.advance(PERIOD_S):
            pass

    def run_until(self, kind: type[R]) -> R:
        """Until a report of this kind comes."""
        before = len(self.of(kind))
        while len(self.of(kind)) == before:
            assert self.robot.advance(PERIOD_S) or len(self.of(kind)) > before, "it never came"
            assert self.robot.time_s() < LONGEST_S, f"no {kind.__name__} came"
        return self.of(kind)[-1]

    def of(self, kind: type[R]) -> list[R]:
        return [each for each in self.reports if isinstance(each, kind)]
