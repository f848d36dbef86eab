"""Prints random runs with what the service says of them after every event, for the console's tests.

    python tests/doubles/folded_runs.py [SEED ...]

One line of JSON per run: `events` with their lines, and as many `states` with the nodes, status,
open dialogues and how the run is steered. Leaf potentials are those of the last choice in which the
leaf was a candidate: what a robot has seen since then is in no event.
"""

# ruff: noqa: T201

import asyncio
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from random_task import random_task
from recorded_service import recorded_events
from steered_events import steered_events

from mend.dialogue.registry import load_scripts
from mend.server.composition import open_service
from mend.server.journal import events as ev
from mend.server.journal.sqlite import IN_MEMORY
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_state import RunState
from mend.server.runtime.run_views import RunViewing, dialogue_view, steering_view
from mend.server.settings import Settings
from mend.server.transcript import Transcript
from mend.tasks.scenario import Person

STEERED_SEED = 23
LEAVES = 12
PAUSED_EVERY = 7


async def random_events(seed: int) -> Sequence[ev.Event]:
    """The events of a run of a random tree, with random mischief and random answers."""
    task = random_task(np.random.default_rng(seed), LEAVES)
    request = RunRequest(
        tree="random",
        world="tabletop",
        speed="max",
        seed=seed,
        answers="random" if seed % 2 else "none",
        interventions="random",
        person=Person(never=0.3),
        max_attempts=1 + seed % 3,
    )
    settings = Settings(port=0, journal=Path(IN_MEMORY), log_level="error", speech_voice="none")
    async with open_service(settings) as service:
        await service.library.trees.save("random", json.dumps(task))
        run = await service.runtime.start_run(request)
        await service.runtime.wait_for_end(run.id)
        return _paused(await service.journal.read(0, 100_000, run.id))


def _paused(events: Sequence[ev.Event]) -> list[ev.Event]:
    """The same run as if somebody had paused it every now and then."""
    paused: list[ev.Event] = []
    for number, event in enumerate(events, start=1):
        paused.append(event)
        if number % PAUSED_EVERY == 0 and number < len(events):
            stamp = {"time": event.time, "wall_time": event.wall_time, "run": event.run}
            paused += [ev.RunPaused(**stamp), ev.RunResumed(**stamp)]
    return [event.model_copy(update={"seq": seq}) for seq, event in enumerate(paused, start=1)]


async def _nodes(state: RunState, potentials: dict[int, float]) -> list[dict[str, Any]]:
    by_node = [potentials.get(node, 0.0) for node in range(len(state.tree))]
    view = await RunViewing(state, state.time, by_node, None).view()
    return [each.model_dump(mode="json") for each in view.nodes]


def states(events: Sequence[ev.Event]) -> list[dict[str, Any]]:
    """What the service says after each event."""
    assert isinstance(events[0], ev.RunStarted)
    state = RunState(events[0], load_scripts())
    potentials: dict[int, float] = {}
    said = []
    for event in events:
        if event is not events[0]:
            state.fold(event)
        if isinstance(event, ev.NodeStarted):
            for each in event.candidates:
                potentials[state.tree.index_of(each.node)] = each.potential
        said.append(
            {
                "status": state.status,
                "result": state.result.model_dump(mode="json") if state.result else None,
                "nodes": asyncio.run(_nodes(state, potentials)),
                "dialogues": [
                    dialogue_view(each).model_dump(
                        mode="json", include={"dialogue", "node", "awaiting", "claimed_by"}
                    )
                    for each in state.open_dialogues
                ],
                "steering": steering_view(state).model_dump(mode="json", exclude={"run", "seq"}),
            }
        )
    return said


def main() -> None:
    """Print the recorded run of the paper's scenario, one that is steered, and one a seed."""
    runs = [
        recorded_events(),
        steered_events(STEERED_SEED),
        *(asyncio.run(random_events(int(each))) for each in sys.argv[1:]),
    ]
    for events in runs:
        transcript = Transcript()
        told = [
            {
                **event.model_dump(mode="json"),
                "lines": [asdict(each) for each in transcript.lines(event)],
            }
            for event in events
        ]
        print(json.dumps({"events": told, "states": states(events)}))


if __name__ == "__main__":
    main()
