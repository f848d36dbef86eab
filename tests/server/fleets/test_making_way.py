"""Who stands where another robot is to come goes elsewhere, to a place that is free."""

from dispatch_office import dispatcher_for, only_leg, visit

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.server.fleets.making_way import who_makes_way

EVERYWHERE = {f"f/{each}" for each in "abcde"}


def with_one_at_c() -> Dispatcher:
    """Robots of a and e, the first of which stands at c with nothing to do."""
    dispatcher = dispatcher_for("a", "e")
    dispatcher.robot_moved("r0", "c", 1.0)
    return dispatcher


def second_comes(dispatcher: Dispatcher, place: str) -> None:
    """Have the second robot be on its way to a place."""
    dispatcher.robot_failed("r0", None, "for now", 2.0)
    dispatcher.submit(visit(place=place), 2.0)
    assert only_leg(dispatcher, 2.0).robot == "r1"
    dispatcher.robot_back("r0", "c", 3.0)


def test_nobody_goes_where_nobody_comes() -> None:
    dispatcher = with_one_at_c()
    assert list(who_makes_way(dispatcher, EVERYWHERE)) == []
    second_comes(dispatcher, "d")
    assert list(who_makes_way(dispatcher, EVERYWHERE)) == []


def test_who_stands_there_goes_to_its_first_place() -> None:
    dispatcher = with_one_at_c()
    second_comes(dispatcher, "c")
    assert list(who_makes_way(dispatcher, EVERYWHERE)) == [("r0", "f/a")]


def test_who_can_be_sent_nowhere_stays() -> None:
    dispatcher = with_one_at_c()
    second_comes(dispatcher, "c")
    assert list(who_makes_way(dispatcher, {"f/b"})) == []


def test_who_does_not_work_stays() -> None:
    dispatcher = with_one_at_c()
    second_comes(dispatcher, "c")
    dispatcher.robot_failed("r0", None, "a squeak", 4.0)
    assert list(who_makes_way(dispatcher, EVERYWHERE)) == []


def test_who_is_in_the_way_of_somebody_else_besides_makes_way_too() -> None:
    dispatcher = with_one_at_c()
    assert list(who_makes_way(dispatcher, EVERYWHERE, [("r1", "f/c")])) == [("r0", "f/a")]
    assert list(who_makes_way(dispatcher, EVERYWHERE, [("r1", "f/d")])) == []
