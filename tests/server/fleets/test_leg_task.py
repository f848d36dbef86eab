"""The runs of a leg: what robots call things, and what none of them can do."""

from uuid import UUID

import pytest

from mend.dialogue.spoken import the
from mend.errors import WrongInputError
from mend.fleet.dispatch.leg import Leg
from mend.fleet.requests import (
    REQUESTS,
    DeliverMessage,
    Escort,
    GoToRoom,
    LegAction,
    RequestKind,
    Transport,
)
from mend.server.fleets.item_names import item_of, made_name
from mend.server.fleets.leg_task import (
    BEHAVIORS,
    LegStage,
    doable_kinds,
    require_doable,
    run_of,
    task_of,
)
from mend.tasks.plugins import load_plugins

SITE = UUID(int=7)
PARCEL = Transport(name="p1", what="the blue parcel", origin="101", destination="102")


def leg(number: int = 1, action: LegAction = LegAction.COLLECT) -> Leg:
    return Leg(
        robot="robot1",
        number=number,
        action=action,
        place="F1/101",
        booking="p1",
        request=PARCEL,
        begins_s=0.0,
        done_s=30.0,
        not_before_s=0.0,
    )


def test_who_fetches_something_out_of_a_basket_says_whose_it_is() -> None:
    rescue = leg(action=LegAction.TAKE).model_copy(update={"held_by": "robot2"})
    assert task_of(rescue, "101").nodes[0].parameters["held_by"] == "robot2"  # type: ignore[union-attr]
    lies = task_of(leg(action=LegAction.TAKE), "101")
    assert "held_by" not in lies.nodes[0].parameters  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("what", "booking", "called"),
    [
        ("the blue parcel", "p1", "blue_parcel-p1"),
        ("the mail", "mail", "mail"),
        ("A cup", "daily/3", "cup-daily_3--32033c54"),
        ("tea", "p-6", "tea-p_6--44207e34"),
        ("tea", "p_6", "tea-p_6"),
        ("3 keys", "k", "q0--3_keys-k"),
        ("ключи", "k", "xn--h1add2c8a-k"),
        ("синий ящик", "k", "xn--h1aados_xn--h1ae7bxa-k"),
        ("Schlüssel für 7002", "k", "Schlussel_fur_7002-k"),
        ("a cup of tea", "tea", "cup_of_tea--8e86d7b2"),
        ("a cup of tea", "te", "cup_of_tea-te"),
        ("…", "k", "item-k"),
        ("this", "p1", "thing_to_be_brought--3f386b33"),
        (" It ", "it--0afba7d8", "thing_to_be_brought--57b6f51b"),
        ("the tea", "tea--0afba7d8", "tea--83f146ec"),
        ("the tea", "the_tea--0afba7d8/3", "tea--2c7e84ec"),
        ("x" * 99, "y" * 64, f"{'x' * 31}-{'y' * 21}--4492a58b"),
    ],
)
def test_a_thing_is_called_as_people_do_as_far_as_names_go(what, booking, called) -> None:
    assert item_of(what, booking) == called


@pytest.mark.parametrize(
    ("what", "name"),
    [("the blue parcel", "blue_parcel"), ("this", "transport"), ("3 keys", "q0--3_keys")],
)
def test_a_request_that_nobody_names_is_called_after_what_is_brought(what: str, name: str) -> None:
    request = Transport(name="asked", what=what, origin="101", destination="102")
    assert made_name(request, "0afba7d8") == f"{name}--0afba7d8"
    assert made_name(GoToRoom(name="asked", place="101"), "0afba7d8") == "go_to_room--0afba7d8"


def test_things_that_people_only_point_at_are_told_apart_by_where_they_are_fetched() -> None:
    names = [
        item_of("this", f"this--0afba7d{n}", place) for n, place in enumerate(("F1/1", "F2/3"))
    ]
    assert [the(name) for name in names] == [
        "the thing to be brought from F1 1",
        "the thing to be brought from F2 3",
    ]
    assert all(len(item_of("it", "b" * 64, "p" * 64)) <= 64 for _ in names)


def test_the_same_thing_is_meant_where_it_is_fetched_and_where_it_is_brought() -> None:
    fetched, brought = (
        task_of(leg(action=action), "F1-101").nodes[0]
        for action in (LegAction.COLLECT, LegAction.HAND_OVER)
    )
    assert (fetched.behavior, brought.behavior) == ("collect_item", "hand_over_item")
    assert fetched.parameters == brought.parameters == {"place": "F1-101", "item": "blue_parcel-p1"}


def test_a_person_is_met_where_they_are_and_led_from_there() -> None:
    request = Escort(name="e", person="Ms Lee", origin="101", destination="102")
    met, led = (
        task_of(leg(action=action).model_copy(update={"request": request}), "F1-101").nodes[0]
        for action in (request.fetching, request.bringing)
    )
    assert (met.behavior, led.behavior) == ("meet_person", "escort")
    assert met.parameters == led.parameters == {"place": "F1-101", "person": "Ms Lee"}


def test_each_leg_has_its_own_runs_and_always_the_same() -> None:
    runs = {run_of(SITE, "r0", number, stage) for number in (1, 2) for stage in LegStage}
    assert len(runs) == 4
    assert run_of(SITE, "r0", 1, LegStage.DO) == run_of(SITE, "r0", 1, LegStage.DO)


def test_what_no_robot_can_do_is_refused_before_it_is_booked() -> None:
    behaviors = load_plugins("mend.behaviors")
    require_doable(GoToRoom(name="r", place="101"), behaviors)
    require_doable(PARCEL, behaviors)
    require_doable(Escort(name="e", person="Ann", origin="101", destination="102"), behaviors)
    with pytest.raises(WrongInputError, match="of the kind 'transport'"):
        require_doable(PARCEL, {})
    for said in ('She said "no".', "Say «no».", "„Nein“, sagt sie."):
        require_doable(DeliverMessage(name="m", place="101", message=said), behaviors)
    unseen = DeliverMessage(name="m", place="101", message="no\u00adthing")
    with pytest.raises(WrongInputError, match="only characters that can be seen"):
        require_doable(unseen, behaviors)
    long = Escort(name="e", person="A" * 101, origin="101", destination="102")
    with pytest.raises(WrongInputError, match="person"):
        require_doable(long, behaviors)


def test_every_behavior_of_a_leg_is_one_that_robots_have() -> None:
    assert set(BEHAVIORS.values()) <= load_plugins("mend.behaviors").keys()


def test_what_may_be_asked_for_is_what_behaviors_do() -> None:
    behaviors = load_plugins("mend.behaviors")
    assert doable_kinds({}) == [RequestKind.GO_TO_ROOM]
    kinds = doable_kinds(behaviors)
    assert {RequestKind.DELIVER_MESSAGE, RequestKind.TRANSPORT} <= set(kinds)
    without = {name: each for name, each in behaviors.items() if name != "hand_over_item"}
    assert set(kinds) - set(doable_kinds(without)) == {RequestKind.TRANSPORT}
    assert set(kinds) <= set(REQUESTS)
