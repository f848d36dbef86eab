"""Robots are given things and hand them over, feel what is done, and miss what is taken away."""

import json

import pytest
from building_bench import BuildingBench, made_up

from mend.robots.link.messages import (
    Finished,
    Interrupt,
    IssueDetected,
    Look,
    Looked,
    Rejected,
    ReportBody,
    Resume,
    StepStarted,
)
from mend.sim.building.buildings import BUILDINGS
from mend.sim.building.scene import scene_of
from mend.sim.world import WorldSetup
from mend.tasks.intervention import Act, Intervention

ROBOT, HERE, THERE = "robot1", "F1-101", "F1-103"
PUT_IN, TAKE_OUT = Intervention(act=Act.PUT_IN), Intervention(act=Act.TAKE_OUT)


def asks(bench: BuildingBench, place: str, behavior: str, **more: str) -> IssueDetected:
    """Start something; the robot drives, stands and asks."""
    bench.go(ROBOT, place, behavior, **more)
    issue = bench.run_until(IssueDetected)
    bench.run()
    return issue


def feels(bench: BuildingBench, expect: str, within_s: float = 2.0) -> Looked:
    bench.send(ROBOT, Look(expect=expect, within_s=within_s))
    bench.run()
    return bench.of(Looked)[-1]


def goes_on(bench: BuildingBench, issue: IssueDetected) -> None:
    bench.send(ROBOT, Resume(execution=issue.execution))
    bench.run()


def with_mail(bench: BuildingBench) -> BuildingBench:
    issue = asks(bench, HERE, "collect_item", item="mail")
    assert bench.world.intervene(PUT_IN) == ""
    goes_on(bench, issue)
    assert len(bench.of(Finished)) == 1
    return bench


def test_a_robot_asks_for_an_item_feels_it_and_is_done() -> None:
    bench = BuildingBench()
    issue = asks(bench, HERE, "collect_item", item="mail")
    assert issue.issue == "item_not_given"
    assert feels(bench, "loaded").felt == "nothing"
    assert bench.world.intervene(PUT_IN) == ""
    assert feels(bench, "loaded").fulfilled
    goes_on(bench, issue)
    assert bench.of(Finished)
    names = [each.name for each in bench.of(StepStarted)]
    assert names == [f"go to {HERE}", "collect mail", "collect mail"]
    assert bench.world.goods.items["mail"].robot == 0
    weight_kg = bench.world.goods.items["mail"].weight_kg
    assert bench.world.baskets[0].memory.items["mail"] == pytest.approx(weight_kg, abs=0.05)


def test_who_gives_it_at_once_is_not_asked() -> None:
    bench = BuildingBench()
    bench.go(ROBOT, HERE, "collect_item", item="mail")
    while bench.world.intervene(PUT_IN):
        assert bench.group.advance(0.05)
    bench.run()
    assert bench.of(Finished)
    assert not bench.of(IssueDetected)


def test_an_item_is_handed_over_where_it_is_to_go() -> None:
    bench = with_mail(BuildingBench())
    issue = asks(bench, THERE, "hand_over_item", item="mail")
    assert issue.issue == "item_not_taken"
    assert bench.world.intervene(TAKE_OUT) == ""
    assert feels(bench, "unloaded").fulfilled
    goes_on(bench, issue)
    assert len(bench.of(Finished)) == 2
    mail = bench.world.goods.items["mail"]
    assert (mail.place, mail.delivered) == (THERE, True)


def test_what_was_done_before_a_restart_is_found_so() -> None:
    bench = with_mail(BuildingBench())
    bench.go(ROBOT, HERE, "collect_item", item="mail")
    bench.run()
    assert bench.of(Finished)[-1].found_in_place
    issue = asks(bench, THERE, "hand_over_item", item="mail")
    bench.world.intervene(TAKE_OUT)
    goes_on(bench, issue)
    bench.go(ROBOT, THERE, "hand_over_item", item="mail")
    bench.run()
    assert bench.of(Finished)[-1].found_in_place


def test_another_thing_than_the_one_that_was_given_is_felt_by_its_weight() -> None:
    bench = with_mail(BuildingBench(forgetful=0.0))
    issue = asks(bench, HERE, "collect_item", item="keys")
    bench.world.intervene(PUT_IN)
    goes_on(bench, issue)
    asks(bench, THERE, "hand_over_item", item="mail")
    bench.world.goods.forgetful = 1.0
    while bench.world.goods.items["keys"].robot is not None:
        bench.world.intervene(TAKE_OUT)
    felt = feels(bench, "unloaded")
    assert (felt.fulfilled, felt.felt) == (False, "another")
    bench.world.goods.forgetful = 0.0
    assert bench.world.intervene(TAKE_OUT) == ""
    assert feels(bench, "unloaded").fulfilled


def test_what_is_taken_out_on_the_way_is_noticed_and_may_come_back() -> None:
    bench = with_mail(BuildingBench())
    bench.go(ROBOT, THERE, "hand_over_item", item="mail")
    bench.group.advance(2.0)
    assert bench.world.robots[0].moving
    assert bench.world.intervene(Intervention(act=Act.STEAL, object="mail")) == ""
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "item_taken"
    bench.run()
    assert feels(bench, "loaded").felt == "lighter"
    assert bench.world.intervene(PUT_IN) == ""
    assert feels(bench, "loaded").fulfilled
    bench.send(ROBOT, Resume(execution=issue.execution))
    assert bench.run_until(IssueDetected).issue == "item_not_taken"


def test_what_was_taken_on_the_way_is_not_taken_for_handed_over() -> None:
    bench = with_mail(BuildingBench())
    bench.world.intervene(Intervention(act=Act.STEAL, object="mail"))
    issue = asks(bench, THERE, "hand_over_item", item="mail")
    assert (issue.issue, issue.step) == ("item_taken", 0)


def test_what_is_taken_just_before_it_is_offered_is_not_taken_for_handed_over() -> None:
    bench = with_mail(BuildingBench())
    (agent,), asked = bench.group.agents, len(bench.of(IssueDetected))

    def hear(body: ReportBody, *_: object) -> None:
        bench.reports.append((ROBOT, body))
        once = not bench.of(IssueDetected)[asked:]
        if once and isinstance(body, StepStarted) and body.name == "hand over mail":
            bench.world.intervene(Intervention(act=Act.STEAL, object="mail"))

    agent.attach(hear, lambda _: None)
    issue = asks(bench, THERE, "hand_over_item", item="mail")
    assert issue.issue == "item_taken"
    assert feels(bench, "loaded").felt == "lighter"
    assert bench.world.intervene(PUT_IN) == ""
    assert feels(bench, "loaded").fulfilled
    bench.send(ROBOT, Resume(execution=issue.execution))
    assert bench.run_until(IssueDetected).issue == "item_not_taken"
    assert len(bench.of(Finished)) == 1


def test_what_is_taken_on_the_way_back_to_where_it_was_offered_is_not_handed_over() -> None:
    bench = with_mail(BuildingBench())
    robot = bench.world.robots[0]
    elsewhere = robot.at
    issue = asks(bench, THERE, "hand_over_item", item="mail")
    robot.stand(elsewhere)
    bench.send(ROBOT, Resume(execution=issue.execution))
    bench.group.advance(1.0)
    assert robot.moving
    assert bench.world.intervene(Intervention(act=Act.STEAL, object="mail")) == ""
    assert bench.run_until(IssueDetected).issue == "item_taken"


def test_what_was_offered_in_vain_and_is_taken_there_later_was_handed_over() -> None:
    bench = with_mail(BuildingBench())
    asks(bench, THERE, "hand_over_item", item="mail")
    assert bench.world.intervene(TAKE_OUT) == ""
    bench.send(ROBOT, Interrupt(retreat=True))
    bench.run()
    bench.go(ROBOT, THERE, "hand_over_item", item="mail")
    bench.run()
    assert len(bench.of(Finished)) == 2


def test_who_was_given_nothing_says_so_before_it_sets_out() -> None:
    bench = BuildingBench()
    issue = asks(bench, THERE, "hand_over_item", item="mail")
    assert (issue.issue, issue.step) == ("item_missing", 0)


def test_a_full_basket_is_said_before_anything_is_asked_for() -> None:
    bench = BuildingBench()
    for each in ("q", "r", "s", "t"):
        bench.world.baskets[0].memory.items[each] = 0.5
    bench.go(ROBOT, HERE, "collect_item", item="u")
    bench.run()
    assert bench.of(Rejected)[-1].reason == "its basket has room for 4 items, and holds q, r, s, t"


def test_a_message_is_told_until_somebody_has_heard_it() -> None:
    bench = BuildingBench()
    issue = asks(bench, HERE, "deliver_message", message="Lunch is here.")
    assert issue.issue == "nobody_answers"
    assert not bench.of(Finished)
    goes_on(bench, issue)
    assert bench.of(Finished)


def test_a_pause_is_no_word_that_a_message_was_heard() -> None:
    bench = BuildingBench()
    bench.go(ROBOT, HERE, "deliver_message", message="Lunch is here.")
    while not any(each.name == "tell the message" for each in bench.of(StepStarted)):
        bench.group.advance(0.2)
    bench.send(ROBOT, Interrupt(retreat=False))
    bench.run()
    bench.send(ROBOT, Resume(execution="e1"))
    assert bench.run_until(IssueDetected).issue == "nobody_answers"
    assert not bench.of(Finished)


def test_messages_that_could_not_be_shown_are_refused() -> None:
    bench = BuildingBench()
    for message in ("", " now", "a\u202eb", "He said “no”.", "line\nbreak", "x" * 301):
        bench.go(ROBOT, HERE, "deliver_message", message=message)
        bench.run()
        assert "message" in bench.of(Rejected)[-1].reason
    assert len(bench.of(Rejected)) == 6


def test_who_gives_up_asks_for_nothing_any_more() -> None:
    bench = BuildingBench()
    asks(bench, HERE, "collect_item", item="mail")
    bench.send(ROBOT, Interrupt(retreat=True))
    bench.run()
    assert bench.world.intervene(PUT_IN) == "no robot asks for anything where it stands"


def test_nobody_reaches_the_basket_of_a_robot_that_is_elsewhere() -> None:
    bench = BuildingBench()
    bench.go(ROBOT, HERE, "collect_item", item="mail")
    bench.group.advance(0.5)
    named = Intervention(act=Act.PUT_IN, object="mail")
    assert bench.world.intervene(named) == "no robot asks for 'mail' where it stands"


def test_a_building_is_rebuilt_with_everything_in_its_basket() -> None:
    scene = scene_of(made_up(floors=2), "office", 1)
    bench = with_mail(BuildingBench(scene))
    asks(bench, THERE, "hand_over_item", item="mail")
    snapshot = json.loads(json.dumps(bench.group.snapshot()))
    setup = WorldSetup(
        robots=[ROBOT],
        scene=scene,
        seed=1,
        speed=None,
        snapshot=snapshot,
        options={"localizer": "exact", "unmapped": 0.0},
    )
    again = BUILDINGS.create_agents(setup)
    assert again.snapshot() == snapshot
    assert again.world.goods.items["mail"].robot == 0  # type: ignore[attr-defined]


def begun_anew(bench: BuildingBench) -> BuildingBench:
    """The same world in another life: its robots have lost what they were doing."""
    return BuildingBench(bench.scene, snapshot=json.loads(json.dumps(bench.group.snapshot())))


def test_who_has_begun_anew_feels_no_more_than_there_is_in_its_basket() -> None:
    bench = BuildingBench()
    asks(bench, HERE, "collect_item", item="mail")
    again = begun_anew(bench)
    assert feels(again, "loaded").felt == "nothing"
    assert again.world.intervene(PUT_IN) == ""
    assert feels(again, "loaded").fulfilled
    again.go(ROBOT, HERE, "collect_item", item="mail")
    again.run()
    assert len(again.of(Finished)) == 1


def test_who_has_begun_anew_feels_no_less_than_there_is_in_its_basket() -> None:
    bench = with_mail(BuildingBench())
    asks(bench, THERE, "hand_over_item", item="mail")
    again = begun_anew(bench)
    assert feels(again, "unloaded").felt == "nothing"
    assert again.world.intervene(TAKE_OUT) == ""
    assert feels(again, "unloaded").fulfilled
    again.go(ROBOT, THERE, "hand_over_item", item="mail")
    again.run()
    assert len(again.of(Finished)) == 1


def test_what_was_taken_while_something_else_was_asked_for_comes_back() -> None:
    bench = with_mail(BuildingBench())
    issue = asks(bench, HERE, "collect_item", item="keys")
    assert bench.world.intervene(Intervention(act=Act.STEAL, object="mail")) == ""
    bench.send(ROBOT, Resume(execution=issue.execution))
    assert bench.run_until(IssueDetected).issue == "item_taken"
    bench.run()
    assert feels(bench, "loaded").felt == "lighter"
    assert bench.world.intervene(PUT_IN) == ""
    assert feels(bench, "loaded").fulfilled
    bench.send(ROBOT, Resume(execution=issue.execution))
    assert bench.run_until(IssueDetected).issue == "item_not_given"


def test_a_robot_misses_what_was_taken_out_for_nobody() -> None:
    bench = with_mail(BuildingBench(robots=2))
    assert bench.world.intervene(Intervention(act=Act.STEAL, object="mail")) == ""
    bench.go(ROBOT, THERE)
    assert bench.run_until(IssueDetected).issue == "item_taken"
