"""Helpers of every kind: does a robot say anything untrue to them?

    python benchmarks/dialogue_truth.py [--runs 20] [--world tabletop|workcell] [--seed 0]
        [--helper KIND ...] [--replay SEED]

Random trees and random interventions, as many runs for each kind of helper: eager, slow, lying
(says yes, does nothing), clumsy (the wrong object, or to the wrong place), absent, contradicting
(yes, then no), refusing. Every sentence, `helped`, `node_done.by` and the end of each run are
compared with where things really were (`dialogue_judge`). The exit code is 1 if anything untrue was
said.
"""

# ruff: noqa: T201

import argparse
import asyncio
import logging
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from broken_constraints import broken_constraints
from dialogue_judge import DialogueJudge, Untruth
from given_documents import given_documents
from random_scenarios import MOST_LEAVES, draw
from untruths import find_untruths, kinds_of
from watched_world import WatchedWorld, where_parts_rest

from mend.server.composition import open_service
from mend.server.dialogues import answers as answering
from mend.server.journal import events as ev
from mend.server.journal.sqlite import IN_MEMORY
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings
from mend.tasks.scenario import Person

ASKS = 3000


@dataclass(frozen=True, slots=True)
class Helper:
    """How a kind of helper answers, how fast, and what they then do."""

    answers: Any
    delay_s: float
    person: Person


HELPERS: dict[str, Helper] = {
    "eager": Helper(["yes"] * ASKS, 0.3, Person(delay_s=0.5)),
    "slow": Helper(["yes"] * ASKS, 40.0, Person(delay_s=20.0)),
    "lying": Helper(["yes"] * ASKS, 2.0, Person(never=1.0)),
    "clumsy": Helper(["yes"] * ASKS, 2.0, Person(wrong_object=0.4, wrong_place=0.4)),
    "absent": Helper("none", 2.0, Person()),
    "contradicting": Helper(["yes", "no"] * ASKS, 2.0, Person(delay_s=8.0, late=0.5, late_s=40.0)),
    "refusing": Helper(["no"] * ASKS, 2.0, Person()),
}


@dataclass(slots=True)
class Outcome:
    """What came of one run."""

    helper: str
    seed: int
    status: str
    dialogues: int
    sentences: int
    left_out: int
    helped: int
    untruths: list[Untruth] = field(default_factory=list)
    broken: list[str] = field(default_factory=list)


async def run_once(world: str, kind: str, seed: int, *, show: bool = False) -> Outcome:
    """One random run with a helper of one kind, judged."""
    helper = HELPERS[kind]
    answering.DEFAULT_DELAY_S = helper.delay_s
    drawn = draw(world, seed, min(MOST_LEAVES[world], 8))
    settings = Settings(port=0, journal=Path(IN_MEMORY), log_level="error", speech_voice="none")
    request = RunRequest(
        tree="random",
        world=world,
        speed="max",
        seed=seed,
        answers=helper.answers,
        interventions="random",
        person=helper.person,
    )
    scenes = {} if drawn.scene is None else {"random": drawn.scene}
    given = given_documents({"random": drawn.tree}, scenes)
    async with open_service(settings, given=given) as service:
        watched = WatchedWorld(service.journal)
        run = (await service.runtime.start_run(request)).id
        view = await asyncio.wait_for(service.runtime.wait_for_end(run), 600.0)
        events = await service.journal.read(0, 1_000_000, run)
        snapshot = await service.journal.world(run)
    started = events[0]
    assert isinstance(started, ev.RunStarted), "a run begins with run_started"
    judge = DialogueJudge(events, watched.moments(events))
    untruths = judge.judge()
    ending = find_untruths(events, where_parts_rest(started, snapshot))
    untruths += [Untruth(events[-1].seq, "the end", each) for each in ending]
    if show:
        _print(events)
    return Outcome(
        helper=kind,
        seed=seed,
        status=str(view.status),
        dialogues=sum(isinstance(each, ev.DialogueOpened) for each in events),
        sentences=judge.sentences,
        left_out=sum(isinstance(each, ev.NodeLeftOut) for each in events),
        helped=sum(isinstance(each, ev.Resolved) and each.helped for each in events),
        untruths=untruths,
        broken=broken_constraints(events, kinds_of(started)),
    )


def _print(events: Sequence[ev.Event]) -> None:
    for each in events:
        told = each.model_dump(
            mode="json", exclude={"wall_time", "run", "tree", "scene", "options"}
        )
        kept = {key: value for key, value in told.items() if value not in (None, "", [], {})}
        for key in ("time", "seq", "type", "dialogue", "prompt", "execution", "candidates"):
            kept.pop(key, None)
        print(f"{each.seq:5} {each.time:8.2f} {told['type']:20} {kept}")


def print_table(outcomes: Sequence[Outcome]) -> None:
    """What came of the runs, for each kind of helper."""
    heads = ("helper", "runs", "finished", "dialogues", "sentences", "helped", "left out", "untrue")
    print("".join(f"{head:>14}" for head in heads))
    for kind in (*HELPERS, "all"):
        some = [each for each in outcomes if kind in (each.helper, "all")]
        figures = (
            len(some),
            sum(each.status == "finished" for each in some),
            sum(each.dialogues for each in some),
            sum(each.sentences for each in some),
            sum(each.helped for each in some),
            sum(each.left_out for each in some),
            sum(len(each.untruths) + len(each.broken) for each in some),
        )
        print(f"{kind:>14}" + "".join(f"{each:>14}" for each in figures))
    kinds = Counter(each.why for outcome in outcomes for each in outcome.untruths)
    for why, count in kinds.most_common(10):
        print(f"{count:4} x {why}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=20, help="for each kind of helper")
    parser.add_argument("--world", choices=sorted(MOST_LEAVES), default="tabletop")
    parser.add_argument("--seed", type=int, default=0, help="the first run's seed")
    parser.add_argument("--helper", choices=sorted(HELPERS), nargs="*", default=list(HELPERS))
    parser.add_argument("--replay", type=int, help="run this seed only, and print its events")
    arguments = parser.parse_args()
    logging.disable(logging.CRITICAL)
    seeds = range(arguments.seed, arguments.seed + arguments.runs)
    if arguments.replay is not None:
        seeds = range(arguments.replay, arguments.replay + 1)
    outcomes = []
    for seed in seeds:
        for kind in arguments.helper:
            show = arguments.replay is not None
            outcome = asyncio.run(run_once(arguments.world, kind, seed, show=show))
            outcomes.append(outcome)
            for untruth in outcome.untruths:
                print(f"seed {seed}, {kind}, event {untruth.seq}: {untruth.what!r}: {untruth.why}")
            for broken in outcome.broken:
                print(f"seed {seed}, {kind}: {broken}")
            print(".", end="", file=sys.stderr, flush=True)
    print_table(outcomes)
    return int(any(each.untruths or each.broken for each in outcomes))


if __name__ == "__main__":
    sys.exit(main())
