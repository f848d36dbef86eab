"""A service with a past: over REST, damaged in places, and pruned as it is told to."""

import json
import sqlite3
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, closing
from datetime import timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
from made_up_history import BETWEEN_RUNS, made_up_run, picture_id, run_id, write_history
from typer.testing import CliRunner

from mend.server.cli import app
from mend.server.client import MendClient
from mend.server.composition import open_service
from mend.server.retention import KeepSettings
from mend.server.runtime.views import Snapshot
from mend.server.settings import Settings

RUNS = 12
EVENTS = len(made_up_run())


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_history(tmp_path / "journal.db", RUNS, pictures=True)
    return tmp_path


@asynccontextmanager
async def service(folder: Path, **more: Any) -> AsyncIterator[httpx.AsyncClient]:
    settings = Settings(
        port=0, data_dir=folder, speech_voice="none", speech_recognition=False, log_level="error",
        **more,
    )  # fmt: skip
    async with (
        open_service(settings) as opened,
        httpx.AsyncClient(base_url=opened.url, timeout=60) as client,
    ):
        yield client


def alter(folder: Path, statement: str, *parameters: object) -> None:
    with closing(sqlite3.connect(folder / "journal.db")) as connection, connection:
        connection.execute(statement, parameters)


async def test_the_list_goes_on_from_a_run(folder: Path) -> None:
    async with service(folder) as client:
        pages: list[str] = []
        cursor: dict[str, str] = {}
        while page := (await client.get("/api/runs", params={"limit": 5, **cursor})).json():
            pages += [each["id"] for each in page]
            cursor = {"before": pages[-1]}
        assert pages == [str(run_id(n)) for n in reversed(range(RUNS))]
        unknown = await client.get("/api/runs", params={"before": str(picture_id(0))})
        assert unknown.status_code == 404
        assert "after which the list could go on" in unknown.json()["detail"]


async def test_a_run_that_cannot_be_read_is_told_everywhere(folder: Path) -> None:
    last = str(run_id(RUNS - 1))
    alter(folder, "UPDATE events SET body = '{}' WHERE type = 'answered' AND run = ?", last)
    async with service(folder) as client:
        [listed, _] = (await client.get("/api/runs", params={"limit": 2})).json()
        assert (listed["id"], listed["status"]) == (last, "unreadable")
        assert "is damaged" in listed["result"]["reason"]
        view = await client.get(f"/api/runs/{last}")
        assert view.status_code == 500
        assert "is damaged" in view.json()["detail"]
        ready = await client.get("/readyz")
        assert ready.status_code == 200
        assert (ready.json()["status"], ready.json()["unreadable_runs"]) == ("degraded", 1)
        assert ready.json()["damaged"] == 1
        assert "not what was committed" in ready.json()["damage"][0]
        metrics = (await client.get("/metrics")).text
        assert "mend_unreadable_runs 1.0" in metrics
        assert "mend_journal_damage 1.0" in metrics
        assert (await client.get("/api/runs", params={"status": "finished"})).status_code == 200


async def test_strangers_hear_that_something_is_damaged_and_not_what(folder: Path) -> None:
    last = str(run_id(RUNS - 1))
    alter(folder, "UPDATE events SET body = '{}' WHERE type = 'answered' AND run = ?", last)
    async with service(folder, token="secret") as stranger:
        counts = {"unreadable_runs": 1, "unreadable_events": 0, "damaged": 1}
        ready = await stranger.get("/readyz")
        assert ready.json() == {"status": "degraded", **counts, "damage": None}
        known = await stranger.get("/readyz", headers={"Authorization": "Bearer secret"})
        assert "not what was committed" in known.json()["damage"][0]


async def test_an_unreadable_event_of_no_run_is_told_and_hides_no_other(folder: Path) -> None:
    tree = {"name": "first", "tree": {"behavior": "pick_and_place", "object": "a", "place": "b"}}
    names = ["first", "second", "third"]
    async with service(folder) as client:
        for name in names:
            body = {"name": name, "text": json.dumps(tree)}
            assert (await client.post("/api/trees", json=body)).status_code == 201
        deeds = (await client.get("/api/access/deeds")).json()["deeds"]
    second = next(each["seq"] for each in deeds if "'second'" in each["what"])
    alter(folder, "UPDATE events SET body = '{}' WHERE seq = ?", second)
    async with service(folder) as client:
        after = (await client.get("/api/access/deeds")).json()["deeds"]
        assert [each["seq"] for each in after] == [each["seq"] for each in deeds]
        (told,) = [each for each in after if each["deed"] == "unreadable"]
        assert (told["seq"], told["when"], told["run"]) == (second, None, None)
        assert f"event {second} cannot be read" in told["what"]
        ready = (await client.get("/readyz")).json()
        assert (ready["status"], ready["unreadable_events"]) == ("degraded", 1)
        assert "mend_unreadable_events 1.0" in (await client.get("/metrics")).text
    outcome = CliRunner().invoke(app, ["access", "audit", "--journal", str(folder / "journal.db")])
    assert outcome.exit_code == 1
    assert f"event {second} cannot be read" in " ".join(outcome.output.split())


async def test_an_ended_run_that_turns_out_to_be_damaged_is_listed_so_from_then_on(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = str(run_id(0))
    alter(folder, "UPDATE events SET body = '{}' WHERE type = 'answered' AND run = ?", first)
    monkeypatch.setattr("mend.server.journal.quick_check.TAIL_BATCHES", 2)
    async with service(folder) as client:
        assert (await client.get("/readyz")).json()["status"] == "ok"
    for _ in range(2):
        async with service(folder) as client:
            view = await client.get(f"/api/runs/{first}")
            assert view.status_code == 500
            page = (await client.get("/api/runs", params={"status": "unreadable"})).json()
            assert [each["id"] for each in page] == [first]


async def test_a_journal_whose_file_goes_is_not_ready(folder: Path) -> None:
    async with service(folder) as client:
        assert (await client.get("/readyz")).status_code == 200
        (folder / "journal.db").rename(folder / "elsewhere.db")
        gone = await client.get("/readyz")
        assert gone.status_code == 503
        assert "was deleted or moved" in gone.json()["detail"]
        refused = await client.post("/api/runs", json={"tree": "eket", "world": "tabletop"})
        assert refused.status_code == 503


async def test_a_service_prunes_what_it_is_told_not_to_keep(folder: Path) -> None:
    poses = folder / "journal.poses"
    poses.mkdir()
    for number in (0, RUNS - 1):
        (poses / f"{run_id(number)}.poses").write_bytes(b"")
        (poses / f"{run_id(number)}.layout.json").write_text("{}")
    async with service(folder, keep=KeepSettings(runs=2)) as client:
        # The events go after the runs, and a picture with its event.
        last_to_go = f"/api/pictures/{picture_id(RUNS - 3)}"
        while (await client.get(last_to_go)).status_code == 200:
            pass
        for path in ("", "/events", "/layout", "/poses"):
            gone = await client.get(f"/api/runs/{run_id(0)}{path}")
            assert gone.status_code == 404
            assert "ended runs have been pruned" in gone.json()["detail"]
        assert (await client.get(f"/api/pictures/{picture_id(0)}")).status_code == 404
        assert (await client.get(f"/api/pictures/{picture_id(RUNS - 1)}")).status_code == 200
    left = {each.name for each in poses.iterdir()}
    assert left == {f"{run_id(RUNS - 1)}.poses", f"{run_id(RUNS - 1)}.layout.json"}


async def test_a_clock_far_ahead_of_the_last_run_makes_nothing_old(folder: Path) -> None:
    # The last of them ended long ago, or so this machine's clock says; two days keep some of them.
    days = 2 * BETWEEN_RUNS / timedelta(days=1)
    keep = KeepSettings(days=days, runs=RUNS - 1)
    async with service(folder, keep=keep) as client:
        while (await client.get(f"/api/pictures/{picture_id(0)}")).status_code == 200:
            pass
        left = (await client.get("/api/runs")).json()
    assert 1 < len(left) < RUNS


async def test_a_client_that_follows_from_before_what_was_pruned_begins_anew(
    folder: Path,
) -> None:
    async with service(folder, keep=KeepSettings(runs=1)) as client:
        while (await client.get(f"/api/pictures/{picture_id(RUNS - 2)}")).status_code == 200:
            pass
        async with (
            MendClient(str(client.base_url)) as mend,
            mend.follow("anna", after=3) as stream,
        ):
            async for message in stream:
                assert isinstance(message, Snapshot)
                assert message.seq == RUNS * EVENTS
                break
