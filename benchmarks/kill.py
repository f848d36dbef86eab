# ruff: noqa: T201
"""`kill -9` of the service and of a simulated robot's process at random moments of the journal.

Prints for each what became of the runs, what was lost or doubled, and how long it took until the
journal went on. There is no peer: what is measured is that nothing is lost.
"""

import argparse
import asyncio
import statistics
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from kills import Findings, Ordeal, doubled_starts
from service_process import service_process

from mend.server.runtime.requests import RunRequest

QUICK_KILLS = 3


def willing(world: str, seed: int, **fields: object) -> RunRequest:
    """A run whose helper always says yes."""
    return RunRequest.model_validate(
        {
            "tree": "eket", "world": world, "speed": "max", "seed": seed,
            "answers": ["yes"] * 1000, "max_attempts": 100, **fields,
        }
    )  # fmt: skip


async def measure(victim: str, world: str, kills: int, seed: int) -> Findings:
    """Kill one kind of process in runs of one world."""
    with tempfile.TemporaryDirectory() as folder:
        async with service_process(Path(folder)) as service:
            scenario = willing(world, seed, scenario="eket_paper")
            if victim == "robot":
                return await Ordeal(service, [scenario], seed).kill_robots(kills)
            requests = [scenario, willing(world, seed)]
            return await Ordeal(service, requests, seed).kill_service(kills)


async def measure_starts(kills: int) -> list[str]:
    """Kill the service while runs are asked for; half of them are in the journal by then."""
    wrong: list[str] = []
    for committed in (True, False):
        with tempfile.TemporaryDirectory() as folder:
            async with service_process(Path(folder)) as service:
                wrong += await doubled_starts(service, kills // 2 or 1, committed=committed)
    return wrong


def row(victim: str, world: str, found: Findings) -> str:
    times = sorted(found.recoveries_s)
    p50 = statistics.median(times) if times else float("nan")
    p95 = times[min(len(times) - 1, int(len(times) * 0.95))] if times else float("nan")
    return (
        f"{victim:8} {world:9} {found.kills:5} {found.finished:4}/{found.runs:<4}"
        f" {found.events:7} {len(found.lost):5} {len(found.doubled):8} {len(found.broken):7}"
        f" {len(found.missing):8} {p50:8.2f} {p95:8.2f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=50, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_KILLS} kills of each kind")
    parser.add_argument("--victim", choices=["service", "robot"], help="only this one")
    arguments = parser.parse_args()
    kills = QUICK_KILLS if arguments.quick else arguments.kills
    print(
        "killed   world     kills finished  events  lost  doubled  broken  missing   p50 s    p95 s"
    )
    faults: list[str] = []
    for victim, world in [("service", "tabletop"), ("robot", "workcell")]:
        if arguments.victim in (None, victim):
            found = asyncio.run(measure(victim, world, kills, arguments.seed))
            print(row(victim, world, found), flush=True)
            faults += found.faults
    if arguments.victim in (None, "service"):
        doubled = asyncio.run(measure_starts(kills))
        print(f"asked for a run and killed, {kills} times: {len(doubled)} not started once")
        faults += doubled
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
