"""A dispatcher that was killed goes on from its snapshot as if nothing had been."""

import pytest
from dispatch_office import DONE, asked, dispatcher_for, fleet_of, make_leg, office, only_leg, visit
from pydantic import ValidationError

from mend.errors import UnreadableError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found
from mend.fleet.dispatch.snapshot import DispatcherSnapshot
from mend.fleet.requests import Recurrence, RequestStatus


def at_work() -> Dispatcher:
    """Something aboard, a leg under way, a way closed, something that recurs, a robot failed."""
    dispatcher = dispatcher_for("a", "e", "c")
    dispatcher.submit(asked(), 0.0)
    make_leg(dispatcher, 0.0, 15.0)
    only_leg(dispatcher, 15.0)
    dispatcher.submit(visit(recurrence=Recurrence(every_s=50_000.0)), 20.0)
    dispatcher.found(Found(finding=Finding.BLOCKED, between=("d", "e")), 21.0)
    dispatcher.robot_failed("r2", None, "it fell", 22.0)
    dispatcher.submit(asked("late", latest_s=30.0), 23.0)
    return dispatcher


def again(dispatcher: Dispatcher) -> Dispatcher:
    text = dispatcher.snapshot().model_dump_json()
    kept = DispatcherSnapshot.model_validate_json(text)
    return Dispatcher.restored(office(), fleet_of("a", "e", "c"), kept)


def test_restored_dispatcher_is_equal() -> None:
    dispatcher = at_work()
    other = again(dispatcher)
    assert other.snapshot() == dispatcher.snapshot()
    assert other.views() == dispatcher.views()
    assert other.legs_under_way() == dispatcher.legs_under_way()
    assert other.log == dispatcher.log


def test_what_was_aboard_is_aboard_and_is_delivered() -> None:
    other = again(at_work())
    assert other.fleet.items["tea"].robot == 0
    other.ended(other.legs_under_way()[0], DONE, 40.0)
    assert other.view("tea").status is RequestStatus.DONE


def test_both_go_on_alike() -> None:
    dispatcher = at_work()
    other = again(dispatcher)
    for each in (dispatcher, other):
        each.ended(each.legs_under_way()[0], DONE, 40.0)
        each.legs_to_begin(1000.0)
    assert other.snapshot() == dispatcher.snapshot()


def test_snapshot_of_other_robots_is_refused() -> None:
    kept = at_work().snapshot()
    with pytest.raises(UnreadableError, match="other robots"):
        Dispatcher.restored(office(), fleet_of("a", "e"), kept)


def test_snapshot_that_was_tampered_with_is_refused() -> None:
    document = at_work().snapshot().model_dump(mode="json")
    document["fleet"]["items"][0]["state"] = "eaten"
    with pytest.raises(ValidationError):
        DispatcherSnapshot.model_validate(document)
