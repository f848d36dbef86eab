# ruff: noqa: T201
"""Durable events per second: 256 producers with group commit against one transaction per event."""

import argparse
import asyncio
import sqlite3
import statistics
import tempfile
import time
from datetime import UTC, datetime
from pathlib import Path
from uuid import UUID, uuid4

from mend.server.journal.events import RobotLost
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal

EVENT_BYTES = 1024


def event(run: UUID) -> RobotLost:
    """An event of about 1 KB, of a kind that neither begins nor ends a run, as nearly all are."""
    return RobotLost(
        time=1.5,
        wall_time=datetime(2026, 1, 1, tzinfo=UTC),
        run=run,
        robot="arm",
        reason="r" * (EVENT_BYTES - 144),
    )


async def grouped(path: Path, producers: int, each: int) -> tuple[float, list[float]]:
    """Events per second and every append's latency in seconds."""
    journal = SqliteJournal(path)
    latencies: list[float] = []

    async def produce() -> None:
        run = uuid4()
        for _ in range(each):
            began = time.perf_counter()
            await journal.append(Entry(events=[event(run)]))
            latencies.append(time.perf_counter() - began)

    began = time.perf_counter()
    await asyncio.gather(*(produce() for _ in range(producers)))
    seconds = time.perf_counter() - began
    assert journal.head == producers * each
    journal.close()
    return producers * each / seconds, latencies


def one_by_one(path: Path, count: int) -> float:
    """Events per second with one durable transaction each, straight on the driver."""
    connection = sqlite3.connect(path, isolation_level=None)
    connection.execute("PRAGMA journal_mode=WAL")
    connection.execute("PRAGMA synchronous=FULL")
    connection.execute("CREATE TABLE events (seq INTEGER PRIMARY KEY, body TEXT)")
    run = uuid4()
    began = time.perf_counter()
    for seq in range(1, count + 1):
        body = event(run).model_copy(update={"seq": seq}).model_dump_json()
        connection.execute("INSERT INTO events (seq, body) VALUES (?, ?)", (seq, body))
    seconds = time.perf_counter() - began
    connection.close()
    return count / seconds


def main() -> None:
    """Measure both in one run and print the ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a smoke run")
    parser.add_argument("--producers", type=int, default=256)
    quick = parser.parse_args().quick
    producers = parser.parse_args().producers
    each, rounds, singles = (20, 1, 300) if quick else (200, 3, 3000)
    rates, latencies, peers = [], [], []
    with tempfile.TemporaryDirectory(dir=Path.cwd()) as folder:
        for number in range(rounds):
            rate, seconds = asyncio.run(grouped(Path(folder) / f"g{number}.db", producers, each))
            rates.append(rate)
            latencies += seconds
            peers.append(one_by_one(Path(folder) / f"s{number}.db", singles))
    percentiles = statistics.quantiles(latencies, n=100)
    p50_ms, p99_ms = percentiles[49] * 1e3, percentiles[98] * 1e3
    grouped_rate, peer_rate = statistics.median(rates), statistics.median(peers)
    print(f"event size                      {len(event(uuid4()).model_dump_json())} bytes")
    print(f"group commit, {producers:4} producers    {grouped_rate:10,.0f} events/s")
    print(f"  append latency p50 / p99      {p50_ms:.1f} / {p99_ms:.1f} ms")
    print(f"one transaction per event       {peer_rate:10,.0f} events/s")
    print(f"ratio                           {grouped_rate / peer_rate:10.1f}")


if __name__ == "__main__":
    main()
