"""Runs that live through `kill -9` at random moments, and what was found afterwards."""

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from itertools import pairwise
from typing import Any
from uuid import UUID

import httpx
import numpy as np
from broken_constraints import broken_constraints
from service_process import ServiceProcess

from mend.server.client import ENDS, MendClient
from mend.server.journal import events as ev
from mend.server.journal.reader import JournalReader
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, Snapshot

PATIENCE_S = 60.0
"""A run of which nothing is heard for so long hangs."""


class HangsError(Exception):
    """Nothing happens any more; holds the runs that have not ended, and the last events."""


@dataclass
class Findings:
    """What became of the runs; every list of sentences is empty if all went well."""

    kills: int = 0
    runs: int = 0
    finished: int = 0
    events: int = 0
    lost: list[str] = field(default_factory=list)
    doubled: list[str] = field(default_factory=list)
    broken: list[str] = field(default_factory=list)
    unfinished: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    recoveries_s: list[float] = field(default_factory=list)

    @property
    def faults(self) -> list[str]:
        return [*self.lost, *self.doubled, *self.broken, *self.unfinished, *self.missing]


class Watcher:
    """A helper who follows every event after one, across all lives of the service."""

    def __init__(self) -> None:
        self.events: list[ev.Event] = []
        self.after = 0
        self._news = asyncio.Event()

    @property
    def seen(self) -> int:
        return self.events[-1].seq if self.events else self.after

    @property
    def open_dialogues(self) -> set[UUID]:
        closed = {each.dialogue for each in self.events if isinstance(each, ev.DialogueClosed)}
        opened = {each.dialogue for each in self.events if isinstance(each, ev.DialogueOpened)}
        return opened - closed

    @property
    def open_runs(self) -> set[UUID]:
        ended = {each.run for each in self.events if isinstance(each, ENDS)}
        return {each.run for each in self.events if isinstance(each, ev.RunStarted)} - ended

    async def follow(self, client: MendClient) -> None:
        async with client.follow("watcher", after=self.after) as stream:
            async for message in stream:
                if not isinstance(message, Snapshot):
                    self.events.append(message)
                    self._news.set()

    async def wait_until(self, condition: Callable[[], bool]) -> None:
        """Raises `HangsError` when nothing is heard for `PATIENCE_S` before it holds."""
        while not condition():
            self._news.clear()
            try:
                async with asyncio.timeout(PATIENCE_S):
                    await self._news.wait()
            except TimeoutError:
                raise HangsError(self.open_runs, self.events[-5:]) from None

    def first_after(self, seq: int, kinds: Any = ev.Event) -> ev.Event | None:
        return next((e for e in self.events if e.seq > seq and isinstance(e, kinds)), None)


class Ordeal:
    """Keeps runs of `requests` going, kills at random moments of the journal, then looks.

    No other run may go on; those that have ended are no matter of its.
    """

    def __init__(
        self,
        service: ServiceProcess,
        requests: Sequence[RunRequest],
        seed: int,
        *,
        most_events_between: int = 15,
    ) -> None:
        self._service = service
        self._requests = requests
        self._rng = np.random.default_rng(seed)
        self._most_events_between = most_events_between
        self._watcher = Watcher()
        self._findings = Findings()
        self._kills: list[tuple[int, datetime, Any]] = []

    async def kill_service(self, kills: int) -> Findings:
        """`kill -9` the service `kills` times."""
        return await self._go_through(kills, self._kill_service)

    async def kill_robots(self, kills: int) -> Findings:
        """`kill -9` the process of the only run's robot `kills` times, at times twice in a row."""
        return await self._go_through(kills, self._kill_robot)

    async def _go_through(
        self, kills: int, kill: Callable[[MendClient], Awaitable[int]]
    ) -> Findings:
        self._watcher.after = self._service.head()
        async with MendClient(self._service.url) as client:
            following = asyncio.create_task(self._watcher.follow(client))
            try:
                while self._findings.kills < kills:
                    await self._keep_running(client)
                    await self._let_something_happen()
                    if self._watcher.open_runs:
                        self._findings.kills += await kill(client)
                await self._watcher.wait_until(lambda: not self._watcher.open_runs)
                await self._look(client)
            finally:
                following.cancel()
                await asyncio.gather(following, return_exceptions=True)
        return self._findings

    async def _keep_running(self, client: MendClient) -> None:
        if self._watcher.open_runs:
            return
        for request in self._requests:
            run = await client.start_run(request)
            self._findings.runs += 1
            await self._watcher.wait_until(
                lambda run=run: any(each.run == run.id for each in self._watcher.events)
            )

    async def _let_something_happen(self) -> None:
        target = self._watcher.seen + int(self._rng.integers(1, self._most_events_between + 1))
        watcher = self._watcher
        await watcher.wait_until(lambda: watcher.seen >= target or not watcher.open_runs)

    async def _kill_service(self, client: MendClient) -> int:
        at, dialogues = datetime.now(UTC), self._watcher.open_dialogues
        await self._service.kill()
        head = self._service.head()
        self._kills.append((head, at, ev.Event))
        await self._service.start()
        await self._watcher.wait_until(lambda: self._watcher.seen >= head)
        still_open = {each.dialogue for each in await client.dialogues("open")}
        closed = dialogues - self._watcher.open_dialogues
        self._findings.broken += [
            f"dialogue {each} was open when the service was killed, and is not open afterwards"
            for each in dialogues - still_open - closed
            if (await client.dialogue(each)).status != "closed"
        ]
        return 1

    async def _kill_robot(self, _: MendClient) -> int:
        at, seen = datetime.now(UTC), self._watcher.seen
        again = bool(self._rng.random() < 0.2)
        if not await self._service.kill_robot(again=again):
            await asyncio.sleep(0.05)
            return 0
        self._kills.append((seen, at, ev.RobotBack))
        await self._watcher.wait_until(
            lambda: (
                self._watcher.first_after(seen, ev.RobotBack) is not None
                or not self._watcher.open_runs
            )
        )
        return 2 if again else 1

    # --- Afterwards ---------------------------------------------------------------------------

    async def _look(self, client: MendClient) -> None:
        findings, seen = self._findings, self._watcher.events
        with JournalReader(self._service.journal) as reader:
            told = [each for run in reader.runs() for each in reader.events(run)]
        journaled = {each.seq: each for each in told if each.seq > self._watcher.after}
        runs = {each.run for each in journaled.values()}
        findings.events = len(journaled)
        # What there was before is of no run; a first one that is lost was sent all the same.
        first = min(seq for seq, each in journaled.items() if isinstance(each, ev.RunStarted))
        findings.lost += [
            f"event {seq} is not in the journal"
            for seq in range(first, max(journaled) + 1)
            if seq not in journaled
        ]
        findings.lost += [
            f"event {each.seq} was sent, and the journal has another or none"
            for each in seen
            if journaled.get(each.seq) != each
        ]
        seqs = [each.seq for each in seen]
        findings.lost += [
            f"event {seq} never came over the socket" for seq in sorted(set(journaled) - set(seqs))
        ]
        findings.doubled += [
            f"event {after} came after event {before} over the socket"
            for before, after in pairwise(seqs)
            if after <= before
        ]
        for run in runs:
            await self._look_at(client, run, [e for e in journaled.values() if e.run == run])
        for head, at, kind in self._kills:
            back = self._watcher.first_after(head, kind)
            if back is not None and not isinstance(back, ev.RunStarted):
                findings.recoveries_s.append((back.wall_time - at).total_seconds())

    async def _look_at(self, client: MendClient, run: UUID, events: list[ev.Event]) -> None:
        view, findings = await client.run(run), self._findings
        findings.broken += [
            f"run {run}: {sentence}"
            for sentence in broken_constraints(
                events, {each.node: each.kind for each in view.nodes}
            )
        ]
        if view.status is RunStatus.FINISHED and view.result is not None:
            findings.finished += 1
            findings.missing += [
                f"run {run}: {each.object} is not at {each.place}" for each in view.result.missing
            ]
        else:
            reason = view.result.reason if view.result else "it has not ended"
            findings.unfinished.append(f"run {run}: {view.status}: {reason}")


async def doubled_starts(
    service: ServiceProcess, kills: int, *, committed: bool, runs_before: int = 0
) -> list[str]:
    """Lose the answer to a run that is asked for under a key, then ask twice more, so many times.

    The service is killed as soon as the run is in the journal, or as soon as the request was sent;
    `runs_before`: so many are in its journal already.
    Returns what is not as it should be, one run for each key.
    """
    request = RunRequest(tree="eket", world="tabletop", answers="none").model_dump(mode="json")
    wrong: list[str] = []
    for number in range(runs_before + 1, runs_before + kills + 1):
        sent: Any = {"json": request, "headers": {"Idempotency-Key": f'"{number}"'}}
        async with httpx.AsyncClient(base_url=service.url, timeout=PATIENCE_S) as client:
            lost = asyncio.create_task(client.post("/api/runs", **sent))
            if committed:
                await service.has_runs(number)
            else:
                await asyncio.sleep(0)
            await service.kill()
            await asyncio.gather(lost, return_exceptions=True)
            await service.start()
            answers = [await client.post("/api/runs", **sent) for _ in range(2)]
            runs = [each["id"] for each in (await client.get("/api/runs")).json()]
            codes = [each.status_code for each in answers]
            if codes != [201, 201]:
                wrong.append(f"key {number}: asked again, the service answers {codes}")
                continue
            told = {each.json()["id"] for each in answers}
            if told != set(runs[:1]) or len(runs) != number:
                wrong.append(f"key {number}: the answers tell of {told}, of all runs {runs}")
            # So that the next life does not go on with all of them.
            await client.post(f"/api/runs/{runs[0]}/abort")
    return wrong
