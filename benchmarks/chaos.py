# ruff: noqa: T201
"""A real service with 20 runs among faults of every kind, drawn at random.

    python benchmarks/chaos.py --minutes 5 --seed 1

Full disks, writes that fail, kills and stops of processes, jumps of the clock, descriptors that run
out, slow and hostile clients, hostile robots. Writes fail by the kernel's limit on the size of
files, which stands for a broken or read-only disk; the wall clock that jumps is the one that the
service is given, as the kernel's is everybody's. At the end a reader of its own compares the
journal with what clients saw: nothing may be lost, doubled or invented, and every run ends; what a
client asked for and got no answer to it asks for again under the same key. Prints how many there
were of each fault, how long `/healthz` took while the service was not stopped, what its process
takes, and the most that it grew by within one of its lives; fails also where that is more than is
wanted. There is no peer: what is measured is that nothing is lost. Needs the right to mount a file
system.
"""

import argparse
import asyncio
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

import numpy as np
from chaos_lives import Footprint, Lives
from chaos_ordeal import Findings, Ordeal
from chaos_place import DISK_MB, chaos_place
from full_disk import small_disk
from numpy.typing import NDArray

MANY_RUNS = 20
WANTED_P99_MS = 250.0
WANTED_GROWTH_MB = 300.0
"""What the worlds of as many runs take that go on at a time."""
LONGEST_STOP_S = 60.0


async def measure(minutes: float, seed: int, runs: int, *, verbose: bool) -> Findings:
    """A service that is disturbed for so long."""
    with (
        tempfile.TemporaryDirectory() as folder,
        small_disk(Path(folder) / "disk", DISK_MB) as disk,
    ):
        most_stop_s = min(LONGEST_STOP_S, minutes * 60 / 4)
        async with chaos_place(Path(folder), disk, seed, most_stop_s) as place:
            tell = _teller() if verbose else lambda _: None
            until = time.monotonic() + minutes * 60
            ordeal = Ordeal(place, runs, tell=tell)
            return await ordeal.go_through(lambda _: time.monotonic() < until)


def _teller() -> Callable[[str], None]:
    began = time.monotonic()
    return lambda what: print(f"{time.monotonic() - began:7.1f} s  {what}", flush=True)


def _takes(when: str, footprint: Footprint | None) -> str:
    if footprint is None:
        return f"{when}: not known"
    return (
        f"{when}: {footprint.rss_mb:.0f} MB, {footprint.processes} process(es), "
        f"{footprint.threads} threads, {footprint.descriptors} descriptors"
    )


def _about(lives: Lives) -> list[str]:
    """What the process took; what it grew by is told of one life, not over a kill."""
    if lives.worst is None:
        return ["what the process takes is not known"]
    return [
        _takes("after the first run", lives.each[0].first),
        _takes("at the end", lives.each[-1].last) + f"; at most {lives.most_rss_mb:.0f} MB",
        f"{len(lives.each)} lives; after the first end of a run in it none grew by more than "
        f"{lives.worst.grown_mb:.0f} MB, which took it {lives.worst.lasted_s:.0f} s",
    ]


def _latencies_ms(found: Findings) -> NDArray[np.float64]:
    return np.array(found.latencies_s or [np.nan]) * 1000


def misses(found: Findings) -> list[str]:
    """One sentence for each figure that is worse than wanted."""
    told = []
    p99 = np.percentile(_latencies_ms(found), 99)
    if not p99 < WANTED_P99_MS:
        told.append(f"the p99 of /healthz is {p99:.0f} ms, {WANTED_P99_MS:.0f} are wanted")
    if found.unanswered:
        told.append(f"{found.unanswered} requests of /healthz were not answered with 200")
    worst = found.lives.worst
    if worst is not None and worst.grown_mb > WANTED_GROWTH_MB:
        told.append(
            f"the process grew by {worst.grown_mb:.0f} MB within one life of "
            f"{worst.lasted_s:.0f} s, {WANTED_GROWTH_MB:.0f} are allowed"
        )
    return told


def report(found: Findings) -> str:
    ms = _latencies_ms(found)
    p50, p99, most = np.percentile(ms, 50), np.percentile(ms, 99), ms.max()
    return "\n".join(
        (
            *(f"{times:5}  {name}" for name, times in sorted(found.counts.items())),
            f"{found.runs} runs ended: " + ", ".join(f"{n} {k}" for k, n in found.endings.items()),
            f"{found.events} events; answers: "
            + ", ".join(f"{n} {kind}" for kind, n in found.answers.items())
            + f"; {found.repeated} requests were answered when they came again",
            f"/healthz: p50 {p50:.1f} ms, p99 {p99:.1f} ms, max {most:.0f} ms over {ms.size} "
            f"requests; {found.unanswered} not answered",
            *_about(found.lives),
            f"{len(found.faults)} things are wrong",
            *found.faults,
            *misses(found),
        )
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=5.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=MANY_RUNS, help="that go on at a time")
    parser.add_argument("--verbose", action="store_true", help="tell each fault as it begins")
    told = parser.parse_args()
    # Whoever ends it early leaves no service and no file system behind.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    found = asyncio.run(measure(told.minutes, told.seed, told.runs, verbose=told.verbose))
    print(report(found))
    sys.exit(1 if found.faults or misses(found) else 0)


if __name__ == "__main__":
    main()
