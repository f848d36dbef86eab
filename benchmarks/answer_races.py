"""Helpers who answer the same question at the same moment: how often is one answered twice?

    python benchmarks/answer_races.py [--races 10000] [--helpers 8] [--quick]

Every question of the runs is raced for by all helpers, some of whom claim it, take the claim over
or ask for more time on the way. The naive way, in the same run, is a desk that looks whether the
question is open, keeps the answer in the same journal, and then marks it as answered.
"""

# ruff: noqa: T201
import argparse
import asyncio
import random
import sys
import time
from datetime import UTC, datetime
from pathlib import Path
from uuid import UUID, uuid4

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from answer_races import race

from mend.server.journal.events import Answered
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal

QUICK_RACES = 300


class NaiveDesk:
    """Looks, keeps, marks; nothing makes the three one."""

    def __init__(self, journal: SqliteJournal) -> None:
        self._journal = journal
        self._open: set[UUID] = set()
        self.answers = 0

    def ask(self) -> UUID:
        prompt = uuid4()
        self._open.add(prompt)
        return prompt

    async def answer(self, prompt: UUID, helper: str, turns: int) -> None:
        for _ in range(turns):
            await asyncio.sleep(0)
        if prompt in self._open:
            await self._journal.append(Entry(events=[_answered(prompt, helper)]))
            self._open.discard(prompt)
            self.answers += 1


def _answered(prompt: UUID, helper: str) -> Answered:
    return Answered(
        time=0.0,
        wall_time=datetime.now(UTC),
        run=prompt,
        node="/0",
        name="part_1",
        dialogue=prompt,
        robot="robot",
        issue="missed",
        object="part_1",
        prompt=prompt,
        version=1,
        answer="yes",
        helper=helper,
    )


async def naive(races: int, helpers: int, seed: int) -> int:
    """How many of the naive desk's questions were answered more than once."""
    rng = random.Random(seed)
    journal = SqliteJournal(":memory:")
    doubled = 0
    for _ in range(races):
        desk = NaiveDesk(journal)
        prompt = desk.ask()
        await asyncio.gather(
            *(desk.answer(prompt, f"helper-{i}", rng.randrange(4)) for i in range(helpers))
        )
        doubled += desk.answers > 1
    journal.close()
    return doubled


async def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--races", type=int, default=10_000)
    parser.add_argument("--helpers", type=int, default=8)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_RACES} races")
    told = parser.parse_args()
    races = QUICK_RACES if told.quick else told.races
    began = time.perf_counter()
    found = await race(races, told.helpers, told.seed)
    wall_s = time.perf_counter() - began
    doubled = await naive(races, told.helpers, told.seed)
    print(f"{races:,} questions, {told.helpers} helpers each, {wall_s:.0f} s")
    print(f"  answered once      {sum(each == 1 for each in found.winners.values()):,}")
    print(f"  answered twice     {found.doubled:,} (the naive desk: {doubled:,})")
    print(f"  not answered       {found.unanswered:,}")
    print(f"  refused            {found.refused:,}, told who was first {found.told_the_winner:,}")
    print(f"  told another's     {found.mistold:,}")
    if found.doubled or found.unanswered or found.mistold:
        sys.exit(1)


if __name__ == "__main__":
    asyncio.run(main())
