from pathlib import Path
from types import NoneType
from typing import get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import BaseModel

from mend.errors import UnavailableError
from mend.robots.link import messages
from mend.robots.link.messages import Held, Holding, Report, robot_message
from mend.robots.link.outbox import IN_MEMORY, Outbox


def held(n: int) -> Held:
    return Held(command=str(n))


def undelivered(outbox: Outbox) -> list[tuple[str, int]]:
    reports = [robot_message.validate_json(each.text) for each in outbox.after(0, 1000)]
    return [(report.boot, report.seq) for report in reports]


def test_reports_count_from_one_and_come_in_order() -> None:
    outbox = Outbox(IN_MEMORY, "arm", "b1")
    assert [outbox.add(held(n), float(n), None).seq for n in range(3)] == [1, 2, 3]
    assert undelivered(outbox) == [("b1", 1), ("b1", 2), ("b1", 3)]
    outbox.close()


def test_a_report_keeps_its_body_time_and_world() -> None:
    outbox = Outbox(IN_MEMORY, "arm", "b1")
    made = outbox.add(held(7), 1.5, {"parts": {"leg": None}})
    (stored,) = outbox.after(0, 10)
    assert robot_message.validate_json(stored.text) == made
    outbox.close()


def test_an_acknowledgement_is_cumulative() -> None:
    outbox = Outbox(IN_MEMORY, "arm", "b1")
    for n in range(5):
        outbox.add(held(n), 0.0, None)
    assert outbox.acknowledge("b1", 3) == 3
    assert outbox.acknowledge("b1", 2) == 0
    assert undelivered(outbox) == [("b1", 4), ("b1", 5)]
    assert len(outbox) == 2
    outbox.close()


def test_what_an_earlier_boot_left_survives_and_comes_first(tmp_path: Path) -> None:
    path = tmp_path / "outbox.db"
    first = Outbox(path, "arm", "b1")
    for n in range(2):
        first.add(held(n), 0.0, None)
    first.acknowledge("b1", 1)
    first.close()
    second = Outbox(path, "arm", "b2")
    second.add(held(9), 0.0, None)
    assert undelivered(second) == [("b1", 2), ("b2", 1)]
    second.acknowledge("b1", 2)
    assert undelivered(second) == [("b2", 1)]
    second.close()


def test_robots_that_share_a_file_do_not_see_each_other(tmp_path: Path) -> None:
    left = Outbox(tmp_path / "outbox.db", "left", "b1")
    left.add(held(1), 0.0, None)
    left.close()
    right = Outbox(tmp_path / "outbox.db", "right", "b1")
    assert len(right) == 0
    assert right.after(0, 10) == []
    right.close()


def test_a_service_that_knows_more_of_the_boot_is_believed() -> None:
    outbox = Outbox(IN_MEMORY, "arm", "b1")
    outbox.acknowledge("b1", 7)
    assert outbox.add(held(1), 0.0, None).seq == 8
    outbox.close()


def test_a_full_outbox_refuses_and_takes_again_after_an_acknowledgement() -> None:
    outbox = Outbox(IN_MEMORY, "arm", "b1", capacity=4)
    outbox.add(held(1), 0.0, None)
    assert not outbox.crowded
    for n in range(3):
        outbox.add(held(n), 0.0, None)
    assert outbox.crowded
    with pytest.raises(UnavailableError, match="4 reports are undelivered"):
        outbox.add(held(5), 0.0, None)
    outbox.acknowledge("b1", 1)
    assert outbox.add(held(5), 0.0, None).seq == 5
    outbox.close()


def test_a_second_program_cannot_open_the_same_outbox(tmp_path: Path) -> None:
    first = Outbox(tmp_path / "outbox.db", "arm", "b1")
    with pytest.raises(UnavailableError, match="cannot be used"):
        Outbox(tmp_path / "outbox.db", "arm", "b2")
    first.close()


def test_a_file_that_is_no_outbox_is_refused_in_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("not a database, but long enough to be mistaken for one " * 50)
    with pytest.raises(UnavailableError, match=r"notes\.txt"):
        Outbox(path, "arm", "b1")


@settings(deadline=None, max_examples=50)
@given(st.lists(st.one_of(st.just("add"), st.integers(0, 30)), max_size=60))
def test_exactly_what_was_not_acknowledged_is_left(actions: list[str | int]) -> None:
    outbox = Outbox(IN_MEMORY, "arm", "b1")
    expected: list[int] = []
    for action in actions:
        if isinstance(action, str):
            expected.append(outbox.add(held(0), 0.0, None).seq)
        else:
            known = min(action, max(expected, default=0))
            outbox.acknowledge("b1", known)
            expected = [seq for seq in expected if seq > known]
    assert [seq for _, seq in undelivered(outbox)] == expected
    assert len(outbox) == len(expected)
    outbox.close()


def test_every_optional_part_may_be_left_out_on_the_wire() -> None:
    """What is None is not sent, so a field that may be None must not be required."""
    required = [
        f"{name}.{field}"
        for name, kind in vars(messages).items()
        if isinstance(kind, type) and issubclass(kind, BaseModel)
        for field, about in kind.model_fields.items()
        if about.is_required() and NoneType in get_args(about.annotation)
    ]
    assert required == []


def test_a_hold_without_an_execution_can_be_read_by_the_service() -> None:
    outbox = Outbox(IN_MEMORY, "r", "b")
    outbox.add(Holding(execution=None, at="hand_over"), 1.0, None)
    [stored] = outbox.after(0, 1)
    outbox.close()
    report = robot_message.validate_json(stored.text)
    assert isinstance(report, Report)
    assert report.body == Holding(execution=None, at="hand_over")
