"""A run that only notes what it is told, and commits the receipts."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field

from mend.robots.link.messages import Hello, Poses, Report
from mend.server.journal.journal import Entry, Journal, Receipt


@dataclass
class RecordingSink:
    """Implements `mend.server.robots.sink.RobotSink`."""

    journal: Journal
    robots: set[str] = field(default_factory=set)
    hellos: list[Hello] = field(default_factory=list)
    reports: list[Report] = field(default_factory=list)
    receipts: list[Receipt] = field(default_factory=list)
    posed: list[Poses] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    changed: asyncio.Condition = field(default_factory=asyncio.Condition)

    async def robot_connected(self, robot: str, hello: Hello) -> None:
        self.robots.add(robot)
        self.hellos.append(hello)
        await self._notify()

    async def robot_reported(self, robot: str, report: Report, receipt: Receipt) -> None:
        self.robots.add(robot)
        await self.journal.append(Entry(receipt=receipt))
        self.reports.append(report)
        self.receipts.append(receipt)
        await self._notify()

    def robot_posed(self, robot: str, poses: Poses) -> None:
        self.robots.add(robot)
        self.posed.append(poses)

    async def robot_lost(self, robot: str, reason: str) -> None:
        self.robots.add(robot)
        self.lost.append(reason)
        await self._notify()

    async def _notify(self) -> None:
        async with self.changed:
            self.changed.notify_all()

    async def wait_until(self, condition: Callable[[], bool]) -> None:
        async with asyncio.timeout(60), self.changed:
            await self.changed.wait_for(condition)

    def types(self) -> list[str]:
        return [report.body.type for report in self.reports]
