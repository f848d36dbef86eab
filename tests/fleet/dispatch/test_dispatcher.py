"""A dispatcher of one building: what is booked, what robots are to do, and what fails."""

from collections.abc import Callable

import numpy as np
import pytest
from dispatch_office import (
    DONE,
    GONE,
    NOBODY,
    asked,
    dispatcher_for,
    fleet_of,
    make_leg,
    office,
    only_leg,
    visit,
)

from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.fleet.dispatch.booking import AnyRequest
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found, LegEnd, LegOutcome
from mend.fleet.dispatch.setting import Policy
from mend.fleet.dispatch.snapshot import DispatcherSnapshot
from mend.fleet.requests import LegAction, Recurrence, RequestStatus, request_of
from mend.fleet.scheduling.replanning.transfer_saving import TransferSaving

HANDS_OVER = {"transfer_places": ("c",), "transfer_s": 0.0}


def status(dispatcher: Dispatcher, name: str = "tea") -> RequestStatus:
    return dispatcher.view(name).status


# --- booking --------------------------------------------------------------------------------------


def test_request_is_booked_with_an_expected_time() -> None:
    answer = dispatcher_for("a").submit(asked(), 0.0)
    assert answer.booked
    assert answer.expected is not None
    assert (answer.expected.robot, answer.expected.begins_s) == ("r0", pytest.approx(10.0))
    assert answer.expected.done_s == pytest.approx(10 + 5 + 20 + 5)


def test_request_that_cannot_be_met_says_why_and_when_it_could() -> None:
    dispatcher = dispatcher_for("a")
    answer = dispatcher.submit(asked(latest_s=20.0), 0.0)
    assert not answer.booked
    assert answer.why is not None
    assert "must begin by 20 s" in answer.why
    assert answer.next_possible is not None
    latest_s = answer.next_possible.latest_s
    assert 35.0 <= latest_s <= 35.0 + 60.0 + 121.0
    assert dispatcher.submit(asked(latest_s=latest_s), 0.0).booked


def test_what_no_robot_can_do_has_no_next_possible_time() -> None:
    answer = dispatcher_for("a").submit(asked(load=5.0), 0.0)
    assert answer.why is not None
    assert "no robot carries more than 2" in answer.why
    assert answer.next_possible is None


def test_refused_request_is_kept_and_may_be_asked_again() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(latest_s=20.0), 0.0)
    assert status(dispatcher) is RequestStatus.REFUSED
    assert dispatcher.submit(asked(), 1.0).booked
    with pytest.raises(ConflictError, match="there is a request 'tea' already"):
        dispatcher.submit(asked(), 2.0)


def test_place_that_is_nowhere_is_refused() -> None:
    with pytest.raises(NotFoundError, match="no place 'cellar'"):
        dispatcher_for("a").submit(asked(origin="cellar"), 0.0)


def test_one_place_in_two_spellings_is_still_one_place() -> None:
    dispatcher = dispatcher_for("a")
    full = dispatcher.building.find("b")
    assert full != "b"
    with pytest.raises(WrongInputError, match=r"must be another place than origin \('b'\)"):
        dispatcher.submit(asked("tea", "b", full), 0.0)
    assert dispatcher.views() == []


def test_escort_has_a_robot_to_itself() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked("tea", "b", "d"), 0.0)
    guest = {"kind": "escort", "name": "guest", "person": "Ann", "origin": "c", "destination": "e"}
    assert dispatcher.submit(request_of(guest), 0.0).booked
    stops = [(stop.item, stop.action) for stop in dispatcher.fleet.stops()["r0"]]
    first, second, *_ = [item for item, _ in stops]
    assert first == second


def test_cancelled_request_leaves_the_plan() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    view = dispatcher.cancel("tea", 1.0)
    assert view is not None
    assert (view.status, view.expected) == (RequestStatus.CANCELLED, None)
    assert dispatcher.legs_to_begin(2.0) == []
    with pytest.raises(ConflictError, match="is cancelled"):
        dispatcher.cancel("tea", 3.0)


def test_changed_request_is_planned_anew_or_stays_as_it_was() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    assert dispatcher.change("tea", asked(destination="e"), 1.0).booked
    refused = dispatcher.change("tea", asked(destination="c", latest_s=5.0), 2.0)
    assert not refused.booked
    view = dispatcher.view("tea")
    assert view.request.places == ("b", "e")
    assert view.status is RequestStatus.BOOKED


def _second_round() -> Dispatcher:
    """One of what recurs each hour, wanted from 3700 s on until 4300 s."""
    dispatcher = dispatcher_for("a", policy=Policy(horizon_s=8000.0))
    times = {"earliest_s": 100.0, "latest_s": 700.0}
    dispatcher.submit(visit("round", recurrence=Recurrence(every_s=3600.0), **times), 0.0)
    return dispatcher


@pytest.mark.parametrize(
    ("given", "times"),
    [
        ({}, (3700.0, 4300.0)),
        ({"latest_s": 5000.0}, (3700.0, 5000.0)),
        ({"latest_s": None}, (3700.0, None)),
        ({"earliest_s": 4500.0}, (4500.0, None)),
        ({"earliest_s": 0.0}, (0.0, None)),
    ],
)
def test_changed_occurrence_keeps_its_time_unless_another_is_given(
    given: dict[str, float | None], times: tuple[float, float | None]
) -> None:
    dispatcher = _second_round()
    assert dispatcher.change("round/2", visit("round", place="e", **given), 1.0).booked
    changed = dispatcher.view("round/2").request
    assert changed.places == ("e",)
    assert (changed.earliest_s, changed.latest_s) == times


def test_changed_occurrence_is_not_wanted_by_before_its_time() -> None:
    dispatcher = _second_round()
    with pytest.raises(WrongInputError, match=r"after the 3700 s from which .* but it is 500 s"):
        dispatcher.change("round/2", visit("round", latest_s=500.0), 1.0)
    assert dispatcher.view("round/2").request.latest_s == 4300.0


def test_request_under_way_is_not_changed() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    only_leg(dispatcher, 0.0)
    with pytest.raises(ConflictError, match="too late to change it"):
        dispatcher.change("tea", asked(destination="e"), 1.0)


def test_what_recurs_is_booked_ahead_of_its_times() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(horizon_s=4000.0))
    every = Recurrence(every_s=3600.0, until_s=7200.0)
    dispatcher.submit(visit("round", recurrence=every), 0.0)
    assert [view.name for view in dispatcher.views()] == ["round/1", "round/2"]
    dispatcher.legs_to_begin(3300.0)
    assert [view.name for view in dispatcher.views()][-1] == "round/3"
    dispatcher.cancel("round", 3400.0)
    assert {view.status for view in dispatcher.views()} == {RequestStatus.CANCELLED}
    with pytest.raises(ConflictError, match="is over"):
        dispatcher.cancel("round", 3500.0)


def test_what_recurs_often_is_booked_some_times_ahead_and_each_is_at_its_time() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(visit("round", place="c", recurrence=Recurrence(every_s=60.0)), 0.0)
    ahead = Policy().occurrences
    assert len(dispatcher.views()) == ahead + 1
    for view in dispatcher.views()[1:]:
        assert view.expected is not None
        assert view.expected.done_s == view.request.earliest_s
    assert dispatcher.wakes_s() is not None
    dispatcher.legs_to_begin(60.0)
    assert len(dispatcher.views()) == ahead + 2


@pytest.mark.parametrize("kind", [visit, asked])
@pytest.mark.parametrize("later_s", [3000.0, 28_800.0])
def test_what_is_wanted_soon_is_not_put_off_for_what_is_wanted_later(
    kind: Callable[..., AnyRequest], later_s: float
) -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(kind("mine", earliest_s=60.0), 0.0)
    mine = dispatcher.view("mine").expected
    for number in range(4):
        dispatcher.submit(kind(f"hers{number}", earliest_s=later_s + 600.0 * number), 1.0)
    assert dispatcher.view("mine").expected == mine
    for number in range(4):
        hers = dispatcher.view(f"hers{number}").expected
        assert hers is not None
        assert hers.done_s - later_s - 600.0 * number < 120.0


@pytest.mark.parametrize("stay_s", [0.0, 30.0])
def test_what_was_booked_first_is_done_though_something_recurs_all_the_time(stay_s: float) -> None:
    dispatcher = dispatcher_for("a")
    said = dispatcher.submit(visit("mine", place="e"), 0.0).expected
    assert said is not None
    often = visit("often", place="b", stay_s=stay_s, recurrence=Recurrence(every_s=60.0))
    dispatcher.submit(often, 0.0)
    latest_s = said.done_s + Policy().slack_s
    for now_s in np.arange(0.0, latest_s - 60.0, 60.0):
        dispatcher.legs_to_begin(float(now_s))
        mine = dispatcher.view("mine").expected
        assert mine is not None
        assert mine.done_s <= latest_s + 60.0


# --- legs -----------------------------------------------------------------------------------------


def test_transport_is_collected_and_handed_over() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    collect = make_leg(dispatcher, 0.0, 15.0)
    assert (collect.action, collect.place, collect.robot) == (LegAction.COLLECT, "f/b", "r0")
    assert status(dispatcher) is RequestStatus.UNDER_WAY
    hand_over = make_leg(dispatcher, 15.0, 25.0)
    assert (hand_over.action, hand_over.place) == (LegAction.HAND_OVER, "f/d")
    assert status(dispatcher) is RequestStatus.DONE
    assert dispatcher.legs_to_begin(50.0) == []


TAKEN_OUT = "it was taken out of the basket of r0"


@pytest.mark.parametrize("bring", [DONE, LegEnd(outcome=LegOutcome.DONE, reason=TAKEN_OUT)])
def test_of_what_was_brought_is_told_what_is_known(bring: LegEnd) -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    make_leg(dispatcher, 0.0, 15.0, LegEnd(outcome=LegOutcome.DONE, reason="it is heavier"))
    assert dispatcher.view("tea").reason is None
    make_leg(dispatcher, 15.0, 25.0, bring)
    assert dispatcher.view("tea").reason == bring.reason


def test_what_went_back_has_its_reason_and_what_is_known() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(max_attempts=1))
    dispatcher.submit(asked(), 0.0)
    make_leg(dispatcher, 0.0, 15.0)
    make_leg(dispatcher, 15.0, 25.0, NOBODY)
    make_leg(dispatcher, 40.0, 25.0, LegEnd(outcome=LegOutcome.DONE, reason=TAKEN_OUT))
    reason = dispatcher.view("tea").reason
    assert reason == f"r0 could not hand over 'tea' at f/d: nobody came; {TAKEN_OUT}"


def test_visit_is_one_leg() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(visit(), 0.0)
    assert make_leg(dispatcher, 0.0, 20.0).action is LegAction.VISIT
    assert status(dispatcher, "visit") is RequestStatus.DONE


def test_robot_stays_free_until_it_must_leave() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(visit(earliest_s=1000.0), 0.0)
    assert dispatcher.legs_to_begin(0.0) == []
    assert dispatcher.wakes_s() == pytest.approx(1000 - 20 - 30)
    leg = only_leg(dispatcher, 950.0)
    assert not dispatcher.may_begin(leg, 970.0)
    assert dispatcher.may_begin(leg, 1000.0)


def test_what_is_read_later_than_it_was_expected_is_expected_at_the_earliest_from_then_on() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    dispatcher.submit(asked(name="milk", origin="d", destination="e", earliest_s=100.0), 0.0)
    only_leg(dispatcher, 0.0)
    told = dispatcher.snapshot()
    for now_s, tea_s, milk_s in ((5.0, 40.0, 120.0), (60.0, 90.0, 120.0), (400.0, 430.0, 450.0)):
        tea, milk = (dispatcher.view(each, now_s).expected for each in ("tea", "milk"))
        assert tea is not None
        assert milk is not None
        assert (tea.done_s, tea.late_s) == (pytest.approx(tea_s), pytest.approx(tea_s - 40.0))
        assert (milk.done_s, milk.late_s) == (pytest.approx(milk_s), pytest.approx(milk_s - 120.0))
    assert dispatcher.snapshot() == told


def test_what_the_plan_is_told_of_the_time_is_late_no_more_beside_it() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    only_leg(dispatcher, 0.0)
    before = dispatcher.view("tea", 60.0).expected
    dispatcher.legs_to_begin(60.0)
    after = dispatcher.view("tea", 60.0).expected
    assert before is not None
    assert after is not None
    assert after.done_s == pytest.approx(before.done_s)
    assert (before.late_s, after.late_s) == (pytest.approx(50.0), 0.0)


def test_what_waits_at_its_place_is_done_now_at_the_earliest() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    leg = only_leg(dispatcher, 0.0)
    dispatcher.arrived(leg, 10.0)
    for now_s, done_s in ((14.0, 40.0), (75.0, 100.0)):
        expected = dispatcher.view("tea", now_s).expected
        assert expected is not None
        assert expected.done_s == pytest.approx(done_s)


def test_expected_time_follows_a_robot_that_is_late() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    only_leg(dispatcher, 0.0)
    dispatcher.legs_to_begin(60.0)
    expected = dispatcher.expected("tea")
    assert expected is not None
    assert expected.done_s == pytest.approx(60 + 5 + 20 + 5)


def test_leg_that_has_ended_does_not_end_again() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    leg = make_leg(dispatcher, 0.0, 15.0)
    with pytest.raises(ConflictError, match="not under way"):
        dispatcher.ended(leg, DONE, 16.0)


def test_leg_that_is_not_wanted_any_more_does_not_begin() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    (leg,) = dispatcher.legs_to_begin(0.0)
    dispatcher.cancel("tea", 1.0)
    with pytest.raises(ConflictError, match="is not to collect 'tea' now"):
        dispatcher.began(leg, 1.0)


def handing_over() -> Dispatcher:
    """Tea goes from a to e, and has to change robots at c."""
    setting = fleet_of("a", "e", **HANDS_OVER)
    robots = tuple(
        each.model_copy(update={"works_until_s": until_s})
        for each, until_s in zip(setting.robots, (29.0, None), strict=True)
    )
    dispatcher = Dispatcher(office(), setting.model_copy(update={"robots": robots}))
    assert dispatcher.submit(asked(origin="a", destination="e", latest_s=52.0), 0.0).booked
    return dispatcher


def test_what_only_two_robots_can_bring_saves_no_time_that_could_be_told() -> None:
    assert handing_over().log[-1].transfers == {"tea": TransferSaving()}


def test_the_plan_says_what_changing_robots_saves_against_one_alone() -> None:
    setting = fleet_of("a", "e", **HANDS_OVER)
    ends = setting.robots[0].model_copy(update={"works_until_s": 29.0})
    setting = setting.model_copy(update={"robots": (ends, setting.robots[1])})
    dispatcher = Dispatcher(office(), setting)
    dispatcher.submit(asked(origin="a", destination="e"), 0.0)
    # Alone r1 drives 80 m and is done at 90 s; together both drive 60 m and are done at 50 s.
    assert dispatcher.log[-1].transfers == {"tea": TransferSaving(sooner_s=40.0, less_m=20.0)}
    kept = DispatcherSnapshot.model_validate_json(dispatcher.snapshot().model_dump_json())
    assert Dispatcher.restored(office(), setting, kept).log == dispatcher.log


def test_who_changes_no_robots_saves_nothing_by_that() -> None:
    dispatcher = dispatcher_for("a", "e", **HANDS_OVER)
    dispatcher.submit(asked(), 0.0)
    assert dispatcher.log[-1].transfers == {}


def test_item_changes_robots_and_is_taken_after_it_was_given() -> None:
    dispatcher = handing_over()
    legs = {leg.robot: leg for leg in dispatcher.legs_to_begin(0.0)}
    collect, take = legs["r0"], legs["r1"]
    assert (collect.action, take.action, take.waits_for) == (
        LegAction.COLLECT, LegAction.TAKE, "r0",
    )  # fmt: skip
    for leg in (collect, take):
        dispatcher.began(leg, 0.0)
    dispatcher.arrived(collect, 0.0)
    dispatcher.ended(collect, DONE, 5.0)
    give = only_leg(dispatcher, 5.0)
    assert (give.robot, give.action, give.place) == ("r0", LegAction.GIVE, "f/c")
    assert not dispatcher.may_begin(take, 24.0)
    with pytest.raises(ConflictError, match="was not left at f/c"):
        dispatcher.ended(take, DONE, 24.0)
    dispatcher.ended(give, DONE, 25.0)
    assert dispatcher.may_begin(take, 25.0)
    dispatcher.ended(take, DONE, 26.0)
    make_leg(dispatcher, 26.0, 22.0)
    assert status(dispatcher) is RequestStatus.DONE


def test_robot_goes_on_with_what_it_is_to_do_after_all() -> None:
    dispatcher = handing_over()
    for leg in dispatcher.legs_to_begin(0.0):
        dispatcher.began(leg, 0.0)
    collect, take = sorted(dispatcher.legs_under_way(), key=lambda leg: leg.robot)
    assert take in dispatcher.legs_to_withdraw(5.0)
    assert dispatcher.why_unwanted(take).startswith("the plan has changed")
    dispatcher.ended(collect, DONE, 5.0)
    assert dispatcher.legs_to_withdraw(5.0) == []
    assert only_leg(dispatcher, 5.0).action is LegAction.GIVE


def test_nobody_goes_for_what_another_robot_still_has_to_let_be() -> None:
    setting = fleet_of("a", "e")
    quick = setting.robots[1].model_copy(update={"speed": 10.0})
    setting = setting.model_copy(update={"robots": (setting.robots[0], quick)})
    dispatcher = Dispatcher(office(), setting)
    dispatcher.submit(asked(destination="c", latest_s=60.0), 0.0)
    leg = only_leg(dispatcher, 0.0)
    assert leg.robot == "r0"
    assert dispatcher.legs_to_begin(46.0) == []
    assert dispatcher.legs_to_withdraw(46.0) == [leg]
    assert dispatcher.why_unwanted(leg) == "the plan has changed: r1 is to do it now"
    dispatcher.ended(leg, LegEnd(outcome=LegOutcome.WITHDRAWN), 46.0)
    assert only_leg(dispatcher, 46.0).robot == "r1"


# --- what fails -----------------------------------------------------------------------------------


def test_leg_that_failed_is_tried_again_later_and_then_given_up() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(max_attempts=3, retry_after_s=100.0))
    dispatcher.submit(asked(), 0.0)
    now_s = 0.0
    for _ in range(2):
        make_leg(dispatcher, now_s, 20.0, NOBODY)
        assert status(dispatcher) is RequestStatus.BOOKED
        now_s += 120.0
    make_leg(dispatcher, now_s, 20.0, NOBODY)
    view = dispatcher.view("tea")
    assert view.status is RequestStatus.FAILED
    assert view.reason == "r0 could not collect 'tea' at f/b: nobody came"
    assert dispatcher.legs_to_begin(now_s + 500.0) == []


def test_what_nobody_takes_goes_back_to_where_it_came_from() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(max_attempts=1))
    dispatcher.submit(asked(), 0.0)
    make_leg(dispatcher, 0.0, 15.0)
    make_leg(dispatcher, 15.0, 25.0, NOBODY)
    assert status(dispatcher) is RequestStatus.RETURNING
    back = make_leg(dispatcher, 40.0, 25.0)
    assert (back.action, back.place) == (LegAction.BRING_BACK, "f/b")
    assert status(dispatcher) is RequestStatus.FAILED


def test_what_nobody_takes_back_stays_aboard_until_a_person_takes_it() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(max_attempts=1))
    dispatcher.submit(asked(load=2.0), 0.0)
    make_leg(dispatcher, 0.0, 15.0)
    make_leg(dispatcher, 15.0, 25.0, NOBODY)
    make_leg(dispatcher, 40.0, 25.0, NOBODY)
    view = dispatcher.view("tea")
    assert view.status is RequestStatus.FAILED
    assert view.reason is not None
    assert view.reason.endswith("it was last aboard r0, for a person to take it")
    assert not dispatcher.submit(asked("more"), 70.0).booked
    dispatcher.fetched("tea", 80.0)
    assert dispatcher.submit(asked("more"), 80.0).booked


def test_person_whose_escort_fails_is_not_brought_back() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(max_attempts=1))
    guest = {"kind": "escort", "name": "guest", "person": "Ann", "origin": "b", "destination": "d"}
    dispatcher.submit(request_of(guest), 0.0)
    make_leg(dispatcher, 0.0, 15.0)
    make_leg(dispatcher, 15.0, 25.0, NOBODY)
    assert status(dispatcher, "guest") is RequestStatus.FAILED
    assert dispatcher.legs_to_begin(50.0) == []


def test_item_that_is_gone_ends_its_request() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    make_leg(dispatcher, 0.0, 15.0)
    make_leg(dispatcher, 15.0, 25.0, GONE)
    view = dispatcher.view("tea")
    assert view.status is RequestStatus.FAILED
    assert view.reason is not None
    assert "the basket is empty" in view.reason


def test_cancelled_request_is_broken_off_or_goes_back() -> None:
    dispatcher = dispatcher_for("a", "e")
    dispatcher.submit(asked(), 0.0)
    leg = only_leg(dispatcher, 0.0)
    dispatcher.cancel("tea", 5.0)
    assert dispatcher.legs_to_withdraw(5.0) == [leg]
    assert dispatcher.why_unwanted(leg) == "the request is not wanted any more"
    dispatcher.ended(leg, LegEnd(outcome=LegOutcome.WITHDRAWN, at="b"), 6.0)
    assert status(dispatcher) is RequestStatus.CANCELLED
    dispatcher.submit(asked("more"), 10.0)
    make_leg(dispatcher, 10.0, 15.0)
    dispatcher.cancel("more", 30.0)
    assert status(dispatcher, "more") is RequestStatus.RETURNING
    assert make_leg(dispatcher, 30.0, 5.0).action is LegAction.BRING_BACK
    assert status(dispatcher, "more") is RequestStatus.CANCELLED


def test_what_a_failed_robot_has_is_fetched_from_where_it_stands() -> None:
    dispatcher = dispatcher_for("a", "e")
    dispatcher.submit(asked(), 0.0)
    make_leg(dispatcher, 0.0, 15.0)
    only_leg(dispatcher, 15.0)
    dispatcher.robot_failed("r0", "c", "its battery is empty", 25.0)
    rescue = make_leg(dispatcher, 25.0, 30.0)
    assert (rescue.robot, rescue.action, rescue.place) == ("r1", LegAction.TAKE, "f/c")
    make_leg(dispatcher, 55.0, 15.0)
    assert status(dispatcher) is RequestStatus.DONE
    change = next(each for each in dispatcher.log if "battery" in each.reason)
    assert change.requests == ("tea",)
    assert change.robots == ("r0", "r1")


def test_request_waits_while_no_robot_works_and_not_for_ever() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(patience_s=600.0))
    dispatcher.submit(asked(), 0.0)
    dispatcher.robot_failed("r0", None, "it fell", 1.0)
    assert status(dispatcher) is RequestStatus.WAITING
    dispatcher.legs_to_begin(500.0)
    assert status(dispatcher) is RequestStatus.WAITING
    dispatcher.legs_to_begin(601.0)
    view = dispatcher.view("tea")
    assert (view.status, view.reason) == (RequestStatus.FAILED, "no robot works")


def test_what_goes_back_as_it_was_cancelled_is_not_said_to_lack_a_robot_in_the_end() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    make_leg(dispatcher, 0.0, 15.0)
    dispatcher.cancel("tea", 16.0)
    dispatcher.robot_failed("r0", None, "a squeak", 17.0)
    assert status(dispatcher) is RequestStatus.RETURNING
    dispatcher.robot_back("r0", "c", 100.0)
    taken_out = LegEnd(outcome=LegOutcome.DONE, reason="it was taken out of the basket")
    make_leg(dispatcher, 100.0, 20.0, taken_out)
    view = dispatcher.view("tea")
    said = "it was cancelled; it was taken out of the basket"
    assert (view.status, view.reason) == (RequestStatus.CANCELLED, said)


def test_request_that_waited_is_booked_when_a_robot_is_back() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(asked(), 0.0)
    dispatcher.robot_failed("r0", None, "it fell", 1.0)
    dispatcher.robot_back("r0", "b", 100.0)
    assert status(dispatcher) is RequestStatus.BOOKED
    assert dispatcher.view("tea").reason is None


# --- what robots find -----------------------------------------------------------------------------


def test_blocked_way_is_waited_for_and_forgotten() -> None:
    dispatcher = dispatcher_for("a", policy=Policy(forget_s=1800.0))
    dispatcher.found(Found(finding=Finding.BLOCKED, between=("a", "b"), by="r0"), 0.0)
    answer = dispatcher.submit(asked(), 0.0)
    assert answer.expected is not None
    assert answer.expected.begins_s >= 1800.0
    assert dispatcher.legs_to_begin(1000.0) == []
    dispatcher.legs_to_begin(1801.0)
    assert dispatcher.closed_until_s() == {}


def test_way_that_is_found_open_counts_at_once() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.found(Found(finding=Finding.DOOR_CLOSED, between=("a", "b"), until_s=900.0), 0.0)
    dispatcher.submit(asked(), 0.0)
    dispatcher.found(Found(finding=Finding.OPEN, between=("a", "b")), 10.0)
    expected = dispatcher.expected("tea")
    assert expected is not None
    assert expected.begins_s == pytest.approx(20.0)


def test_finding_between_places_that_are_no_neighbours_is_refused() -> None:
    with pytest.raises(ConflictError, match="no way between f/a and f/c"):
        dispatcher_for("a").found(Found(finding=Finding.BLOCKED, between=("a", "c")), 0.0)


def test_time_does_not_go_back() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.legs_to_begin(10.0)
    with pytest.raises(WrongInputError, match="it is 10 s already"):
        dispatcher.submit(asked(), 5.0)


def test_robots_have_names_of_their_own() -> None:
    setting = fleet_of("a", "b")
    twice = setting.model_copy(update={"robots": (setting.robots[0], setting.robots[0])})
    with pytest.raises(WrongInputError, match="a name of its own"):
        Dispatcher(office(), twice)


def test_robot_that_made_way_is_sent_from_where_it_stands() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.robot_moved("r0", "e", 5.0)
    dispatcher.submit(visit(place="d"), 5.0)
    (leg,) = dispatcher.legs_to_begin(5.0)
    assert leg.begins_s == pytest.approx(15.0)
    dispatcher.began(leg, 5.0)
    with pytest.raises(ConflictError, match="does not stand there with nothing to do"):
        dispatcher.robot_moved("r0", "a", 6.0)


def test_what_went_wrong_before_is_not_said_of_what_is_done() -> None:
    dispatcher = dispatcher_for("a")
    dispatcher.submit(visit(), 0.0)
    make_leg(dispatcher, 0.0, 20.0, NOBODY)
    assert "nobody came" in (dispatcher.view("visit").reason or "")
    again_s = 20.0 + dispatcher.setting.policy.retry_after_s
    make_leg(dispatcher, again_s, 30.0)
    assert dispatcher.view("visit").status is RequestStatus.DONE
    assert dispatcher.view("visit").reason is None
