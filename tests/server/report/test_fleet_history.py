"""A fleet's report counts what its site's events tell of a span, and nothing else."""

from typing import Any
from uuid import UUID

import pytest
from fleet_events import FLEET, SITE, LegMaker, asked

from mend.fleet.requests import LegAction
from mend.robots.execution.phase import Phase
from mend.server.fleets.leg_task import LegStage
from mend.server.journal import events as ev
from mend.server.report.fleet_history import FleetHistory
from mend.server.report.fleet_page import tables_of
from mend.server.report.span import Span
from mend.server.report.table import Cell

COLLECT = LegMaker("r0", 1, "mail", LegAction.COLLECT)
GIVE = LegMaker("r0", 2, "mail", LegAction.GIVE, to="F1/hall")
TAKE = LegMaker("r1", 1, "mail", LegAction.TAKE, to="F1/hall")
HAND_OVER = LegMaker("r1", 2, "mail", LegAction.HAND_OVER, to="F2/201")


def plan(at_s: float, *transfers: ev.PlannedTransfer) -> ev.PlanChanged:
    return ev.PlanChanged(
        at_s=at_s,
        number=1,
        reason="'mail' is asked for",
        requests=["mail"],
        robots=["r0", "r1"],
        said={},
        transfers=list(transfers),
        **FLEET,
    )


def day() -> list[Any]:
    """The mail changes robots; somebody opens a door, and somebody helps a robot that is lost."""
    collecting, giving = COLLECT.run(), GIVE.run()
    saving = ev.PlannedTransfer(request="mail", sooner_s=90.0, less_m=12.0)
    return [
        asked("mail", "booked", 0.0),
        plan(0.0, saving),
        COLLECT.begun(10.0),
        collecting.started(),
        collecting.step(0.0, Phase.TRAVEL),
        collecting.raised(5.0, "door_closed"),
        *collecting.dialogue(5.0, 9.0, "door_closed", 1),
        collecting.resumed(9.0),
        collecting.done(20.0),
        COLLECT.ended(30.0, driven_m=30.0),
        GIVE.begun(30.0),
        giving.started(),
        giving.step(0.0, Phase.TRAVEL),
        giving.raised(5.0, "lost"),
        *giving.dialogue(5.0, 9.0, "lost", 2),
        giving.resumed(9.0),
        giving.done(30.0),
        TAKE.begun(40.0, start="F1/109"),
        GIVE.ended(60.0, driven_m=50.0),
        TAKE.ended(75.0),
        HAND_OVER.begun(75.0, start="F1/hall"),
        asked("tea", "booked", 80.0, kind="go_to_room", earliest_s=100.0),
        HAND_OVER.ended(130.0, driven_m=20.0),
        asked("mail", "done", 130.0),
    ]


def rows(events: list[Any], name: str, span: Span | None = None) -> list[tuple[Cell, ...]]:
    history = FleetHistory.of(SITE, events, span or Span())
    return list(next(each for each in tables_of(history) if each.name == name).rows)


def test_metres_are_told_by_robot_and_from_one_intervention_to_the_next() -> None:
    assert rows(day(), "metres") == [
        ("r0", 80.0, 2, 2, 2, 40.0, 1, 80.0),
        ("r1", 20.0, 1, 2, 0, None, 0, None),
        ("all", 100.0, 3, 4, 2, 50.0, 1, 100.0),
    ]


def test_help_counts_for_the_whole_leg_in_which_it_came() -> None:
    (of_r0, *_) = rows(day(), "metres", Span(45.0, 70.0))
    assert of_r0 == ("r0", 50.0, 1, 1, 1, 50.0, 1, 50.0)


def test_what_changed_robots_is_told_with_what_that_was_to_save() -> None:
    assert rows(day(), "transfers") == [
        ("mail", "F1/hall", "r0", 60.0, "r1", 75.0, 15.0, 90.0, 12.0)
    ]
    history = FleetHistory.of(SITE, day(), Span())
    (table,) = [each for each in tables_of(history) if each.name == "transfers"]
    assert table.note.startswith("1.5 min were to be saved in all, with 1 request.")


def test_journals_of_an_older_mend_say_nothing_of_what_a_transfer_saves() -> None:
    events = [each for each in day() if not isinstance(each, ev.PlanChanged)]
    (row,) = rows(events, "transfers")
    assert row[-2:] == (None, None)


def test_a_request_is_told_with_its_floors_robots_and_metres() -> None:
    mail, tea = rows(day(), "each_request")
    assert mail == (
        "mail", "transport", "F1, F2", "done", 0.0, 0.0, 10.0, 130.0, "r0, r1", None, "",
    )  # fmt: skip
    assert tea[:8] == ("tea", "go to room", "", "booked", 80.0, 100.0, None, None)


def test_waiting_begins_when_a_request_may_begin() -> None:
    tea = LegMaker("r0", 3, "tea", LegAction.VISIT)
    events = [*day(), tea.begun(112.0), tea.ended(160.0)]
    assert rows(events, "waits")[0][:4] == ("go to room", 1, 0.2, 0.2)


@pytest.mark.parametrize(
    ("span", "numbers"),
    [
        (Span(), ["r0 1", "r0 2", "r1 1", "r1 2"]),
        (Span(35.0, 100.0), ["r0 2", "r1 1"]),
        (Span(None, 60.0), ["r0 1"]),
        (Span(100.0, None), ["r1 2"]),
    ],
)
def test_a_leg_counts_in_the_span_in_which_it_ends(span: Span, numbers: list[str]) -> None:
    assert [f"{robot} {number}" for robot, number, *_ in rows(day(), "legs", span)] == numbers


def test_a_request_counts_in_the_span_in_which_it_was_made() -> None:
    assert rows(day(), "requests", Span(0.0, 50.0)) == [("transport", 1, 1, 0, 0, 0, 1)]
    assert rows(day(), "requests", Span(70.0, None)) == [("go to room", 1, 0, 0, 0, 0, 1)]


def test_busy_is_only_what_was_in_the_span() -> None:
    (busy, other) = rows(day(), "robots", Span(40.0, 76.0))
    assert busy == ("r0", 1, 1, pytest.approx(20 / 60), pytest.approx(100 * 20 / 36))
    assert other[0] == "r1"


def test_only_the_dialogues_of_the_sites_own_runs_are_counted() -> None:
    def elsewhere(event: Any) -> Any:
        change = {"site": UUID(int=8)} if hasattr(event, "site") else {"run": UUID(int=7)}
        return event.model_copy(update=change)

    assert rows([*day(), *map(elsewhere, day())], "questions") == rows(day(), "questions")
    assert [row[:2] for row in rows(day(), "questions")] == [("door closed", 1), ("lost", 1)]


def test_the_time_of_all_legs_is_all_there_is() -> None:
    for name in ("times", "times_by_robot"):
        *_, total = rows(day(), name)
        assert total[-1] == pytest.approx((20 + 30 + 35 + 55) / 60)
        assert sum(float(each or 0) for each in total[3:-1]) == pytest.approx(total[-1])


def test_the_runs_of_a_leg_are_its_own() -> None:
    history = FleetHistory.of(SITE, day(), Span())
    assert [list(each.runs) for each in history.legs] == [[LegStage.DO], [LegStage.DO], [], []]


@pytest.mark.parametrize(("last_s", "unit"), [(130.0, "s"), (7200.0, "min"), (86400.0, "h")])
def test_every_request_is_counted_once_whatever_time_it_was(last_s: float, unit: str) -> None:
    events = [*day(), asked("late", "booked", last_s)]
    history = FleetHistory.of(SITE, events, Span())
    (table,) = [each for each in tables_of(history) if each.name == "requests_by_time"]
    assert table.columns[0] == f"from, {unit}"
    assert 10 <= len(table.rows) <= 30
    assert sum(int(count or 0) for _, _, *counts in table.rows for count in counts) == 3


def test_a_name_that_is_used_again_is_another_request() -> None:
    again = LegMaker("r0", 3, "mail", LegAction.COLLECT)
    events = [*day(), asked("mail", "booked", 200.0), again.begun(210.0), again.ended(240.0)]
    (transports,) = [row for row in rows(events, "requests") if row[0] == "transport"]
    assert transports == ("transport", 2, 1, 1, 1, 0, 1)
    assert [row[0] for row in rows(events, "each_request")] == ["mail", "tea", "mail"]
    assert rows(events, "each_request")[-1][6:9] == (210.0, None, "r0")


def test_the_clock_of_another_site_says_nothing_of_a_span() -> None:
    other = asked("tea", "booked", 1000.0).model_copy(update={"site": UUID(int=8)})
    span = Span(35.0, 100.0)
    assert rows([other, *day()], "legs", span) == rows(day(), "legs", span)
