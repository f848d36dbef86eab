"""The benchmark of chaos in small, and that the one who compares notices what is wrong."""

import http.client
import json
import os
import socket
import sqlite3
import threading
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest
from chaos import misses, report
from chaos_ledger import NO_RUN, Ledger, Row, _broken_leaves
from chaos_lives import Footprint, Lives
from chaos_ordeal import Findings, Ordeal
from chaos_place import chaos_place
from chaos_probe import is_healthy
from chaos_witness import AnswerAttempt, RunAttempt, Witness
from full_disk import small_disk
from made_up_history import write_history

RUNS = 3
STEPS = 5
RUNS_AT_A_TIME = 2
SEED = 16
"""Draws faults of every family within so few."""

FAMILIES = (
    {"full disk", "failing writes", "journal moved away", "service killed on full disk"},
    {"service killed", "service killed on full disk"},
    {"robot killed", "robot stopped", "hostile robot"},
    {"clock jump"},
    {"descriptors exhausted", "half-sent requests", "stuck helpers", "wrong tokens"},
)


@pytest.mark.slow(12)
@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount a disk of its own")
async def test_a_service_among_faults_loses_doubles_and_invents_nothing(tmp_path: Path) -> None:
    told: list[str] = []
    with small_disk(tmp_path / "disk", 256) as disk:
        async with chaos_place(tmp_path, disk, seed=SEED, most_stop_s=0.5) as place:
            found = await Ordeal(place, RUNS_AT_A_TIME, tell=told.append).go_through(
                lambda faults: faults < STEPS
            )
    assert found.faults == []
    assert found.counts.total() >= STEPS
    for kinds in FAMILIES:
        assert kinds & set(found.counts), f"none of {kinds}"
    assert found.runs >= RUNS_AT_A_TIME
    assert found.events > 0
    assert len(found.lives.each) > 1
    assert found.lives.worst is not None
    assert found.lives.worst.last is not None
    assert found.lives.worst.last.processes == 1
    assert found.latencies_s


def takes(rss_mb: float) -> Footprint:
    return Footprint(rss_mb, processes=1, descriptors=20, threads=4)


def test_growth_is_told_of_the_life_that_grew_most_and_not_over_a_kill() -> None:
    lives = Lives()
    for pid, rss_mb, ended, at_s in (
        (7, 100.0, 0, 0.0), (7, 400.0, 1, 5.0), (7, 450.0, 2, 9.0), (7, 460.0, 2, 10.0),
        (8, 100.0, 2, 12.0), (8, 200.0, 3, 13.0), (8, 700.0, 5, 42.0), (8, 600.0, 5, 53.0),
        (9, 100.0, 5, 60.0), (9, 900.0, 5, 61.0),
    ):  # fmt: skip
        lives.note(pid, takes(rss_mb), ended, at_s)
    assert [life.grown_mb for life in lives.each] == [60.0, 400.0, 0.0]
    assert lives.worst is lives.each[1]
    assert lives.worst.lasted_s == 40.0
    assert lives.most_rss_mb == 900.0
    found = Findings(lives=lives, latencies_s=[0.01])
    assert misses(found) == ["the process grew by 400 MB within one life of 40 s, 300 are allowed"]
    assert "none grew by more than 400 MB, which took it 40 s" in report(found)


@pytest.mark.parametrize(
    ("status", "healthy"), [(200, True), (204, False), (429, False), (500, False), (503, False)]
)
def test_only_an_answer_of_200_says_that_the_service_is_well(status: int, healthy: bool) -> None:
    class Answers(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(status)
            self.end_headers()
            self.wfile.write(b"" if status == 204 else b"{}")

        def log_message(self, *_: object) -> None:
            pass

    with HTTPServer(("127.0.0.1", 0), Answers) as server:
        answering = threading.Thread(target=server.handle_request)
        answering.start()
        connection = http.client.HTTPConnection("127.0.0.1", server.server_port)
        assert is_healthy(connection, {}) is healthy
        connection.close()
        answering.join()


def test_a_service_that_is_not_there_is_not_well() -> None:
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))
        connection = http.client.HTTPConnection("127.0.0.1", nobody.getsockname()[1])
        assert not is_healthy(connection, {})


@pytest.fixture
def journal(tmp_path: Path) -> Path:
    path = tmp_path / "journal.db"
    write_history(path, RUNS, pictures=False)
    with closing(sqlite3.connect(path)) as connection, connection:
        # Its runs all have one seed, by which a run is told from another.
        for number, (seq, body) in enumerate(
            connection.execute("SELECT seq, body FROM events WHERE type = 'run_started'").fetchall()
        ):
            changed = json.dumps({**json.loads(body), "seed": number})
            connection.execute("UPDATE events SET body = ? WHERE seq = ?", (changed, seq))
    return path


def alter(path: Path, statement: str) -> None:
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute(statement)


def witness_of(path: Path) -> Witness:
    """Somebody who saw all that is there."""
    rows = Ledger(path).rows
    return Witness(
        heard={"anna": [row.body for row in rows if row.run != NO_RUN]},
        answers=[
            AnswerAttempt(r.body["helper"], r.body["prompt"], r.body["answer"], "accepted")
            for r in rows
            if r.kind == "answered"
        ],
        runs=[
            RunAttempt(r.body["seed"], "accepted", r.run) for r in rows if r.kind == "run_started"
        ],
    )


def other_faults(path: Path, witness: Witness) -> list[str]:
    """What is wrong, besides that the seeds above are not those that were committed."""
    told = Ledger(path).faults(witness)
    return [each for each in told if "not those that were committed" not in each]


def test_nothing_is_wrong_with_what_is_right(journal: Path) -> None:
    witness = witness_of(journal)
    assert len(witness.runs) == RUNS
    assert witness.answers
    assert other_faults(journal, witness) == []


def test_a_changed_event_is_noticed(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    write_history(path, RUNS, pictures=False)
    assert list(Ledger(path)._broken_chain()) == []
    alter(path, "UPDATE events SET time = time + 1 WHERE type = 'node_done'")
    assert any("not those that were committed" in each for each in Ledger(path)._broken_chain())


LAST = "(SELECT max(seq) FROM events)"


@pytest.mark.parametrize(
    ("statement", "told"),
    [
        ("DELETE FROM events WHERE seq = 3", "event 3 is not there"),
        (f"DELETE FROM events WHERE seq = {LAST}", "ends, and its last event is"),
        (f"DELETE FROM batches WHERE last = {LAST}", "the chain ends with event"),
        ("UPDATE batches SET link = zeroblob(16) WHERE first = 1", "the chain is broken"),
        ("UPDATE events SET type = 'run_paused' WHERE type = 'run_started'", "has 0 starts"),
        ("UPDATE runs SET status = 'running'", "and the index: "),
        ("UPDATE dialogues SET closed = NULL", "disagree about dialogues"),
        ("UPDATE events SET time = -1 WHERE type = 'answered'", "the clock of run"),
    ],
)
def test_what_is_wrong_with_the_journal_is_noticed(
    journal: Path, statement: str, told: str
) -> None:
    witness = witness_of(journal)
    alter(journal, statement)
    assert any(told in each for each in other_faults(journal, witness))


def _lose_an_event(witness: Witness) -> None:
    del witness.heard["anna"][4]


def _hear_twice(witness: Witness) -> None:
    witness.heard["anna"].insert(4, witness.heard["anna"][4])


def _hear_another(witness: Witness) -> None:
    witness.heard["anna"][4] = {**witness.heard["anna"][4], "time": -1.0}


def _refuse_an_answer(witness: Witness) -> None:
    witness.answers[0] = replace(witness.answers[0], outcome="refused")


def _accept_an_answer(witness: Witness) -> None:
    witness.answers.append(AnswerAttempt("bert", "a prompt", "yes", "accepted"))


def _forget_an_answer(witness: Witness) -> None:
    del witness.answers[0]


def _refuse_a_run(witness: Witness) -> None:
    witness.runs[0] = replace(witness.runs[0], outcome="refused")


def _accept_a_run(witness: Witness) -> None:
    witness.runs.append(RunAttempt(99, "accepted", "another"))


def _forget_a_run(witness: Witness) -> None:
    del witness.runs[0]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (_lose_an_event, "lost [5]"),
        (_hear_twice, "doubled [5]"),
        (_hear_another, "heard another event 5"),
        (_refuse_an_answer, "was refused, and is in the journal"),
        (_accept_an_answer, "was accepted, the journal has None"),
        (_forget_an_answer, "nobody called"),
        (_refuse_a_run, "was refused, and is in the journal"),
        (_accept_a_run, "was accepted, and the journal has None"),
        (_forget_a_run, "nobody asked for run"),
    ],
)
def test_what_clients_saw_otherwise_is_noticed(
    journal: Path, change: Callable[[Witness], None], told: str
) -> None:
    witness = witness_of(journal)
    change(witness)
    assert any(told in each for each in other_faults(journal, witness))


@pytest.mark.parametrize(
    ("kinds", "told"),
    [
        (["node_started", "node_done", "node_undone", "node_started"], 0),
        (["node_started", "node_reset", "node_started", "node_done"], 0),
        (["node_started", "node_left_out", "node_undone", "node_started"], 0),
        (["node_started", "node_started"], 1),
        (["node_done"], 1),
    ],
)
def test_a_leaf_is_started_only_while_it_is_not_active(kinds: list[str], told: int) -> None:
    rows = [Row(seq, "r", kind, 0.0, 1, "", {"node": "/0"}) for seq, kind in enumerate(kinds)]
    assert len(list(_broken_leaves("r", rows))) == told
