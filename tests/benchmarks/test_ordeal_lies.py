"""Who was told a lie about where it is goes by that until somebody tells it the truth."""

from datetime import UTC, datetime
from typing import Any

from ordeal_lies import Misled


def asks(number: int, place: str) -> dict[str, Any]:
    return {
        "type": "prompt",
        "prompt": f"p{number}",
        "robot": "one",
        "text": f"I do not know where I am. Am I at {place}?",
    }


def says(number: int, answer: str) -> dict[str, Any]:
    at = datetime.fromtimestamp(100.0 * number, UTC)
    return {
        "type": "answered",
        "prompt": f"p{number}",
        "answer": answer,
        "wall_time": at.isoformat(),
    }


def is_in_kitchen(robot: str, said: str, at_s: float) -> bool:
    del robot, at_s
    return said == "kitchen"


def test_who_believes_a_lie_is_misled_until_they_hear_the_truth() -> None:
    misled = Misled(
        [
            asks(1, "office"), says(1, "yes"),
            {"type": "prompt", "prompt": "other", "robot": "one", "text": "Will you do that?"},
            {"type": "answered", "prompt": "other", "answer": "yes", "wall_time": "never"},
            asks(2, "hall"), says(2, "no"),
            asks(3, "kitchen"), says(3, "yes"),
        ],
        is_in_kitchen,
    )  # fmt: skip
    assert [misled.is_misled("one", at_s) for at_s in (99.0, 100.0, 250.0, 300.0)] == [
        False,
        True,
        True,
        False,
    ]
    assert not misled.is_misled("two", 150.0)


def test_a_no_to_where_it_is_misleads_too() -> None:
    misled = Misled([asks(1, "kitchen"), says(1, "no")], is_in_kitchen)
    assert misled.is_misled("one", 150.0)
