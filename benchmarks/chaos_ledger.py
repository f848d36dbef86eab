"""Reads a journal with code of its own, and compares it with what clients saw.

Nothing of Mend is imported here: what the journal is to be like is written down once more, after
docs/journal.md.
"""

import hashlib
import json
import sqlite3
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from chaos_witness import Witness

NO_RUN = "00000000-0000-0000-0000-000000000000"
ENDS = ("run_finished", "run_failed", "run_aborted")
DIGEST_BYTES = 16


@dataclass(frozen=True, slots=True)
class Row:
    """An event as it is in the table; `body` is its JSON as it was read."""

    seq: int
    run: str
    kind: str
    time: float
    version: int
    text: str
    body: dict[str, Any]


def last_heard_by_all(file: Path) -> int:
    """The last event of a run so far."""
    with closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as connection:
        (last,) = connection.execute(
            "SELECT max(seq) FROM events WHERE run != ?", (NO_RUN,)
        ).fetchone()
    return int(last or 0)


class Ledger:
    """A journal's events, and the sentences about what is wrong with them."""

    def __init__(self, file: Path) -> None:
        with closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as connection:
            self._pages = [row[0] for row in connection.execute("PRAGMA integrity_check")]
            found = connection.execute(
                "SELECT seq, run, type, time, version, body FROM events ORDER BY seq"
            )
            self.rows = [Row(*row, json.loads(row[5])) for row in found]
            self._batches = connection.execute(
                "SELECT first, last, written, kept, link FROM batches ORDER BY last"
            ).fetchall()
            self._index = connection.execute("SELECT run, status, ended FROM runs").fetchall()
            self._dialogues = connection.execute(
                "SELECT dialogue, closed FROM dialogues"
            ).fetchall()
        self.by_seq = {row.seq: row for row in self.rows}

    @property
    def endings(self) -> Counter[str]:
        """How often runs ended in which way."""
        return Counter(row.kind for row in self.rows if row.kind in ENDS)

    def faults(self, witness: Witness) -> list[str]:
        """One sentence per thing that is lost, doubled, invented or broken."""
        return [
            *self.faults_of_events(witness),
            *self._against_runs(witness),
            *self._against_answers(witness),
        ]

    def faults_of_events(self, witness: Witness) -> list[str]:
        """What is wrong with the events themselves, and with what followers heard of them."""
        return [
            *self._broken_pages(),
            *self._gaps(),
            *self._broken_chain(),
            *self._broken_runs(),
            *self._broken_dialogues(),
            *(each for name in witness.heard for each in self._against_heard(witness, name)),
        ]

    # --- The journal alone --------------------------------------------------------------------

    def _broken_pages(self) -> Iterator[str]:
        if self._pages != ["ok"]:
            yield f"SQLite finds fault with the pages: {self._pages[:3]}"

    def _gaps(self) -> Iterator[str]:
        for expected, row in enumerate(self.rows, start=1):
            if row.seq != expected:
                yield f"event {expected} is not there: {row.seq} follows {expected - 1}"
                return
        for row in self.rows:
            told = row.body.get("seq"), row.body.get("run"), row.body.get("type")
            if told != (row.seq, row.run, row.kind):
                yield f"event {row.seq} says of itself {told}"

    def _broken_chain(self) -> Iterator[str]:
        link, last = bytes(DIGEST_BYTES), 0
        for first, through, written, _, told in self._batches:
            if first != last + 1:
                yield f"the batch from event {first} follows one that ends with {last}"
            lines = "".join(
                f"{row.seq} {row.run} {row.kind} {row.time + 0.0!r} {row.version} {row.text}\n"
                for row in (self.by_seq.get(seq) for seq in range(first, through + 1))
                if row is not None
            )
            if _digest(lines.encode()) != written:
                yield f"the events {first} to {through} are not those that were committed"
            link, last = _digest(link + written), through
            if link != told:
                yield f"the chain is broken at event {through}"
        if self.rows and last != self.rows[-1].seq:
            yield f"the chain ends with event {last}, the journal with {self.rows[-1].seq}"

    def _broken_runs(self) -> Iterator[str]:
        of_run: dict[str, list[Row]] = defaultdict(list)
        for row in self.rows:
            if row.run != NO_RUN:
                of_run[row.run].append(row)
        indexed = {run: (status, ended) for run, status, ended in self._index}
        if set(indexed) != set(of_run):
            yield f"the index and the events disagree about {set(indexed) ^ set(of_run)}"
        for run, rows in of_run.items():
            kinds = Counter(row.kind for row in rows)
            if kinds["run_started"] != 1 or rows[0].kind != "run_started":
                yield f"run {run} has {kinds['run_started']} starts, and begins with {rows[0].kind}"
            ends = [row for row in rows if row.kind in ENDS]
            if len(ends) != 1 or rows[-1].kind not in ENDS:
                yield f"run {run} has {len(ends)} ends, and its last event is {rows[-1].kind}"
            elif indexed.get(run) != (ends[0].kind.removeprefix("run_"), ends[0].seq):
                yield f"run {run} ended with event {ends[0].seq}, and the index: {indexed.get(run)}"
            if any(after.time < before.time for before, after in pairwise(rows)):
                yield f"the clock of run {run} goes back"
            yield from _broken_leaves(run, rows)

    def _broken_dialogues(self) -> Iterator[str]:
        opened = Counter(r.body["dialogue"] for r in self.rows if r.kind == "dialogue_opened")
        closed = Counter(r.body["dialogue"] for r in self.rows if r.kind == "dialogue_closed")
        if opened != closed or set(opened.values()) - {1}:
            yield f"dialogues were not opened and closed once each: {(opened - closed) or opened}"
        if {dialogue for dialogue, ended in self._dialogues if ended} != set(closed):
            yield "the index and the events disagree about dialogues"

    # --- Against what clients saw -------------------------------------------------------------

    def _against_runs(self, witness: Witness) -> Iterator[str]:
        started = {r.body["seed"]: r.run for r in self.rows if r.kind == "run_started"}
        seeds = Counter(r.body["seed"] for r in self.rows if r.kind == "run_started")
        yield from (
            f"the run with seed {seed} is there {n} times" for seed, n in seeds.items() if n > 1
        )
        asked = {each.seed: each for each in witness.runs}
        for seed in started.keys() - asked.keys():
            yield f"nobody asked for run {started[seed]}"
        for each in witness.runs:
            if each.outcome == "accepted" and started.get(each.seed) != each.run:
                yield f"run {each.run} was accepted, and the journal has {started.get(each.seed)}"
            if each.outcome == "refused" and each.seed in started:
                yield f"run {started[each.seed]} was refused, and is in the journal; {each.said}"

    def _against_answers(self, witness: Witness) -> Iterator[str]:
        answered = [row.body for row in self.rows if row.kind == "answered"]
        kept = {(each["helper"], each["prompt"]): each["answer"] for each in answered}
        for prompt, times in Counter(each["prompt"] for each in answered).items():
            if times > 1:
                yield f"prompt {prompt} was answered {times} times"
        attempts = {(each.helper, each.prompt): each for each in witness.answers}
        for key in kept.keys() - attempts.keys():
            yield f"nobody called {key[0]} answered prompt {key[1]}"
        for key, each in attempts.items():
            if each.outcome == "accepted" and kept.get(key) != each.answer:
                yield f"an answer of {each.helper} was accepted, the journal has {kept.get(key)}"
            if each.outcome == "refused" and key in kept:
                yield f"the answer of {each.helper} was refused, and is in the journal"

    def _against_heard(self, witness: Witness, name: str) -> Iterator[str]:
        expected = [row.seq for row in self.rows if row.run != NO_RUN]
        seqs = [event["seq"] for event in witness.heard[name]]
        if seqs != expected:
            lost = sorted(set(expected) - set(seqs))
            invented = sorted(set(seqs) - set(expected))
            doubled = [seq for seq, times in Counter(seqs).items() if times > 1]
            yield (
                f"{name} did not hear every event once and in order: lost {lost[:5]}, invented "
                f"{invented[:5]}, doubled {doubled[:5]}"
            )
        for event in witness.heard[name]:
            row = self.by_seq.get(event["seq"])
            if row is not None and event != row.body:
                yield f"{name} heard another event {row.seq} than the journal has"


def _broken_leaves(run: str, rows: list[Row]) -> Iterator[str]:
    """A leaf is done or put back only while it is active, and started only while it is not."""
    active: set[str] = set()
    for row in rows:
        node = row.body.get("node")
        if row.kind == "node_started":
            if node in active:
                yield f"run {run} starts {node} at event {row.seq}, which is active"
            active.add(node or "")
        elif row.kind in ("node_done", "node_reset"):
            if node not in active:
                does = "puts back" if row.kind == "node_reset" else "is done with"
                yield f"run {run} {does} {node} at event {row.seq}, which is not active"
            active.discard(node or "")
        elif row.kind == "node_left_out":
            # For the tree it is done: it may be taken back, and started again, as any other.
            active.discard(node or "")


def _digest(data: bytes) -> bytes:
    return hashlib.sha256(data).digest()[:DIGEST_BYTES]
