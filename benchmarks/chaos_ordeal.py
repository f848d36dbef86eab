"""A service among faults that are drawn at random, and what was found afterwards."""

import asyncio
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from chaos_faults import FAULTS, Fault
from chaos_ledger import Ledger, last_heard_by_all
from chaos_lives import Lives
from chaos_place import HangsError, Place

PATIENCE_S = 60.0
"""Runs of which nothing at all is heard for so long, with nothing that disturbs them, hang."""
SECOND_FAULT = 0.3
MOST_PAUSE_S = 1.0


@dataclass(slots=True)
class Findings:
    """`faults`: a sentence for whatever should not be. `counts`: what was done, by kind."""

    counts: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)
    runs: int = 0
    events: int = 0
    answers: Counter[str] = field(default_factory=Counter)
    endings: Counter[str] = field(default_factory=Counter)
    latencies_s: list[float] = field(default_factory=list)
    unanswered: int = 0
    repeated: int = 0
    lives: Lives = field(default_factory=Lives)


class Ordeal:
    """Keeps `many` runs going among faults, for as long as `goes_on` says."""

    def __init__(
        self, place: Place, many: int, *, tell: Callable[[str], None] = lambda _: None
    ) -> None:
        self._place = place
        self._many = many
        self._tell = tell
        self._findings = Findings(lives=place.lives)
        # Others draw as often as time allows; the faults are the same for the same seed.
        (self._rng,) = place.rng.spawn(1)

    async def go_through(self, goes_on: Callable[[int], bool]) -> Findings:
        """`goes_on` is asked with how many faults there were."""
        place, findings = self._place, self._findings
        enough = asyncio.Event()
        starting = asyncio.create_task(
            place.clients.keep_running(self._many, place.request, enough)
        )
        try:
            await self._warm_up()
            place.look()
            place.probe.start()
            await self._disturb(goes_on)
            enough.set()
            await starting
            await self._wait_for_the_ends()
        except HangsError as error:
            findings.faults.append(str(error))
        finally:
            starting.cancel()
            await asyncio.gather(starting, return_exceptions=True)
            await asyncio.to_thread(place.probe.stop)
        place.look()
        await self._look()
        return findings

    async def _warm_up(self) -> None:
        """Until a run has ended: by then the service has everything in memory that it uses."""
        followers = self._place.followers
        await self._while_there_is_news(
            lambda: any(each.ends for each in followers), "no run ends at all"
        )

    async def _while_there_is_news(self, until: Callable[[], bool], otherwise: str) -> None:
        """Wait for something. Raises `HangsError` once nothing is heard any more before it."""
        follower = self._place.followers[0]
        seen, heard_at = follower.seen, time.monotonic()
        while not until():
            await asyncio.sleep(0.2)
            if follower.seen != seen:
                seen, heard_at = follower.seen, time.monotonic()
            elif time.monotonic() - heard_at > PATIENCE_S:
                raise HangsError(f"{otherwise}: {await self._place.clients.last_words()}")

    async def _disturb(self, goes_on: Callable[[int], bool]) -> None:
        rng = self._rng
        while goes_on(sum(self._findings.counts.values())):
            drawn = [_drawn(FAULTS, rng)]
            if rng.random() < SECOND_FAULT:
                drawn.append(_drawn([each for each in FAULTS if not each.alone], rng))
            await asyncio.gather(*(self._commit(each) for each in drawn))
            self._place.look()
            await asyncio.sleep(float(rng.uniform(0.0, MOST_PAUSE_S)))

    async def _commit(self, fault: Fault) -> None:
        self._findings.counts[fault.name] += 1
        self._tell(fault.name)
        await fault.act(self._place)

    async def _wait_for_the_ends(self) -> None:
        """Until no run goes on, and everybody has heard everything."""
        self._tell("waiting for the ends of runs")
        # First those that have only just begun.
        await self._wait_for_the_news()
        await self._while_there_is_news(
            lambda: self._place.followers[0].runs_going_on == 0, "runs never end"
        )
        await self._wait_for_the_news()

    async def _wait_for_the_news(self) -> None:
        """Until all have heard what there is now."""
        place = self._place
        last = await asyncio.to_thread(last_heard_by_all, place.service.journal)
        await self._while_there_is_news(
            lambda: all(each.seen >= last for each in place.followers), "not all is heard by all"
        )

    async def _look(self) -> None:
        """Stop the service, and read what it has left."""
        place, findings = self._place, self._findings
        code = await place.service.stop()
        if code != 0:
            findings.faults.append(f"the service ended with {code}")
        complaints = place.service.complaints
        if "Traceback" in complaints:
            at = complaints.index("Traceback")
            findings.faults.append(f"a traceback: {complaints[max(0, at - 300) : at + 3000]}")
        ledger = Ledger(place.service.journal)
        findings.faults += ledger.faults(place.witness)
        findings.faults += await asyncio.to_thread(_mend_journal_check, place.service.journal)
        findings.events = len(ledger.rows)
        findings.endings = ledger.endings
        findings.runs = sum(findings.endings.values())
        findings.answers = Counter(each.outcome for each in place.witness.answers)
        findings.repeated = place.witness.repeated
        findings.latencies_s = place.probe.latencies_s
        findings.unanswered = place.probe.failures


def _drawn(faults: "list[Fault] | tuple[Fault, ...]", rng: np.random.Generator) -> Fault:
    weights = np.array([each.weight for each in faults])
    return faults[int(rng.choice(len(faults), p=weights / weights.sum()))]


def _mend_journal_check(journal: Path) -> list[str]:
    """What Mend's own check finds, which is code of another kind than the ledger's."""
    mend = str(Path(sys.executable).with_name("mend"))
    done = subprocess.run(
        [mend, "journal", "check", str(journal)], capture_output=True, text=True, check=False
    )
    return [] if done.returncode == 0 else [f"mend journal check: {done.stdout}{done.stderr}"]
