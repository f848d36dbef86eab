"""Races: many helpers answer the same question at once, claim it, and ask for more time."""

import asyncio
import json
import random
from collections import Counter
from dataclasses import dataclass, field
from typing import Literal
from uuid import UUID

from pretend_service import PretendService, pretend_service
from task_documents import definition_of

from mend.errors import ConflictError
from mend.server.errors import LostRaceError
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest

ONE_PART = definition_of({"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"})

FAULTS_PER_RUN = 60


@dataclass
class RaceFindings:
    """What became of the races; `winners` by question, as the journal has them."""

    races: int = 0
    answers: int = 0
    refused: int = 0
    told_the_winner: int = 0
    winners: Counter[UUID] = field(default_factory=Counter)
    mistold: int = 0

    @property
    def doubled(self) -> int:
        """Questions that were answered more than once."""
        return sum(count > 1 for count in self.winners.values())

    @property
    def unanswered(self) -> int:
        """Races that nobody won."""
        return self.races - len(self.winners)


async def race(races: int, helpers: int, seed: int) -> RaceFindings:
    """Let `helpers` race for the answer to each of `races` questions."""
    findings = RaceFindings()
    rng = random.Random(seed)
    while findings.races < races:
        faults = {"part_1": [("missed", 4)] * FAULTS_PER_RUN}
        async with pretend_service(ONE_PART, faults, patient=True) as service:
            await _race_through_a_run(service, findings, races, helpers, rng)
    return findings


async def _race_through_a_run(
    service: PretendService, findings: RaceFindings, races: int, helpers: int, rng: random.Random
) -> None:
    request = {"tree": "tree", "world": "tabletop", "speed": "max", "max_attempts": 100}
    run = await service.runtime.start_run(RunRequest.model_validate(request))
    with service.journal.subscribe(0, 100_000) as events:
        async for record in events:
            event = json.loads(record.text)
            if event["type"] in ("run_finished", "run_failed") or findings.races >= races:
                break
            if event["type"] == "prompt" and event["kind"] == "ask":
                findings.races += 1
                prompt, dialogue = UUID(event["prompt"]), UUID(event["dialogue"])
                await asyncio.gather(
                    *(
                        _answer(service, findings, dialogue, prompt, f"helper-{i}", rng)
                        for i in range(helpers)
                    )
                )
    if not (await service.runtime.run(run.id)).status.ended:
        await service.runtime.abort(run.id)
    await service.runtime.wait_for_end(run.id)
    kept = await service.journal.read(0, 1_000_000, run.id)
    findings.winners.update(each.prompt for each in kept if isinstance(each, ev.Answered))


async def _answer(
    service: PretendService,
    findings: RaceFindings,
    dialogue: UUID,
    prompt: UUID,
    helper: str,
    rng: random.Random,
) -> None:
    answer: Literal["yes", "no"] = rng.choice(("yes", "no"))
    claims, extends, turns = rng.random() < 0.3, rng.random() < 0.1, rng.randrange(4)
    for _ in range(turns):
        await asyncio.sleep(0)
    try:
        if claims:
            await service.runtime.dialogues.claim(dialogue, helper, take_over=rng.random() < 0.5)
        if extends:
            await service.runtime.dialogues.extend(dialogue, prompt, helper)
    except ConflictError:
        # Another has the claim, or has answered: neither keeps anybody from trying.
        pass
    try:
        answered = await service.runtime.dialogues.answer(dialogue, prompt, answer, helper)
    except LostRaceError as error:
        findings.refused += 1
        findings.told_the_winner += error.answered_by != helper
    except ConflictError:
        findings.refused += 1
    else:
        findings.answers += 1
        findings.mistold += (answered.helper, answered.answer) != (helper, answer)
