"""The robot sees every kind of fault in the tabletop, and sees help as well."""

import math

import pytest
from agent_driver import Driver
from sampled import sample

from mend.robots.link.messages import Finished, Holding, Interrupt, Intervene, Look, Looked, Resume
from mend.sim.tabletop.adapter import TabletopAdapter
from mend.sim.tabletop.layout import lay_out
from mend.sim.world import WorldSetup
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention, Trigger
from mend.tasks.scene import Place, Pose, Scene, SceneObject

LAID_OUT = lay_out([(f"o{i}", f"p{i}") for i in range(6)], seed=2)


def make_driver(
    scene: Scene = LAID_OUT, *interventions: ScriptedIntervention, **options: float
) -> Driver:
    setup = WorldSetup(
        robots=["r1"],
        scene=scene,
        seed=3,
        speed=None,
        interventions=list(interventions),
        options=dict(options),
    )
    return Driver(TabletopAdapter().create_agents(setup))


def during(step: int, fraction: float, do: Intervention) -> ScriptedIntervention:
    return ScriptedIntervention(when=Trigger(object="o1", step=step, fraction=fraction), do=do)


def steal(manner: str = "vanish") -> Intervention:
    return Intervention.model_validate({"act": "steal", "object": "o1", "manner": manner})


def by_ann(act: Act, **more: object) -> Intervene:
    return Intervene(intervention=Intervention(act=act, **more), by="ann")  # type: ignore[arg-type]


def expect(driver: Driver, look: Look) -> bool | None:
    driver.send(look)
    driver.run()
    looked: Looked = driver.of(Looked)[-1].body
    return looked.fulfilled


@pytest.mark.parametrize("manner", ["vanish", "pull"])
@pytest.mark.parametrize(
    ("step", "fraction", "issue"),
    [(1, 0.5, "missed"), (2, 0.9, "missed"), (4, 0.8, "dropped"), (5, 0.2, "dropped")],
)
def test_a_stolen_part_is_seen_as_missed_or_dropped(
    manner: str, step: int, fraction: float, issue: str
) -> None:
    driver = make_driver(LAID_OUT, during(step, fraction, steal(manner)))
    driver.start("o1", "p1")
    raised = driver.run_until_issue()
    assert (raised.issue, raised.interrupts) == (issue, True)
    assert raised.jpeg is not None
    driver.run()
    assert driver.of(Holding)[-1].body.at == "neutral"
    assert [each.issue for each in driver.issues] == [issue]


def test_a_part_moved_away_before_the_grasp_is_seen_as_missed() -> None:
    start = LAID_OUT.objects["o1"].pose
    aside = Intervention(act=Act.MOVE, object="o1", to=Pose(x=start.x, y=start.y + 0.07))
    driver = make_driver(LAID_OUT, during(2, 0.5, aside))
    driver.start("o1", "p1")
    assert driver.run_until_issue().issue == "missed"


@pytest.mark.parametrize(
    ("deed", "when_s", "brought"),
    [
        # Before the arm has drawn back, and once it has.
        (Intervention(act=Act.PUT_BACK, object="o1"), 1.6, True),
        (Intervention(act=Act.PLACE, object="o1", place="p1"), 1.6, True),
        (Intervention(act=Act.PUT_BACK, object="o1"), 5.0, True),
        # Sooner than anything that falls has come to rest nobody is told from the robot itself.
        (Intervention(act=Act.PUT_BACK, object="o1"), 0.1, False),
    ],
)
def test_what_people_bring_before_the_first_look_is_told_from_what_lies_there(
    deed: Intervention, when_s: float, brought: bool
) -> None:
    driver = make_driver(LAID_OUT, during(5, 0.2, steal()))
    driver.start("o1", "p1")
    driver.run_until_issue()
    lost_s = driver.group.time_s()
    driver.run(until=lambda: driver.group.time_s() >= lost_s + when_s, chunk_s=0.1)
    driver.send(Intervene(intervention=deed, by="ann"))
    assert expect(driver, Look(object="o1", place="p1", expect="in_reach", within_s=1.0)) is True
    assert driver.of(Looked)[-1].body.brought is brought


def test_what_the_robot_itself_has_missed_nobody_has_brought() -> None:
    start = LAID_OUT.objects["o1"].pose
    aside = Intervention(act=Act.MOVE, object="o1", to=Pose(x=start.x, y=start.y + 0.07))
    driver = make_driver(LAID_OUT, during(2, 0.5, aside))
    driver.start("o1", "p1")
    driver.run_until_issue()
    assert expect(driver, Look(object="o1", place="p1", expect="in_reach", within_s=1.0)) is True
    assert driver.of(Looked)[-1].body.brought is not True


def test_a_part_that_is_nowhere_is_seen_as_missing() -> None:
    driver = make_driver()
    driver.send(by_ann(Act.STEAL, object="o1"))
    driver.start("o1", "p1")
    raised = driver.run_until_issue()
    assert (raised.issue, raised.step) == ("missing", 0)


def test_a_part_out_of_reach_is_seen_as_unreachable_taken_from_a_hand_and_placed() -> None:
    driver = make_driver(LAID_OUT, reach_m=0.7)
    far = max(LAID_OUT.objects, key=lambda name: LAID_OUT.objects[name].pose.x)
    near = min(
        LAID_OUT.places,
        key=lambda name: math.hypot(
            LAID_OUT.places[name].pose.x, LAID_OUT.places[name].pose.y + 0.19
        ),
    )
    driver.send(by_ann(Act.MOVE, object=far, to=Pose(x=0.75, y=-0.35)))
    driver.start(far, near)
    raised = driver.run_until_issue()
    assert (raised.issue, raised.step) == ("unreachable", 0)
    driver.run()

    driver.send(by_ann(Act.HAND_OVER, object=far))
    assert expect(driver, Look(object=far, expect="in_gripper", within_s=10.0)) is True
    driver.send(Resume(execution="e1"))
    driver.run()
    assert driver.of(Finished)[-1].body == Finished(execution="e1")
    assert expect(driver, Look(object=far, place=near, expect="at_place")) is True


def test_a_part_that_needs_help_is_announced_and_placed_slowly() -> None:
    driver = make_driver()
    driver.start("o1", "p1", needs_help=True)
    raised = driver.run_until_issue()
    assert (raised.issue, raised.step, raised.interrupts) == ("positioning", 5, False)
    driver.run()
    assert len(driver.of(Finished)) == 1


@pytest.mark.parametrize(
    ("step", "told_in", "held_at"),
    [(1, 0, "neutral"), (2, 0, "neutral"), (5, 5, "in_place"), (6, 6, "in_place")],
)
def test_somebody_in_the_way_is_felt_and_when_gone_the_robot_goes_on(
    step: int, told_in: int, held_at: str
) -> None:
    driver = make_driver(LAID_OUT, during(step, 0.4, Intervention(act=Act.BLOCK)))
    driver.start("o1", "p1")
    raised = driver.run_until_issue()
    assert (raised.issue, raised.step) == ("blocked", told_in)
    driver.run()
    assert driver.of(Holding)[-1].body.at == held_at
    assert expect(driver, Look(expect="way_clear", within_s=2.0)) is False
    driver.send(by_ann(Act.RELEASE))
    assert expect(driver, Look(expect="way_clear", within_s=2.0)) is True
    driver.send(Resume(execution="e1"))
    driver.run()
    assert len(driver.of(Finished)) == 1
    assert [each.issue for each in driver.issues] == ["blocked"]


def test_a_place_that_is_taken_is_seen_cleared_and_then_filled() -> None:
    driver = make_driver()
    driver.send(by_ann(Act.PLACE, object="o2", place="p1"))
    driver.start("o1", "p1")
    raised = driver.run_until_issue()
    assert (raised.issue, raised.step) == ("blocked", 0)
    assert "o2 is where o1 belongs" in raised.detection.explanation
    driver.run()
    clear = Look(object="o1", place="p1", expect="way_clear", within_s=2.0)
    assert expect(driver, clear) is False
    driver.send(by_ann(Act.RELEASE, object="o1", place="p1"))
    assert expect(driver, clear) is True
    driver.send(Resume(execution="e1"))
    driver.run()
    assert len(driver.of(Finished)) == 1
    assert expect(driver, Look(object="o1", place="p1", expect="at_place")) is True
    assert expect(driver, Look(object="o2", expect="in_reach", within_s=1.0)) is True


def test_what_a_part_was_put_onto_unseen_is_asked_for_and_not_put_onto_again() -> None:
    small = SceneObject(color=(0.9, 0.1, 0.1), size=(0.03, 0.03, 0.03), pose=Pose(x=0.5, y=-0.3))
    cup = SceneObject(color=(0.1, 0.6, 0.3), size=(0.045, 0.055, 0.05), pose=Pose(x=0.58, y=-0.48))
    place = Pose(x=0.45, y=-0.05)
    scene = Scene(name="s", objects={"o1": cup, "o2": small}, places={"p1": Place(pose=place)})
    under = Intervention(act=Act.MOVE, object="o2", to=place)
    driver = make_driver(scene, during(2, 0.2, under))
    driver.start("o1", "p1")
    assert driver.run_until_issue().issue == "undone"
    driver.run()
    driver.send(Interrupt(retreat=True))
    driver.run()
    driver.start("o1", "p1", execution="e2")
    driver.run()
    assert [each.issue for each in driver.issues] == ["undone", "blocked"]
    detection = driver.issues[-1].detection
    assert detection is not None
    assert detection.explanation == "what o1 stands on is where o1 belongs"
    clear = Look(object="o1", place="p1", expect="way_clear", within_s=2.0)
    assert expect(driver, clear) is False
    driver.send(by_ann(Act.RELEASE, object="o1", place="p1"))
    assert expect(driver, clear) is True
    driver.send(Resume(execution="e2"))
    driver.run()
    assert len(driver.of(Finished)) == 1
    assert expect(driver, Look(object="o1", place="p1", expect="at_place")) is True


def test_a_part_under_another_is_freed_and_then_picked() -> None:
    start = LAID_OUT.objects["o1"].pose
    driver = make_driver()
    driver.send(by_ann(Act.MOVE, object="o2", to=Pose(x=start.x + 0.03, y=start.y + 0.02)))
    driver.start("o1", "p1")
    raised = driver.run_until_issue()
    assert (raised.issue, raised.step) == ("blocked", 0)
    assert "o2 lies on o1" in raised.detection.explanation
    driver.run()
    driver.send(by_ann(Act.RELEASE, object="o1", place="p1"))
    assert expect(driver, Look(object="o1", expect="way_clear", within_s=2.0)) is True
    driver.send(Resume(execution="e1"))
    driver.run()
    assert len(driver.of(Finished)) == 1


def test_what_is_handed_over_is_not_put_on_another_part() -> None:
    driver = make_driver()
    driver.send(by_ann(Act.STEAL, object="o1"))
    driver.start("o1", "p1")
    assert driver.run_until_issue().issue == "missing"
    driver.run()
    driver.send(by_ann(Act.HAND_OVER, object="o1"))
    assert expect(driver, Look(object="o1", expect="in_gripper", within_s=10.0)) is True
    driver.send(by_ann(Act.PLACE, object="o2", place="p1"))
    driver.send(Resume(execution="e1"))
    driver.run()
    assert [each.issue for each in driver.issues] == ["missing", "blocked"]


def test_another_part_that_is_handed_over_is_told_of() -> None:
    driver = make_driver()
    driver.send(by_ann(Act.STEAL, object="o1"))
    driver.start("o1", "p1")
    driver.run()
    asked = Look(object="o1", expect="in_gripper", within_s=8.0)
    assert expect(driver, asked) is False
    assert driver.of(Looked)[-1].body.felt is None
    started_s = driver.group.time_s()
    driver.send(asked)
    driver.run(until=lambda: driver.group.time_s() > started_s + 2.0, chunk_s=0.5)
    driver.send(by_ann(Act.HAND_OVER, object="o3"))
    driver.run()
    looked: Looked = driver.of(Looked)[-1].body
    assert (looked.fulfilled, looked.felt) == (False, "another")


def test_a_robot_that_stays_blocked_can_still_retreat() -> None:
    driver = make_driver(LAID_OUT, during(5, 0.3, Intervention(act=Act.BLOCK)))
    driver.start("o1", "p1")
    driver.run_until_issue()
    driver.run()
    driver.send(Interrupt(retreat=True))
    driver.run()
    assert driver.of(Holding)[-1].body.at == "neutral"


def test_what_a_person_put_back_or_placed_is_seen_there() -> None:
    driver = make_driver(LAID_OUT, during(5, 0.3, steal()))
    driver.start("o1", "p1")
    driver.run_until_issue()
    driver.run()
    assert expect(driver, Look(object="o1", expect="in_reach", within_s=1.0)) is False
    driver.send(by_ann(Act.PUT_BACK, object="o1"))
    assert expect(driver, Look(object="o1", expect="in_reach", within_s=2.0)) is True
    assert expect(driver, Look(object="o1", place="p1", expect="at_place")) is False
    driver.send(by_ann(Act.PLACE, object="o1", place="p1"))
    assert expect(driver, Look(object="o1", place="p1", expect="at_place")) is True


@pytest.mark.parametrize("noise", sample([4.0], [0.0, 4.0]))
def test_parts_without_faults_are_placed_without_an_alarm(noise: float) -> None:
    driver = make_driver(LAID_OUT, camera_noise=noise)
    for index in range(6):
        driver.start(f"o{index}", f"p{index}", execution=f"e{index}")
        driver.run()
    assert driver.issues == []
    assert len(driver.of(Finished)) == 6
    for index in range(6):
        at_place = Look(object=f"o{index}", place=f"p{index}", expect="at_place")
        assert expect(driver, at_place) is True


@pytest.mark.slow
def test_parts_of_the_fullest_table_are_placed_without_an_alarm() -> None:
    # Some of them: `benchmarks/random_scenarios.py` works off whole tables.
    scene = lay_out([(f"o{i}", f"p{i}") for i in range(64)], seed=9)
    driver = make_driver(scene)
    chosen = range(0, 64, sample(32, 7))
    for index in chosen:
        driver.start(f"o{index}", f"p{index}", execution=f"e{index}")
        driver.run()
    assert driver.issues == []
    assert len(driver.of(Finished)) == len(chosen)
