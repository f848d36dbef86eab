"""What really happened in a building whose service is killed, as an ordeal's ledger reads it."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from ordeal_ledger import Truth


def written(folder: Path, lines: Iterable[dict[str, Any]]) -> Path:
    """A truth of these lines."""
    file = folder / "told.jsonl"
    file.write_text("".join(json.dumps(each) + "\n" for each in lines))
    return file


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
