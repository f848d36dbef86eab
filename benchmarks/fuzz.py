"""Wrong input for everything that is read: requests, messages of helpers and robots, files.

Valid examples are mutated: what they say, and their bytes. Each part runs in a process of its own
with 512 MB of memory beyond what it has once it is ready. Nothing may end in a 5xx, a traceback or
a crash; what is refused must change nothing, and a robot with a valid credential nothing but its
own run; no request may take more than a second of the processor. The same seed draws the same
mutations; ids and tokens in the examples are new each time.

    python benchmarks/fuzz.py [--mutations 10000] [--seed 1] [--only files rest strangers]

The exit code is 1 if there are findings. There is no peer: what is counted is what must not be.
"""

# ruff: noqa: T201
import argparse
import asyncio
import multiprocessing
import os
import resource
import sys
import tempfile
import time
from collections.abc import Awaitable, Callable
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

import psutil
from fuzz_bench import Bench, bench
from fuzz_files import Found, fuzz_reader, readers
from fuzz_helpers import fuzz_helper
from fuzz_requests import fuzz_requests, fuzz_strangers
from fuzz_robots import fuzz_robot

MEMORY_BYTES = 512 * 1024**2
"""So much more than at the start a process may have."""

MOST_S = 1.0
"""So much of the processor the answer to one request may take."""

SERVICE_PARTS: dict[str, Callable[[Bench, int, int], Awaitable[Found]]] = {
    "rest": partial(fuzz_requests, most_s=MOST_S),
    "strangers": partial(fuzz_strangers, most_s=MOST_S),
    "helper": fuzz_helper,
    "robot": fuzz_robot,
}
PARTS = ("files", *SERVICE_PARTS)
MOST_SHOWN = 10
WARM_UP = 20

Report = Callable[[str, Found], None]


def fuzz_files(mutations: int, seed: int, report: Report) -> None:
    """Have mutated files read by every reader."""
    with tempfile.TemporaryDirectory() as made, tempfile.TemporaryDirectory() as used:
        found = readers(Path(made))
        for reader in found:
            for example in reader.examples:
                (Path(used) / reader.file).write_bytes(example)
        limit_memory()
        for reader in found:
            report(reader.name, fuzz_reader(reader, mutations, seed, Path(used)))


async def fuzz_service(part: str, mutations: int, seed: int, report: Report) -> None:
    """Send mutated requests or messages to a real service."""
    async with bench() as made:
        # What is made once, on the first of anything, belongs to the start.
        await SERVICE_PARTS[part](made, WARM_UP, seed)
        limit_memory()
        report(part, await SERVICE_PARTS[part](made, mutations, seed))


def limit_memory() -> None:
    """From now on this process gets so much more memory, and no more."""
    most = psutil.Process().memory_info().vms + MEMORY_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _work(part: str, mutations: int, seed: int, out: Connection) -> None:
    os.environ = {k: v for k, v in os.environ.items() if not k.startswith("MEND_")}  # type: ignore[assignment]  # noqa: B003

    def report(name: str, found: Found) -> None:
        out.send((name, found))

    if part == "files":
        fuzz_files(mutations, seed, report)
    else:
        asyncio.run(fuzz_service(part, mutations, seed, report))
    out.close()


def run_part(part: str, mutations: int, seed: int) -> int:
    """Run a part in a process of its own and print what it found; returns how many findings."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(part, mutations, seed, there))
    began = time.perf_counter()
    process.start()
    there.close()
    count = 0
    while True:
        try:
            name, found = here.recv()
        except EOFError:
            break
        seconds, began = time.perf_counter() - began, time.perf_counter()
        count += len(found.findings)
        print(
            f"{name:28} {found.tried:7} tried {found.refused:7} refused "
            f"{len(found.findings):5} findings {seconds:7.1f} s",
            flush=True,
        )
        for each in found.findings[:MOST_SHOWN]:
            print(f"    {each}")
    process.join()
    if process.exitcode:
        print(f"    {part}: the process ended with {process.exitcode}")
        count += 1
    return count


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mutations", type=int, default=10_000, help="of each kind of input")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS)
    chosen = parser.parse_args()
    # Each arena reserves addresses that it never uses, which would count.
    os.environ["MALLOC_ARENA_MAX"] = "2"
    count = sum(run_part(part, chosen.mutations, chosen.seed) for part in chosen.only)
    print(f"{count} findings")
    sys.exit(min(count, 1))


if __name__ == "__main__":
    main()
