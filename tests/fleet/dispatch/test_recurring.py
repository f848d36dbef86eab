"""Much that recurs: it is booked in time, in one go, and no more of it than can be planned."""

from dispatch_office import DONE, dispatcher_for, visit

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.recurring import AT_ONCE, LEAST_AHEAD, LEAST_BEHIND
from mend.fleet.dispatch.setting import Policy
from mend.fleet.requests import Recurrence, RequestStatus

EACH_MINUTE = Recurrence(every_s=60.0)
FEW_AHEAD = Policy(occurrences_in_all=10)
MANY = 30


def _many() -> Dispatcher:
    dispatcher = dispatcher_for("a", policy=FEW_AHEAD)
    for number in range(MANY):
        answer = dispatcher.submit(visit(f"s{number}", recurrence=EACH_MINUTE), 0.0)
        assert answer.booked
    return dispatcher


def _booked(dispatcher: Dispatcher) -> set[str]:
    return {view.name for view in dispatcher.views()}


def _carried_out(dispatcher: Dispatcher, until_s: float) -> None:
    """All legs that are to begin, each done when it was to be."""
    while (wakes_s := dispatcher.wakes_s()) is not None and wakes_s <= until_s:
        for leg in dispatcher.legs_to_begin(wakes_s):
            dispatcher.began(leg, dispatcher.now_s)
        for leg in dispatcher.legs_under_way():
            dispatcher.ended(leg, DONE, max(leg.done_s, dispatcher.now_s))


def test_occurrences_are_booked_in_one_change_of_the_plan() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(visit("round", recurrence=EACH_MINUTE), 0.0)
    first, rest = dispatcher.log
    assert first.requests == ("round/1",)
    assert len(rest.requests) == Policy().occurrences
    more = Policy().occurrences - 2
    assert rest.reason == f"'round/2', 'round/3' and {more} more are asked for"


def test_where_much_recurs_less_of_each_is_booked_ahead() -> None:
    dispatcher = _many()
    last = MANY - 1
    assert f"s{last}/{LEAST_AHEAD + 1}" in _booked(dispatcher)
    assert f"s{last}/{LEAST_AHEAD + 2}" not in _booked(dispatcher)


def test_of_much_that_is_due_what_begins_first_is_booked_first_and_the_rest_at_once_after() -> None:
    dispatcher = _many()
    before = _booked(dispatcher)
    dispatcher.legs_to_begin(60.0)
    new = _booked(dispatcher) - before
    assert 0 < len(new) <= AT_ONCE
    assert dispatcher.wakes_s() == 60.0
    known = set[str]()
    while known != _booked(dispatcher):
        known = _booked(dispatcher)
        dispatcher.legs_to_begin(60.0)
    later = known - before - new
    times_s = {view.name: view.request.earliest_s for view in dispatcher.views()}
    assert max(times_s[each] for each in new) <= min(times_s[each] for each in later)
    soon = [f"s{series}/{number}" for series in range(MANY) for number in (2, 3, 4)]
    assert set(soon) <= _booked(dispatcher)


def test_what_is_due_within_minutes_is_booked_however_much_recurs() -> None:
    dispatcher = dispatcher_for("a", policy=FEW_AHEAD)
    hourly = Recurrence(every_s=3600.0)
    for number in range(MANY // 2):
        begins = {"earliest_s": 240.0 * number, "stay_s": 0.0}
        dispatcher.submit(visit(f"s{number}", **begins, recurrence=hourly), 0.0)
    _carried_out(dispatcher, 2 * 3600.0)
    done = {v.name for v in dispatcher.views() if v.status is RequestStatus.DONE}
    asked_for = {
        f"s{number}/{time}"
        for number in range(MANY // 2)
        for time in (1, 2)
        if 240.0 * number + 3600.0 * (time - 1) < 2 * 3600.0 - 300.0
    }
    assert asked_for <= done
    assert not [v for v in dispatcher.views() if v.status is RequestStatus.REFUSED]


def test_what_nobody_catches_up_with_is_refused_and_said_so() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(occurrences=4))
    dispatcher.submit(visit("round", recurrence=EACH_MINUTE), 0.0)
    for now_s in range(60, 1200, 60):
        # It never sets out.
        dispatcher.legs_to_begin(float(now_s))
    views = dispatcher.views()
    assert sum(view.status is RequestStatus.BOOKED for view in views) <= 5 + LEAST_BEHIND + 1
    refused = [view for view in views if view.status is RequestStatus.REFUSED]
    assert refused
    assert refused[0].reason == (
        "the occurrences of 'round' before it are late and nobody has set out for them yet"
    )
    assert [view.name for view in views] == [f"round/{n + 1}" for n in range(len(views))]


def test_what_recurs_goes_on_once_what_was_late_is_done() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(occurrences=4))
    request = visit("round", place="b", stay_s=0.0, recurrence=EACH_MINUTE)
    dispatcher.submit(request, 0.0)
    dispatcher.legs_to_begin(600.0)
    _carried_out(dispatcher, 1200.0)
    views = {view.name: view.status for view in dispatcher.views()}
    assert views["round/18"] is RequestStatus.DONE
