"""Anything happens in a building whose service is killed, and what it says is true.

A small sample: `benchmarks/building_ordeal.py` has more of them, and larger ones.
"""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from ordeal_ledger import Truth
from ordeal_of_building import BuildingOrdeal, Drawn

SMALL = Drawn(seed=7, floors=1, rooms=6, robots=2, localizer="exact", apart=True)


def written(folder: Path, lines: Iterable[dict[str, Any]]) -> Path:
    """A truth of these lines."""
    file = folder / "told.jsonl"
    file.write_text("".join(json.dumps(each) + "\n" for each in lines))
    return file


@pytest.mark.slow(60)
async def test_what_a_service_says_is_true_whatever_happens_and_whoever_is_killed(
    tmp_path: Path,
) -> None:
    ordeal = BuildingOrdeal(SMALL, tmp_path, minutes=0.75, kills=2)
    outcome = await ordeal.go_through()
    assert outcome.findings == []
    counts = outcome.counts
    assert counts["killed service"] + counts["killed robots"] >= 2
    assert counts["life of the world"] > 1
    assert counts["leg done"] > 0
    assert counts["plan checked"] > 0
    assert outcome.events > 10

    lines = [json.loads(each) for each in ordeal.truth.read_text().splitlines()]
    elsewhere = ["F1", 1e6, 1e6]
    untrue = [
        {**each, "robots": [elsewhere for _ in each["robots"]]} if "robots" in each else each
        for each in lines
    ]
    noticed = ordeal.ledger(written(tmp_path, untrue)).faults()
    assert sum("is said to be done, and its robot was" in each for each in noticed) > 0
    touched = {**lines[-1], "what": "touched", "who": "robot 0 and walker 1", "by_m": 0.02}
    (noticed,) = ordeal.ledger(written(tmp_path, [*lines, touched])).faults()
    assert "touched: robot 0 and walker 1 by 0.020 m" in noticed


WITH_ANN: dict[str, Any] = {"tea": ["F1-101", None, False, False]}
IN_BASKET: dict[str, Any] = {"tea": [None, 0, False, False]}


def test_what_a_kill_undoes_was_not_so(tmp_path: Path) -> None:
    truth = Truth(
        written(
            tmp_path,
            [
                {"t": 0.0, "what": "begun", "items": WITH_ANN},
                {"t": 5.0, "what": "items", "items": IN_BASKET},
                {"t": 4.0, "what": "begun", "items": WITH_ANN},
            ],
        )
    )
    assert truth.faults == []
    assert truth.lives == 2
    assert truth.items == WITH_ANN


@pytest.mark.parametrize("begun", [{"t": 6.0, "items": WITH_ANN}, {"t": 6.0, "items": {}}])
def test_a_kill_that_moves_or_loses_a_thing_is_noticed(
    tmp_path: Path, begun: dict[str, Any]
) -> None:
    lines = [
        {"t": 0.0, "what": "begun", "items": WITH_ANN},
        {"t": 5.0, "what": "items", "items": IN_BASKET},
        {"t": 7.0, "what": "state", "robots": [], "guests": {}},
        {"what": "begun", **begun},
    ]
    (fault,) = Truth(written(tmp_path, lines)).faults
    assert "a kill changed where things are" in fault
