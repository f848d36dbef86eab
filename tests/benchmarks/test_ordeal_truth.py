"""What really happened in a building whose service is killed, as an ordeal's ledger reads it."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from ordeal_truth import Truth


def written(folder: Path, lines: Iterable[dict[str, Any]]) -> Path:
    """A truth of these lines."""
    file = folder / "told.jsonl"
    file.write_text("".join(json.dumps(each) + "\n" for each in lines))
    return file


WITH_ANN: dict[str, Any] = {"tea": ["F1-101", None, False, False, 0.5]}
IN_BASKET: dict[str, Any] = {"tea": [None, 0, False, False, 0.5]}


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


def basket(**lost: str) -> dict[str, Any]:
    """Tea and jam, which weigh about the same, a sofa, and where those are that were lost."""
    weighs = {"tea": 0.5, "jam": 0.58, "sofa": 1.9}
    return {
        name: [lost.get(name), None if name in lost else 0, False, False, kg]
        for name, kg in weighs.items()
    }


@pytest.mark.parametrize(
    ("went", "told"),
    [
        ({"what": "stolen", "item": "tea", "robot": 0, "offers": "tea"}, [6.0]),
        ({"what": "stolen", "item": "jam", "robot": 0, "offers": "tea"}, [6.0]),
        ({"what": "stolen", "item": "sofa", "robot": 0, "offers": "tea"}, []),
        ({"what": "stolen", "item": "tea", "robot": 0, "offers": None}, []),
        ({"what": "stolen", "item": "tea", "robot": 0, "offers": "sofa"}, []),
        ({"what": "items", "items": basket(jam="F1-101")}, [6.0]),
        ({"what": "items", "items": basket(sofa="F1-101")}, []),
    ],
)
def test_no_robot_feels_who_takes_what_it_offers_or_what_weighs_as_much(
    tmp_path: Path, went: dict[str, Any], told: list[float]
) -> None:
    begun = {"t": 0.0, "what": "begun", "items": basket()}
    truth = Truth(written(tmp_path, [begun, {"t": 6.0, **went}]))
    assert list(truth.felt_alike_s("tea")) == told


def test_what_was_in_a_basket_in_a_span_and_just_before(tmp_path: Path) -> None:
    lines = [
        {"t": 0.0, "wall_s": 100.0, "what": "begun", "items": IN_BASKET},
        {"t": 5.0, "wall_s": 101.0, "what": "items", "items": WITH_ANN},
        {"t": 6.0, "wall_s": 102.0, "what": "items", "items": IN_BASKET},
    ]
    truth = Truth(written(tmp_path, lines))
    held, empty = frozenset({"tea"}), frozenset[str]()
    assert list(truth.baskets_between(100.5, 101.5, 0)) == [held, empty]
    assert list(truth.baskets_between(100.5, 101.5, 1)) == [empty, empty]
    assert list(truth.baskets_between(100.2, 100.8, 0)) == [held]


def test_a_span_in_which_nothing_is_told_has_what_was_told_around_it(tmp_path: Path) -> None:
    shut = [(1.0, ["a"]), (2.0, ["b"]), (9.0, ["c"]), (12.0, ["d"])]
    truth = Truth(
        written(
            tmp_path,
            [
                {"t": wall_s, "wall_s": wall_s, "what": "state", "shut": doors, "robots": []}
                for wall_s, doors in shut
            ],
        )
    )
    assert list(truth.shut_between(4.0, 5.0)) == [["b"], ["c"]]
    assert list(truth.shut_between(1.5, 2.5)) == [["a"], ["b"], ["c"]]
    assert list(truth.shut_between(20.0, 21.0)) == [["d"]]
