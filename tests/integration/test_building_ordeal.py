"""Anything happens in a building whose service is killed, and what it says is true.

A small sample: `benchmarks/building_ordeal.py` has more of them, and larger ones.
"""

import json
from pathlib import Path
from typing import Any

import pytest
from forked_mend import FORKED
from ordeal_of_building import BuildingOrdeal, Drawn
from sampled import sample

SMALL = Drawn(seed=9, floors=1, rooms=6, robots=2, localizer="exact", apart=True, battery_wh=0.0)
MINUTES, EVENTS = sample((0.2, 5), (0.4, 10))
"""So long things happen, in which both kills come, and more than so many do."""


def read(truth: Path) -> list[dict[str, Any]]:
    return [json.loads(each) for each in truth.read_text().splitlines()]


@pytest.mark.slow(20)
async def test_what_a_service_says_is_true_whatever_happens_and_whoever_is_killed(
    tmp_path: Path,
) -> None:
    ordeal = BuildingOrdeal(SMALL, tmp_path, minutes=MINUTES, kills=2, speed=20.0, forked=FORKED)
    assert {each.whom for each in ordeal.kills} == {"service", "robots"}
    outcome = await ordeal.go_through()
    assert outcome.findings == []
    counts = outcome.counts
    assert counts["leg done"] > 0
    assert counts["plan checked"] > 0
    assert outcome.events > EVENTS

    lines = read(ordeal.truth)
    killed = [each for each in lines if each["what"] == "killed"]
    assert [(e["due_s"], e["whom"]) for e in killed] == [(e.at_s, e.whom) for e in ordeal.kills]
    assert all(each["t"] >= each["due_s"] for each in killed)
    assert counts["killed service"] >= 1
    assert counts["killed robots"] == 1
    assert counts["life of the world"] > len(killed)

    elsewhere = ["F1", 1e6, 1e6]
    untrue = [
        {**each, "robots": [elsewhere for _ in each["robots"]]} if "robots" in each else each
        for each in lines
    ]
    told = tmp_path / "told.jsonl"
    told.write_text("".join(json.dumps(each) + "\n" for each in untrue))
    noticed = ordeal.ledger(told).faults()
    assert any("is said to be done, and its robot was" in each for each in noticed)
