"""Drives the first robot of a world as the service does, and keeps what it reports."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from mend.robots.agent import Agent, AgentGroup
from mend.robots.link.messages import CommandBody, IssueDetected, Picture, ReportBody, Start


@dataclass
class Reported:
    """One report: its body, its time and the world's state after it."""

    body: ReportBody
    time_s: float
    world: dict[str, Any] | None


@dataclass
class Driver:
    """Sends commands, lets time pass, collects reports."""

    group: AgentGroup
    reports: list[Reported] = field(default_factory=list)
    pictures: list[Picture] = field(default_factory=list)
    commands: int = 0

    def __post_init__(self) -> None:
        self.agent.attach(
            lambda body, time_s, world: self.reports.append(Reported(body, time_s, world)),
            self.pictures.append,
        )

    @property
    def agent(self) -> Agent:
        return self.group.agents[0]

    def send(self, body: CommandBody) -> str:
        self.commands += 1
        command_id = f"command-{self.commands}"
        self.agent.handle(command_id, body)
        return command_id

    def start(self, name: str, place: str, execution: str = "e1", **more: Any) -> None:
        self.send(
            Start(
                execution=execution,
                node="/0",
                behavior="pick_and_place",
                parameters={"object": name, "place": place, **more},
            )
        )

    def run(
        self, until: Callable[[], bool] | None = None, chunk_s: float = 1.0, limit_s: float = 300.0
    ) -> None:
        """Let time pass until nothing is left to do, or until it is so."""
        end_s = self.group.time_s() + limit_s
        while self.group.time_s() < end_s:
            if until is not None and until():
                return
            if not self.group.advance(chunk_s):
                return
        raise AssertionError(
            f"still busy after {limit_s} s: {[each.body for each in self.reports]}"
        )

    def run_until_issue(self) -> IssueDetected:
        """Let time pass until the robot raises an issue; that issue."""
        self.run(until=lambda: bool(self.issues))
        assert self.issues, [each.body.type for each in self.reports]
        return self.issues[-1]

    def of(self, kind: type[Any]) -> list[Reported]:
        return [each for each in self.reports if isinstance(each.body, kind)]

    @property
    def issues(self) -> list[IssueDetected]:
        return [each.body for each in self.reports if isinstance(each.body, IssueDetected)]
