"""The next possible time is one at which there is a place, and hardly later than it must be."""

from random import Random

import pytest
from dispatch_happenings import drawn_fleet
from dispatch_office import asked, dispatcher_for, visit
from sampled import sample

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.requests import request_of
from mend.maps.building.building import PlaceKind


@pytest.mark.parametrize("seed", sample([1], [1, 2, 3]))
def test_what_is_offered_is_booked_when_it_is_asked_for(seed: int) -> None:
    building, setting = drawn_fleet(seed)
    dispatcher, chance = Dispatcher(building, setting), Random(seed)
    rooms, offered = building.of_kind(PlaceKind.ROOM), 0
    for number in range(25):
        origin, destination = chance.sample(rooms, 2)
        ways = {"origin": origin, "destination": destination, "what": "a parcel"}
        request = {"kind": "transport", "name": f"q{number}", "latest_s": 150.0, **ways}
        window = dispatcher.submit(request_of(request), 0.0).next_possible
        if window is not None:
            offered += 1
            again = {**request, "earliest_s": window.earliest_s, "latest_s": window.latest_s}
            assert dispatcher.submit(request_of(again), 0.0).booked
    assert offered > 5


def test_window_that_begins_later_is_offered_from_its_own_beginning() -> None:
    dispatcher = dispatcher_for("a")
    answer = dispatcher.submit(asked(earliest_s=1000.0, latest_s=1010.0), 0.0)
    assert answer.next_possible is not None
    assert answer.next_possible.earliest_s == 1000.0
    assert 1025.0 <= answer.next_possible.latest_s <= 1025.0 + 60.0 + 121.0


def test_time_that_is_over_has_a_next_one() -> None:
    dispatcher = dispatcher_for("a")
    answer = dispatcher.submit(visit(latest_s=50.0), 100.0)
    assert not answer.booked
    assert answer.next_possible is not None
    assert answer.next_possible.latest_s >= 120.0
