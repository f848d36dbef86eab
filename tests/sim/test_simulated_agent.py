"""A robot in a simulated world: people act in time, the clock holds, the state is reported."""

import json
from collections.abc import Callable
from typing import Any

import pytest
from agent_driver import Driver

from mend.robots.link.messages import (
    Finished,
    Held,
    Hold,
    Interrupt,
    Intervene,
    Intervened,
    Look,
    Looked,
    Rejected,
    Shutdown,
    StepStarted,
    TakePicture,
)
from mend.sim.shared_world import SharedWorld
from mend.sim.tabletop.adapter import TabletopAdapter
from mend.sim.tabletop.arm import SEGMENT_S
from mend.sim.tabletop.layout import lay_out
from mend.sim.world import WorldSetup
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention, Trigger

SCENE = lay_out([("a", "at_a"), ("b", "at_b"), ("c", "at_c")], seed=11)
STEAL_A = Intervention(act=Act.STEAL, object="a")
PUT_BACK_A = Intervention(act=Act.PUT_BACK, object="a")


def make_group(
    *interventions: ScriptedIntervention, snapshot: dict[str, Any] | None = None, **more: Any
) -> SharedWorld:
    setup = WorldSetup(
        robots=["r1"],
        scene=SCENE,
        seed=5,
        speed=more.pop("speed", None),
        interventions=list(interventions),
        snapshot=snapshot,
        options=more,
    )
    return TabletopAdapter().create_agents(setup)


def at_step(
    step: int, fraction: float = 0.0, attempt: int = 1, do: Intervention = STEAL_A
) -> ScriptedIntervention:
    trigger = Trigger(object="a", step=step, fraction=fraction, attempt=attempt)
    return ScriptedIntervention(when=trigger, do=do)


def step_times(driver: Driver) -> dict[int, float]:
    return {each.body.step: each.time_s for each in driver.of(StepStarted)}


def test_says_that_it_is_simulated() -> None:
    hello = make_group().agents[0].hello("boot-1")
    assert hello.simulated
    assert hello.robot == "r1"
    assert set(hello.cameras) == {"head", "forearm"}


def test_picks_and_places_through_all_eight_steps() -> None:
    driver = Driver(make_group())
    driver.start("a", "at_a")
    driver.run()
    assert [each.body.step for each in driver.of(StepStarted)] == list(range(1, 9))
    assert [each.body for each in driver.of(Finished)] == [Finished(execution="e1")]
    assert driver.issues == []


def test_no_time_passes_with_nothing_to_do() -> None:
    driver = Driver(make_group())
    assert driver.group.advance(10.0) is False
    assert driver.group.time_s() == 0.0


@pytest.mark.parametrize("step", [1, 2, 4, 5, 6, 8])
@pytest.mark.parametrize("fraction", [0.0, 0.5])
def test_an_intervention_happens_at_its_moment_of_task_progress_within_one_advance(
    step: int, fraction: float
) -> None:
    untouched = Driver(make_group())
    untouched.start("a", "at_a")
    untouched.run()
    begins = step_times(untouched)
    last_step_s = SEGMENT_S / 0.5
    ends = {**{n - 1: t for n, t in begins.items()}, 8: begins[8] + last_step_s}

    driver = Driver(make_group(at_step(step, fraction)))
    driver.start("a", "at_a")
    driver.run(until=lambda: bool(driver.of(Intervened)), chunk_s=1000.0)

    due_s = begins[step] + fraction * (ends[step] - begins[step])
    # Steps 4 and 6 end with a moment of rest, which is no part of the motion's fraction.
    assert driver.of(Intervened)[0].time_s == pytest.approx(due_s, abs=0.16)
    assert driver.of(Intervened)[0].time_s >= begins[step] - 1e-9


def test_an_intervention_at_the_very_end_of_the_last_step_happens() -> None:
    driver = Driver(make_group(at_step(8, 1.0)))
    driver.start("a", "at_a")
    driver.run()
    assert len(driver.of(Intervened)) == 1


def test_a_scripted_intervention_happens_once_and_only_in_its_attempt() -> None:
    driver = Driver(make_group(at_step(2, 0.5), at_step(2, 0.5, attempt=2)))
    driver.start("a", "at_a")
    assert driver.run_until_issue().issue == "missed"
    assert len(driver.of(Intervened)) == 1
    driver.run()
    driver.send(Intervene(intervention=PUT_BACK_A, by="ann"))
    driver.send(Interrupt(retreat=True))
    driver.run()
    driver.start("a", "at_a", execution="e2")
    driver.run(until=lambda: len(driver.issues) == 2)
    assert [each.body.by for each in driver.of(Intervened)] == ["scenario", "ann", "scenario"]


def test_nothing_of_an_earlier_behavior_happens_when_a_later_one_had_nothing_to_do() -> None:
    driver = Driver(make_group(at_step(2, 0.5), at_step(7, do=PUT_BACK_A)))
    driver.send(
        Intervene(intervention=Intervention(act=Act.PLACE, object="b", place="at_b"), by="ann")
    )
    driver.start("a", "at_a")
    driver.run()
    driver.start("b", "at_b", execution="e2")
    driver.run()
    assert driver.of(Finished)[-1].body.found_in_place
    assert [each.body.intervention.act for each in driver.of(Intervened)] == [Act.PLACE, Act.STEAL]


def test_interventions_on_other_objects_wait_for_their_own() -> None:
    driver = Driver(make_group(at_step(2)))
    driver.start("b", "at_b")
    driver.run()
    assert driver.of(Intervened) == []


def test_a_timed_intervention_happens_while_the_robot_works() -> None:
    driver = Driver(make_group(ScriptedIntervention(at_s=3.0, do=STEAL_A)))
    driver.start("b", "at_b")
    driver.run()
    assert driver.of(Intervened)[0].time_s == pytest.approx(3.0, abs=0.05)


def test_an_intervention_without_a_moment_happens_at_once() -> None:
    driver = Driver(make_group())
    command = driver.send(Intervene(intervention=STEAL_A, by="ann"))
    (report,) = driver.of(Intervened)
    assert report.body == Intervened(intervention=STEAL_A, by="ann", command=command)
    assert report.time_s == 0.0


def test_an_intervention_for_later_waits_until_the_clock_gets_there() -> None:
    driver = Driver(make_group())
    command = driver.send(Intervene(intervention=STEAL_A, by="ann", at=4.0))
    driver.group.advance(100.0)
    assert driver.of(Intervened) == []
    driver.send(Hold(until=10.0))
    driver.run()
    assert driver.of(Intervened)[0].time_s == pytest.approx(4.0, abs=0.05)
    assert driver.of(Intervened)[0].body.command == command


def test_an_intervention_that_cannot_be_done_says_why() -> None:
    driver = Driver(make_group())
    nobody = Intervention(act=Act.RELEASE)
    command = driver.send(Intervene(intervention=nobody, by="ann"))
    assert driver.of(Intervened)[0].body == Intervened(
        intervention=nobody,
        by="ann",
        ok=False,
        detail="nobody stands in the way",
        command=command,
    )


def test_a_hold_lets_the_clock_run_and_ends_when_it_gets_there() -> None:
    driver = Driver(make_group())
    command = driver.send(Hold(until=7.25, rate=2.0))
    assert driver.group.pace == 2.0
    driver.run(chunk_s=0.3)
    (report,) = driver.of(Held)
    assert report.body == Held(command=command)
    assert report.time_s == pytest.approx(7.3, abs=0.051)
    assert driver.group.advance(1.0) is False


def test_a_hold_that_is_over_already_ends_at_once() -> None:
    driver = Driver(make_group())
    driver.send(Hold(until=-1.0))
    driver.group.advance(1.0)
    assert len(driver.of(Held)) == 1
    assert driver.group.time_s() == 0.0


def test_a_command_ends_a_hold_without_a_word() -> None:
    driver = Driver(make_group())
    driver.send(Hold(until=1000.0))
    driver.group.advance(2.0)
    driver.start("a", "at_a")
    driver.run()
    assert driver.of(Held) == []
    assert len(driver.of(Finished)) == 1


def test_a_hold_outlasts_pictures_and_interventions() -> None:
    driver = Driver(make_group())
    driver.send(Hold(until=5.0))
    driver.send(TakePicture(camera="head"))
    driver.send(Intervene(intervention=STEAL_A, by="ann", at=2.0))
    driver.run()
    assert len(driver.of(Held)) == 1
    assert len(driver.of(Intervened)) == 1
    assert [each.camera for each in driver.pictures] == ["head"]


def test_the_pace_is_that_of_the_run_but_for_holds_and_looks() -> None:
    driver = Driver(make_group(speed=3.0))
    assert driver.group.pace == 3.0
    driver.send(Look(object="a", place="at_a", expect="at_place", within_s=2.0, rate=1.0))
    assert driver.group.pace == 1.0
    driver.run()
    assert len(driver.of(Looked)) == 1
    assert driver.group.pace == 3.0
    driver.send(Hold(until=100.0, rate=None))
    assert driver.group.pace is None


def test_a_look_sees_what_a_person_does_meanwhile() -> None:
    driver = Driver(make_group())
    place = Intervention(act=Act.PLACE, object="a", place="at_a")
    driver.send(Intervene(intervention=place, by="ann", at=6.0))
    driver.send(Look(object="a", place="at_a", expect="at_place", within_s=20.0))
    driver.run()
    (report,) = driver.of(Looked)
    assert report.body.fulfilled is True
    assert 6.0 <= report.time_s < 8.0


def test_advance_returns_at_what_the_service_must_see() -> None:
    driver = Driver(make_group(at_step(5, 0.5)))
    driver.start("a", "at_a")
    ends = []
    for _ in range(5):
        driver.group.advance(1000.0)
        ends.append(driver.reports[-1].body.type)
    assert ends == ["step_started"] * 5
    driver.group.advance(1000.0)
    assert driver.reports[-1].body.type == "issue"
    driver.run()
    assert driver.reports[-1].body.type == "holding"


def test_steps_ends_holds_issues_and_interventions_carry_the_world() -> None:
    driver = Driver(make_group(at_step(5, 0.5)))
    driver.start("a", "at_a")
    driver.run()
    driver.start("b", "at_b", execution="e2")
    driver.run()
    carried = {each.body.type for each in driver.reports if each.world is not None}
    assert carried == {"step_started", "finished", "holding", "intervened", "issue"}
    for each in driver.reports:
        assert each.world is None or json.loads(json.dumps(each.world)) == each.world


def test_a_rebuilt_agent_goes_on_where_the_report_was() -> None:
    first = Driver(make_group(at_step(2, 0.5), at_step(4, 0.5, attempt=2)))
    first.start("a", "at_a")
    first.run()
    first.send(Intervene(intervention=PUT_BACK_A, by="ann"))
    first.send(
        Intervene(intervention=Intervention(act=Act.BLOCK), by="bob", at=first.group.time_s() + 60)
    )
    first.start("b", "at_b", execution="e2")
    first.run()
    kept = first.of(Finished)[-1].world
    assert kept is not None

    again = Driver(make_group(at_step(2, 0.5), at_step(4, 0.5, attempt=2), snapshot=kept))
    assert again.group.time_s() == first.group.time_s()
    again.start("b", "at_b", execution="e3")
    again.run()
    assert again.of(Finished)[0].body == Finished(execution="e3", found_in_place=True)
    again.start("a", "at_a", execution="e4")
    again.run()
    assert [each.body.intervention.act for each in again.of(Intervened)] == [Act.STEAL]
    assert again.issues[-1].issue == "dropped"
    again.send(Hold(until=again.group.time_s() + 60))
    again.run()
    assert [each.body.by for each in again.of(Intervened)] == ["scenario", "bob"]


def test_a_rebuilt_agent_that_is_told_again_what_it_knows_does_it_once() -> None:
    promised = Intervene(intervention=PUT_BACK_A, by="helper", at=30.0)
    first = Driver(make_group())
    first.agent.handle("promise", promised)
    kept = first.group.snapshot()

    again = Driver(make_group(snapshot=kept))
    again.agent.handle("promise", promised)
    again.send(Hold(until=60.0))
    again.run()
    assert [each.body.by for each in again.of(Intervened)] == ["helper"]


def test_who_keeps_a_promise_first_gets_whoever_hides_it_out_of_sight() -> None:
    driver = Driver(make_group())
    driver.send(Intervene(intervention=Intervention(act=Act.BLOCK), by="mischief"))
    for _ in range(2):
        driver.send(Intervene(intervention=PUT_BACK_A, by="helper"))
    done = [(each.body.intervention.act, each.body.ok) for each in driver.of(Intervened)]
    assert done == [
        (Act.BLOCK, True), (Act.RELEASE, True), (Act.PUT_BACK, True), (Act.PUT_BACK, True),
    ]  # fmt: skip


def test_a_snapshot_that_does_not_fit_is_refused() -> None:
    kept = make_group().snapshot()
    kept["world"]["gone"] = ["piano"]
    with pytest.raises(ValueError, match=r"parts that the scene has not: \['piano'\]"):
        make_group(snapshot=kept)


def test_the_robot_itself_rejects_what_it_cannot_do() -> None:
    driver = Driver(make_group())
    command = driver.send(TakePicture(camera="rear"))
    assert [each.body.command for each in driver.of(Rejected)] == [command]


def test_shutdown_ends_everything() -> None:
    driver = Driver(make_group())
    driver.start("a", "at_a")
    driver.group.advance(2.0)
    began_s = driver.group.time_s()
    driver.send(Shutdown())
    assert driver.group.shut_down
    assert driver.group.advance(10.0) is False
    assert driver.group.time_s() == began_s


def transcript(chunk_s: Callable[[int], float]) -> list[str]:
    driver = Driver(make_group(at_step(5, 0.3), camera_noise=3.0))
    for index, name in enumerate(("a", "b", "c")):
        driver.start(name, f"at_{name}", execution=f"e{index}")
        driver.run(chunk_s=chunk_s(index))
        driver.send(Interrupt(retreat=True))
        driver.run()
    return [f"{each.time_s:.6f} {each.body!r} {each.world!r}" for each in driver.reports]


def test_the_same_seed_gives_the_same_reports_however_time_is_cut() -> None:
    assert transcript(lambda _: 1.0) == transcript(lambda index: 0.37 + index)


def test_nobody_does_later_what_the_robot_has_seen_done_already() -> None:
    driver = Driver(make_group())
    driver.send(Intervene(intervention=PUT_BACK_A, by="helper", at=3.0))
    driver.send(Look(object="a", expect="in_reach", within_s=10.0))
    driver.run()
    assert [each.body.fulfilled for each in driver.of(Looked)] == [True]
    driver.send(Hold(until=5.0))
    driver.run()
    assert driver.of(Intervened) == []
