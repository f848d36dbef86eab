"""Random events happen to dispatchers of drawn buildings, which are killed in the middle, too.

Every event is followed by a check of everything that must hold (`dispatch_ledger.py`): no item
lost or brought twice, no capacity exceeded, every plan passes the checker, statuses only along
legal transitions; in the end nothing waits any more.

    python benchmarks/dispatch_events.py [--events 10000] [--seed 1] [--quick]
"""

# ruff: noqa: T201
import argparse
import time
from collections import Counter

from dispatch_ordeal import DispatchOrdeal

AT_ONCE = 150
"""So many things happen to one building besides what its robots do."""
SIZES = ((1, 8, 2), (2, 8, 3), (3, 12, 5), (4, 16, 8))
"""Floors, rooms on each, robots."""


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--events", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true")
    given = parser.parse_args()
    wanted = 500 if given.quick else given.events
    events, killed, buildings = 0, 0, 0
    ended, done = Counter[str](), Counter[str]()
    began_s, simulated_s = time.process_time(), 0.0
    while events < wanted:
        floors, rooms, robots = SIZES[buildings % len(SIZES)]
        seed = given.seed + buildings
        ordeal = DispatchOrdeal(seed, floors=floors, rooms=rooms, robots=robots)
        try:
            ordeal.happen(AT_ONCE)
            ended += ordeal.come_to_rest()
        except BaseException:
            print(f"seed {seed}, {len(ordeal.events)} events; the last:")
            print("\n".join(ordeal.events[-10:]))
            raise
        events, killed = events + len(ordeal.events), killed + ordeal.killed
        done += ordeal.actions()
        buildings, simulated_s = buildings + 1, simulated_s + ordeal.execution.now_s
        print(f"seed {seed}: {len(ordeal.events)} events", flush=True)
    took_s = time.process_time() - began_s
    print(f"{events} events in {buildings} buildings, {killed} restarts, no check failed")
    print("requests:", ", ".join(f"{count} {name}" for name, count in ended.most_common()))
    print("legs done:", ", ".join(f"{count} {name}" for name, count in done.most_common()))
    print(f"{1000 * took_s / events:.1f} ms of the processor an event, checks included")
    print(f"{simulated_s / 3600.0:.0f} h simulated in {took_s:.0f} s")


if __name__ == "__main__":
    main()
