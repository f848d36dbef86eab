"""Anything happens in drawn buildings whose services and robots are killed: what goes wrong?

    python benchmarks/building_ordeal.py [--first 1] [--buildings 4] [--minutes 10] [--kills 4]
        [--speed 20] [--at-once 2] [--keep FOLDER] [--verbose] [--quick]

Each building has 2 to 5 robots and a real service, which takes random requests of all kinds over
REST. Robots are taken out of service and put back, ways are barred and cleared, some are told to be
closed that are not, requests are cancelled and changed, things are stolen from baskets (also over
REST), people step in the way, robots are carried away. Whom robots ask is willing, unwilling,
silent or rude, forgets things, does not do what they said, or lies about where a robot is. The
service, or robots where they are in a process of their own, are killed (`kill -9`) at drawn moments
of the site's clock, as a thing changes hands, or as a robot charges (those of every third building
have to), and start again on what they kept. Then all is put
right, and everything has to come to its end. The ledger (`ordeal_ledger.py`) compares what the
journal says with what the world really was.

An event is one of what happens, one question that somebody was asked, one leg or errand that has
ended, one robot carried away, one theft, or one kill. `minutes` are of the sites' clocks. Building
and draws are the same for the same seed, and so is when kills come by the world's clock, on any
machine; what else comes when is not. The exit code is 1
where anything was found.
"""

# ruff: noqa: T201
import argparse
import asyncio
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from ordeal_of_building import BuildingOrdeal, Drawn, Outcome

SHOWN = ("happened: ", "people: ", "killed ", "leg ", "request ", "done ")


async def one(seed: int, options: argparse.Namespace) -> Outcome:
    """What one building has come to; what it kept stays where `--keep` says."""
    with ExitStack() as stack:
        if options.keep is None:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        else:
            folder = options.keep / str(seed)
            folder.mkdir(parents=True)
        drawn = Drawn.of(seed)

        def tell(what: str) -> None:
            if options.verbose:
                print(f"{seed}: {what}", flush=True)

        speed = options.speed or "max"
        ordeal = BuildingOrdeal(drawn, folder, options.minutes, options.kills, tell, speed)
        return await ordeal.go_through()


async def all_of(seeds: Sequence[int], options: argparse.Namespace) -> list[Outcome]:
    """Some buildings at a time."""
    room = asyncio.Semaphore(options.at_once)

    async def with_room(seed: int) -> Outcome:
        async with room:
            outcome = await one(seed, options)
        print(row(outcome), flush=True)
        for each in outcome.findings:
            print(f"    seed {seed}: {each}", flush=True)
        return outcome

    return await asyncio.gather(*(with_room(seed) for seed in seeds))


def row(outcome: Outcome) -> str:
    counts = outcome.counts
    kills = counts["killed service"] + counts["killed robots"]
    return (
        f"{outcome.drawn}: {outcome.events} events, {kills} kills, "
        f"{outcome.simulated_s / 60.0:.0f} min, {outcome.settled_s / 60.0:.0f} of them to rest, "
        f"{counts['plan checked']} plans checked, {len(outcome.findings)} findings"
    )


def told(counts: Counter[str], prefix: str) -> str:
    named = [
        (n, what.removeprefix(prefix)) for what, n in counts.items() if what.startswith(prefix)
    ]
    return ", ".join(f"{n} {what}" for n, what in sorted(named, reverse=True))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--first", type=int, default=1, metavar="SEED")
    parser.add_argument("--buildings", type=int, default=4)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--kills", type=int, default=4)
    parser.add_argument("--speed", type=float, help="times as fast as clocks go; else all it can")
    parser.add_argument("--at-once", type=int, default=2)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--verbose", action="store_true")
    parser.add_argument("--quick", action="store_true", help="one building, two minutes, one kill")
    options = parser.parse_args()
    if options.quick:
        options.buildings, options.minutes, options.kills = 1, 2.0, 1
    seeds = range(options.first, options.first + options.buildings)
    kept = [options.keep / str(each) for each in seeds] if options.keep else []
    if there := [str(each) for each in kept if each.exists()]:
        parser.error(f"--keep: {', '.join(there)} is there already; name a folder without it")
    began_s = time.monotonic()
    outcomes = asyncio.run(all_of(seeds, options))
    counts = sum((each.counts for each in outcomes), Counter[str]())
    found = sum(len(each.findings) for each in outcomes)
    simulated_h = sum(each.simulated_s for each in outcomes) / 3600.0
    print(
        f"{sum(each.events for each in outcomes)} events in {len(outcomes)} buildings, "
        f"{simulated_h:.1f} h simulated in {(time.monotonic() - began_s) / 60.0:.0f} min, "
        f"{counts['plan checked']} plans checked, "
        f"{counts['event of the journal']} events of journals: {found} findings"
    )
    for prefix in SHOWN:
        print(f"{prefix.strip(' :')}: {told(counts, prefix)}")
    others = ("carried", "stolen", "taken by who it was not for", "promise not kept")
    print("besides:", ", ".join(f"{counts[each]} {each}" for each in others))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
