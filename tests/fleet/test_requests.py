"""What people may ask of a building's robots, and what becomes of that as items of a plan."""

from math import inf
from typing import Any

import pytest
from pydantic import TypeAdapter

from mend.errors import IllegalTransitionError, WrongInputError
from mend.fleet.requests import (
    STATUS,
    DeliverMessage,
    Escort,
    GoToRoom,
    LegAction,
    Recurrence,
    Request,
    RequestStatus,
    Terms,
    Transport,
    request_of,
)

PLACES = ["a", "b", "c"]
TERMS = Terms(PLACES.index, handling_s=30.0, whole_load=4.0)
TEA: dict[str, Any] = {
    "kind": "transport",
    "name": "tea",
    "origin": "a",
    "destination": "b",
    "what": "a cup of tea",
}


@pytest.mark.parametrize(
    "said", ['Say "hi".', "Say “hi”.", "Say „hi“.", "Say «hi».", " Say ‟hi” . "]
)
def test_what_is_written_has_the_quotation_marks_that_robots_can_say(said: str) -> None:
    message = DeliverMessage(name="m", place="b", message=said).message
    assert message.replace(" ", "") == "Say'hi'."
    assert message == message.strip()


@pytest.mark.parametrize("unseen", ["\u202e", "\u200b", "\u2066", "\x85", "\ufeff"])
def test_what_is_said_has_nothing_in_it_that_cannot_be_seen(unseen: str) -> None:
    with pytest.raises(WrongInputError, match="'what' must have only characters that can be seen"):
        request_of({**TEA, "what": f"a cup{unseen} of tea"})
    assert request_of({**TEA, "what": "eine Tasse Tee, שלום"})


def test_visit_is_an_item_that_stays_at_its_place() -> None:
    visit = GoToRoom(name="visit", place="b", earliest_s=10.0, latest_s=60.0, stay_s=5.0)
    item = visit.item("visit", TERMS)
    assert (item.pickup.place, item.delivery.place) == (1, 1)
    assert (item.load, item.direct, item.pickup.service_s) == (0.0, True, 5.0)
    assert (item.pickup.window.earliest_s, item.pickup.window.latest_s) == (10.0, 60.0)


def test_message_takes_the_time_to_tell_it() -> None:
    item = DeliverMessage(name="hello", place="c", message="hello").item("hello", TERMS)
    assert (item.pickup.place, item.pickup.service_s, item.delivery.service_s) == (2, 30.0, 0.0)


def test_escort_takes_all_room_and_stays_with_one_robot() -> None:
    item = Escort(name="guest", origin="a", destination="c", person="Ann").item("guest", TERMS)
    assert (item.load, item.direct) == (4.0, True)


def test_transport_takes_its_load_and_may_change_robots() -> None:
    item = request_of({**TEA, "load": 0.5, "latest_s": 90.0}).item("tea", TERMS)
    assert (item.load, item.direct) == (0.5, False)
    assert item.delivery.window.latest_s == 90.0


def test_without_a_latest_moment_any_will_do() -> None:
    assert request_of(TEA).window.latest_s == inf


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"kind": "fly"}, "'kind' must be one of go_to_room, deliver_message, escort, transport"),
        ({"destination": "a"}, "destination must be another place than origin ('a')"),
        (
            {"earliest_s": 50.0, "latest_s": 20.0},
            "latest_s must be after earliest_s (50 s), but it is 20 s",
        ),
        ({"load": -1.0}, "'load' must be greater than or equal to 0, but it is -1.0"),
        ({"what": ""}, "'what' must not be empty"),
        ({"colour": "red"}, "unknown key 'colour'"),
        (
            {"earliest_s": 50.0, "recurrence": Recurrence(every_s=60.0, until_s=10.0)},
            "recurrence.until_s must not be before earliest_s (50 s), but it is 10 s",
        ),
    ],
)
def test_mistake_is_one_clear_sentence(change: dict[str, Any], sentence: str) -> None:
    with pytest.raises(WrongInputError) as told:
        request_of({**TEA, **change})
    assert str(told.value).startswith(sentence)
    assert "\n" not in str(told.value)


def test_what_recurs_is_the_same_later() -> None:
    every = Recurrence(every_s=3600.0, until_s=7300.0)
    round_ = GoToRoom(name="round", place="a", earliest_s=100.0, latest_s=200.0, recurrence=every)
    second = round_.occurrence(2)
    assert (second.earliest_s, second.latest_s, second.recurrence) == (3700.0, 3800.0, None)
    assert [round_.recurs(number) for number in (1, 2, 3, 4)] == [True, True, True, False]


def test_what_does_not_recur_is_wanted_once() -> None:
    once = GoToRoom(name="once", place="a")
    assert (once.recurs(1), once.recurs(2)) == (True, False)


def test_request_is_read_from_its_own_text() -> None:
    adapter: TypeAdapter[Request] = TypeAdapter(Request)
    asked = Transport(name="tea", origin="a", destination="b", what="tea", person="Ben")
    assert adapter.validate_json(asked.model_dump_json()) == asked


def test_only_things_come_back() -> None:
    assert Transport.comes_back
    assert not Escort.comes_back
    assert Escort.fetching is LegAction.MEET


@pytest.mark.parametrize(
    ("status", "came"),
    [
        (RequestStatus.BOOKED, RequestStatus.DONE),
        (RequestStatus.WAITING, RequestStatus.RETURNING),
        (RequestStatus.RETURNING, RequestStatus.BOOKED),
        (RequestStatus.DONE, RequestStatus.FAILED),
        (RequestStatus.REFUSED, RequestStatus.BOOKED),
    ],
)
def test_status_leads_only_where_it_may(status: RequestStatus, came: RequestStatus) -> None:
    with pytest.raises(IllegalTransitionError):
        STATUS.require(status, came)


def test_whatever_is_over_stays_over() -> None:
    over = {status for status in RequestStatus if STATUS.is_last(status)}
    assert over == {"done", "refused", "cancelled", "failed"}
